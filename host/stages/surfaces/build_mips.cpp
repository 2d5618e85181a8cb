// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/build_mips.h"

#include "host/base/formats/mips.h"

namespace kilolux {

BuildMips::BuildMips(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kBuildMipsStage)),
      next_(gpu, program_, kBuildMipsStage, "mip_next") {}

void BuildMips::enqueue(std::span<const std::uint64_t> first, const TextureRow& row,
                        const DeviceArray<std::uint64_t>& texels) {
    StageTimer untimed;
    gpu_.queue.enqueueWriteBuffer(texels, CL_TRUE, row.first_texel * sizeof(std::uint64_t),
                                  first.size_bytes(), first.data());
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
