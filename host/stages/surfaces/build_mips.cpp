// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/build_mips.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "host/base/srgb.h"

namespace kilolux {
namespace {

constexpr std::string_view kBuildMipsStage = "build_mips";

using CodeTable = std::array<std::uint16_t, 256>;

CodeTable srgb_codes() {
    CodeTable out;
    for (std::size_t code = 0; code < out.size(); ++code) {
        const double linear = srgb_to_linear(static_cast<double>(code) / 255.0);
        out[code] = static_cast<std::uint16_t>(std::lround(65535.0 * linear));
    }
    return out;
}

CodeTable linear_codes() {
    CodeTable out;
    for (std::size_t code = 0; code < out.size(); ++code) {
        out[code] = static_cast<std::uint16_t>(257 * code);
    }
    return out;
}

uint halved(uint size) { return std::max(size / 2, 1u); }

}  // namespace

std::size_t mip_texels(uint width, uint height) {
    std::size_t texels = std::size_t{width} * height;
    while (width > 1 || height > 1) {
        width = halved(width);
        height = halved(height);
        texels += std::size_t{width} * height;
    }
    return texels;
}

void place_mips(TextureRow& row, uint width, uint height, std::size_t first_texel) {
    row.width = width;
    row.height = height;
    row.levels = static_cast<uint>(std::bit_width(std::max(width, height)));
    row.first_texel = static_cast<uint>(first_texel);
    std::size_t offset = 0;
    for (uint level = 0; level < row.levels; ++level) {
        row.level_offset[level] = static_cast<uint>(offset);
        offset += std::size_t{width} * height;
        width = halved(width);
        height = halved(height);
    }
}

BuildMips::BuildMips(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kBuildMipsStage)),
      first_(gpu, program_, kBuildMipsStage, "mip_first"),
      next_(gpu, program_, kBuildMipsStage, "mip_next"),
      srgb_(gpu, kBuildMipsStage),
      linear_(gpu, kBuildMipsStage),
      image_(gpu, kBuildMipsStage) {
    upload<std::uint16_t>(gpu_, srgb_.reserve(256), srgb_codes());
    upload<std::uint16_t>(gpu_, linear_.reserve(256), linear_codes());
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
