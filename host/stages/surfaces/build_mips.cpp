// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/build_mips.h"

#include "host/base/formats/mips.h"

namespace kilolux {

BuildMips::BuildMips(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kBuildMipsStage)),
      first_(gpu, program_, kBuildMipsStage, "mip_first"),
      next_(gpu, program_, kBuildMipsStage, "mip_next"),
      srgb_(gpu, kBuildMipsStage),
      linear_(gpu, kBuildMipsStage),
      image_(gpu, kBuildMipsStage) {
    upload<std::uint16_t>(gpu_, srgb_.reserve(256), linear_codes(true));
    upload<std::uint16_t>(gpu_, linear_.reserve(256), linear_codes(false));
}

void BuildMips::enqueue(std::span<const std::uint8_t> rgba, bool srgb, const TextureRow& row,
                        const DeviceArray<std::uint64_t>& texels) {
    StageTimer untimed;
    const uint count = row.width * row.height;
    upload<std::uint8_t>(gpu_, image_.reserve(rgba.size()), rgba);
    first_.enqueue(items(count, tuning_.light_group), untimed, image_.get(),
                   (srgb ? srgb_ : linear_).get(), count, row.first_texel, texels);
    uint width = row.width;
    uint height = row.height;
    for (uint level = 1; level < row.levels; ++level) {
        const std::size_t size = std::size_t{halved(width)} * halved(height);
        next_.enqueue(items(size, tuning_.light_group), untimed, texels,
                      row.first_texel + row.level_offset[level - 1], width, height,
                      row.first_texel + row.level_offset[level]);
        width = halved(width);
        height = halved(height);
    }
}

}  // namespace kilolux
