// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "raster/gpu_scene.h"

namespace kilolux {

/// Uploads the attributes of a mesh that `features` reads, interleaved, with its triangles.
GpuMesh upload_mesh(const Mesh& mesh, uint features);

}  // namespace kilolux
