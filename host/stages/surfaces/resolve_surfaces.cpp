// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/resolve_surfaces.h"

#include "host/base/formats/gbuffer_layout.h"

namespace kilolux {
namespace {

KernelProgram resolve_program(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                              const SurfaceFeatures& surfaces) {
    BuildOptions options = feature_options(features);
    options.define("HAS_UNLIT_MATERIALS", features.unlit_materials);
    define_surfaces(options, surfaces, tuning);
    return build_program(gpu, kResolveSurfacesStage, options);
}

}  // namespace

ResolveSurfaces::ResolveSurfaces(const Gpu& gpu, const Tuning& tuning,
                                 const KernelFeatures& features, const SurfaceFeatures& surfaces)
    : tuning_(tuning),
      kernel_(gpu, resolve_program(gpu, tuning, features, surfaces), kResolveSurfacesStage,
              "resolve_surfaces"),
      planes_(gpu, kResolveSurfacesStage) {}

GBuffer ResolveSurfaces::enqueue(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                                 const GBufferLayout& layout, const View& view, StageTimer& timer) {
    GBuffer out;
    out.layout = layout;
    out.view = view;
    out.bytes = planes_.reserve(gbuffer_bytes(layout, view.stride, view.height));
    kernel_.enqueue(kernel_.block_items(view, tuning_.shade_rows), timer, ids, view, layout, scene,
                    SrgbBucketTables{}, out.bytes);
    return out;
}

// A triangle is read once, however many pixels show it: three indices and about half a vertex,
// which has a position and a normal at least.
StageWork resolve_surfaces_work(const StageCounts& c) {
    constexpr double kTriangle = 3 * sizeof(uint) + 0.5 * (3 + 3) * sizeof(float);
    return {.bytes_read = sizeof(uint) * c.pixels + kTriangle * c.seen_triangles,
            .bytes_written = c.gbuffer_bytes_per_pixel * c.pixels,
            .texels = c.texels,
            .launches = 1};
}

}  // namespace kilolux
