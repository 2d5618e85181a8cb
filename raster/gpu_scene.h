// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/scene/scene.h"
#include "raster/gl_object.h"
#include "raster/gpu_textures.h"
#include "raster/material_features.h"

namespace kilolux {

/// A mesh's vertices and triangles in OpenGL buffers.
struct GpuMesh {
    GlBuffer vertices;
    GlBuffer indices;
    GlVertexArray vertex_array;
    GLsizei index_count = 0;
    int material = 0;            // index of the material's row
    uint features = 0;           // of the mesh with its material
    std::uint32_t revision = 0;  // of the vertices that were uploaded
};

/// Uploads the attributes of a mesh that `features` reads, interleaved, with its triangles.
/// `material`: its row.
GpuMesh upload_mesh(const Mesh& mesh, int material, uint features);

/// What OpenGL draws of surfaces that do not blend.
enum class GpuSceneUse {
    shaded,   // all that materials read: G-buffer planes, forward shading
    covered,  // where they are: positions, and what alpha masks read
};

/// A scene's meshes, materials and textures in the current context. Only the attributes and
/// textures that the use reads are there; surfaces that blend have all of theirs.
class GpuScene {
 public:
    /// The scene must outlive this; its materials and textures must stay as they are and its meshes
    /// as many, its instances may move, and vertices may change before a refresh(). `anisotropy`: 0
    /// chooses 8, or 1 where the CPU does the filtering.
    explicit GpuScene(const Scene& scene, float anisotropy = 0.0f,
                      GpuSceneUse use = GpuSceneUse::shaded);

    /// Uploads meshes anew whose revision says that their vertices changed.
    void refresh();

    const Scene& scene() const { return scene_; }
    const GpuMesh& mesh(int mesh) const { return meshes_[static_cast<std::size_t>(mesh)]; }
    std::span<const GpuMesh> meshes() const { return meshes_; }

    /// The material of a row: the scene's, or the default one after the last.
    const Material& material(int row) const;

    /// Binds a material's row (uniform block 0) and those of its textures that `features` names.
    void bind_material(int row, uint features) const;

    /// Texture objects: images, counted twice where both sRGB and linear.
    std::size_t texture_count() const { return textures_.texture_count(); }

 private:
    const Scene& scene_;
    std::vector<GpuMesh> meshes_;
    GpuTextures textures_;
    GlBuffer material_rows_;
    GLintptr material_stride_bytes_ = 0;
    Material default_material_;
};

}  // namespace kilolux
