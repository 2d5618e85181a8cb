// SPDX-License-Identifier: Apache-2.0
#include "host/stages/refine_lights.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kStage = "refine_lights";
constexpr std::size_t kFirstEntries = std::size_t{1} << 20;

BuildOptions options_of(const Tuning& tuning, const KernelFeatures& features) {
    return BuildOptions()
        .define("GROUP", tuning.refine_group)
        .define("HAS_SPOT_LIGHTS", features.spot_lights)
        .define("LIGHT_INDEX", features.light_index_bits == 16 ? "ushort" : "uint");
}

}  // namespace

RefineLights::RefineLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      index_bytes_(static_cast<std::size_t>(features.light_index_bits / 8)),
      program_(build_program(gpu, kStage, options_of(tuning, features))),
      prefix_sum_(gpu, tuning),
      reserves_(gpu, kStage),
      offsets_(gpu, kStage),
      lists_(gpu, kStage) {
    lists_.reserve(kFirstEntries * index_bytes_);
}

RefinedLists RefineLights::enqueue(const PreparedLights& lights, const CoarseLists& coarse,
                                   const ActiveClusters& clusters, const View& view,
                                   const ClusterGrid& grid, StageTimer& timer) {
    return in_stage(kStage, [&] {
        RefinedLists out;
        out.lists = lists_.get();
        out.capacity =
            static_cast<uint>(std::min<std::size_t>(lists_.bytes() / index_bytes_, 0xfffffff0u));
        const uint tiles = clusters.tile_count;
        const cl::Buffer& reserves = reserves_.reserve(tiles * sizeof(uint));
        const cl::Buffer& offsets = offsets_.reserve((tiles + std::size_t{1}) * sizeof(uint));
        const auto map_group = static_cast<std::size_t>(tuning_.light_group);
        cl::KernelFunctor<View, ClusterGrid, uint, cl::Buffer, cl::Buffer, uint, cl::Buffer,
                          cl::Buffer>
            reserve(program_, "refine_lights_reserve");
        timer.record(kStage,
                     reserve(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(tiles, map_group)),
                                             cl::NDRange(map_group)),
                             view, grid, tiles, clusters.offsets, clusters.clusters,
                             clusters.capacity, coarse.offsets, reserves));
        prefix_sum_.enqueue(reserves, tiles, offsets, timer, kStage);
        const auto group = static_cast<std::size_t>(tuning_.refine_group);
        cl::KernelFunctor<cl::Buffer, cl::Buffer, View, ClusterGrid, cl::Buffer, cl::Buffer, uint,
                          cl::Buffer, cl::Buffer, uint, cl::Buffer, cl::Buffer, uint>
            refine(program_, "refine_lights");
        timer.record(
            kStage,
            refine(cl::EnqueueArgs(gpu_.queue, cl::NDRange(tiles * group), cl::NDRange(group)),
                   lights.lights, lights.bounds, view, grid, coarse.offsets, coarse.lists,
                   coarse.capacity, clusters.offsets, clusters.clusters, clusters.capacity, offsets,
                   out.lists, out.capacity));
        return out;
    });
}

bool RefineLights::fits() {
    const std::uint64_t needed =
        std::uint64_t{checked_list_size(prefix_sum_.total(), kStage)} * index_bytes_;
    if (needed <= lists_.bytes()) return true;
    lists_.reserve(needed + needed / 8);
    return false;
}

}  // namespace kilolux
