// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "kernels/shared/surface_scene.h"

namespace kilolux {

/// What of a scene's surfaces is compiled into resolve_surfaces.
struct SurfaceFeatures {
    uint texture_uses = 0;  // bits 1 << USE_*
    bool texcoord0 = false;
    bool texcoord1 = false;
    bool vertex_color = false;
    bool nearest = false;       // filters other than linear between texels and between mip levels
    bool wraps = false;         // other than repeat
    bool uv_transform = false;  // KHR_texture_transform
    bool masks = false;         // cut by alpha
    int anisotropy = 1;         // samples along a footprint's longer side at most
    bool operator==(const SurfaceFeatures&) const = default;
};

/// What kernels that read surfaces are compiled with.
void define_surfaces(BuildOptions& options, const SurfaceFeatures& surfaces, const Tuning& tuning);

/// A scene's surfaces on the device, as kernels/shared/surface_scene.h has them.
struct SurfaceBuffers {
    DeviceArray<InstanceRow> instances;  // drawn ones, in the order of their ids, and an end
    DeviceArray<uint> instance_blocks;   // of every INSTANCE_BLOCK-th triangle, and of the last
    DeviceArray<MeshRow> meshes;
    DeviceArray<float> vertices;
    DeviceArray<uint> indices;
    DeviceArray<SurfaceMaterial> materials;
    DeviceArray<TextureRow> textures;
    DeviceArray<std::uint64_t> texels;
};

/// Triangle ids -> G-buffer.
class ResolveSurfaces {
 public:
    ResolveSurfaces(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                    const SurfaceFeatures& surfaces);

    /// The planes of `layout` for ids[view.height][view.stride]: 0 for background, else 1 + the
    /// number of a triangle, counted along the instances. Enqueues only.
    GBuffer enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                    const GBufferLayout& layout, const View& view, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<float> boundary_;
    GrowingArray<uint> code_;
    GrowingArray<std::byte> planes_;
};

}  // namespace kilolux
