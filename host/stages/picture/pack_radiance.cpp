// SPDX-License-Identifier: Apache-2.0
#include "host/stages/picture/pack_radiance.h"

#include "host/gpu/memory/picture_memory.h"

namespace kilolux {

PackRadiance::PackRadiance(const Gpu& gpu, const Tuning& tuning, RadianceFormat format)
    : tuning_(tuning),
      format_(format),
      kernel_(gpu,
              build_program(gpu.with_lanes(1), kPackRadianceStage,
                            BuildOptions().define("RADIANCE_FORMAT", static_cast<int>(format))),
              kPackRadianceStage, "pack_radiance") {}

void PackRadiance::enqueue(const Radiance& radiance, const cl::Memory& to, uint pitch,
                           StageTimer& timer) {
    const View& view = radiance.view;
    const uint pixels = pitch == 0 ? view.width : pitch;
    const PictureMemory need{view.width, view.height, pixels,
                             format_ == RadianceFormat::half4 ? 8u : 16u,
                             format_ == RadianceFormat::image};
    check_picture_memory(std::string(kPackRadianceStage) + ": radiance", to, need);
    kernel_.enqueue(items(std::size_t{view.width} * view.height, tuning_.light_group), timer,
                    radiance.planes, view, pixels, to);
}

}  // namespace kilolux
