// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/base/scene_features.h"
#include "host/base/surface_features.h"
#include "host/scene/scene.h"
#include "kernels/shared/surface_scene.h"

namespace kilolux {

class TextureTable;

/// The features that are read of a mesh; none: the mesh is skipped.
using MeshFeatures = std::function<std::optional<SurfaceFeatures>(const Mesh&)>;

/// Whether the material of a mesh has a texture for the use USE_* that can be read.
bool reads_use(const Scene& scene, const Mesh& mesh, int use);

/// The texture uses that affect what `needs` keeps, as bits 1 << USE_*.
uint kept_uses(const SceneFeatures& needs);

/// The features that the surfaces of a mesh read with these texture uses. `anisotropy` at least 1.
SurfaceFeatures mesh_features(const Scene& scene, const Mesh& mesh, uint uses, int anisotropy);

/// The features that decide where a mesh's surfaces are: positions, and the inputs of alpha masks.
SurfaceFeatures coverage_features(const Scene& scene, const Mesh& mesh);

/// The features that a scene's opaque and masked surfaces read.
SurfaceFeatures surface_features(const Scene& scene, const SceneFeatures& needs, int anisotropy);

/// The rows of a scene's surfaces, as kernels and shaders read them.
struct SurfaceRows {
    std::vector<MeshRow> meshes;
    std::vector<float> vertices;
    std::vector<uint> indices;
    std::vector<SurfaceMaterial> materials;  // the scene's, and the default one
    std::uint32_t materials_revision = 0;
    std::vector<std::uint32_t> revisions;    // of the meshes' vertices
    std::vector<std::size_t> vertex_counts;  // of the meshes
};

/// Throws Error when there are more vertices than rows address.
SurfaceRows surface_rows(const Scene& scene, const MeshFeatures& features,
                         const TextureTable& textures);

/// Makes the rows of materials anew where the scene's revision says that these changed, and returns
/// whether it did. `features` are those of the rows.
bool rewrite_materials(SurfaceRows& rows, const Scene& scene, const MeshFeatures& features);

/// Calls write(first float, rows) for the meshes of `rows` whose vertices changed since the last
/// call. Throws Error where their number changed: the next mesh's rows follow at once.
void rewrite_vertices(SurfaceRows& rows, const Scene& scene, const MeshFeatures& features,
                      const std::function<void(std::size_t, std::span<const float>)>& write);

}  // namespace kilolux
