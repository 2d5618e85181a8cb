// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/base/surface_features.h"
#include "host/scene/scene.h"
#include "kernels/shared/surface_scene.h"

namespace kilolux {

/// The places of a mesh's attributes in its vertices' rows: of those that the features read. Its
/// places in the buffers and its material are not set.
MeshRow vertex_layout(const Mesh& mesh, const SurfaceFeatures& features);

/// Floats of a vertex's row.
std::size_t vertex_floats(const Mesh& mesh, const SurfaceFeatures& features);

/// Appends a mesh's vertices as rows.
void append_vertices(const Mesh& mesh, const MeshRow& row, std::vector<float>& out);

/// `count` as a number that kernels index buffers with. Throws Error beyond 32 bits.
uint checked_count(std::size_t count, const Scene& scene);

}  // namespace kilolux
