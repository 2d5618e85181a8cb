// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/scene/draw_list.h"
#include "host/scene/rows/surface_rows.h"
#include "raster/gl_object.h"

namespace kilolux {

/// The attributes that OpenGL needs of surfaces that do not blend.
enum class GpuSceneUse {
    shaded,   // all attributes of materials: G-buffer planes, forward shading
    covered,  // coverage only: positions, and the inputs of alpha masks
};

/// A scene's rows and mips in the current context, the same as kernels read: see
/// kernels/shared/surface_scene.h. Surfaces that blend have all attributes, the others those of the
/// use.
class GpuScene {
 public:
    /// The scene must outlive this; its textures must stay as they are, its meshes and materials as
    /// many, its instances may move, and vertices and factors may change before a refresh().
    /// `anisotropy`: samples along a footprint's longer side at most. Throws Error where the rows
    /// or an image exceed what this OpenGL's buffer textures hold.
    explicit GpuScene(const Scene& scene, int anisotropy = 1,
                      GpuSceneUse use = GpuSceneUse::shaded);

    /// Uploads the materials, and the vertices of meshes, whose revision changed.
    void refresh();

    const Scene& scene() const { return scene_; }
    int anisotropy() const { return anisotropy_; }
    const Material& material_of_mesh(std::size_t mesh) const;

    /// Binds everything for these draws, in the order of their numbers; see draw_rows.h.
    void bind(std::span<const Draw> draws) const;

    /// Binds the maps of a mesh's material that `uses` names, as bits 1 << USE_*.
    void bind_maps(std::size_t mesh, uint uses) const;

    /// Draws a mesh with the current program.
    void draw(std::size_t mesh) const;

    /// Images with their mips, counted twice where both sRGB and linear.
    std::size_t image_count() const { return images_.size(); }

 private:
    // An array that shaders read as texels.
    struct Texels {
        GlBuffer buffer;
        GlTexture texture;
    };
    static Texels make_texels(const char* what, GLenum format, std::size_t texel_bytes,
                              std::span<const std::byte> bytes);
    void upload_images(const TextureTable& table);
    MeshFeatures features() const;

    const Scene& scene_;
    int anisotropy_;
    GpuSceneUse use_;
    SurfaceRows rows_;  // without vertices and triangles
    GlBuffer meshes_, materials_, textures_;
    GlBuffer srgb_;               // codes of linear light
    mutable GlBuffer instances_;  // rows of the draws that are bound
    Texels vertices_, indices_;
    std::vector<Texels> images_;
    std::vector<std::size_t> image_of_texture_;  // by TextureRow
    GlVertexArray vertex_array_;
};

}  // namespace kilolux
