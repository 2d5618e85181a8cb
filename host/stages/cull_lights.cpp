// SPDX-License-Identifier: Apache-2.0
#include "host/stages/cull_lights.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kStage = "cull_lights";
// Room to begin with: enough for most scenes' first frame.
constexpr std::size_t kFirstEntries = std::size_t{1} << 20;

}  // namespace

CullLights::CullLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      index_bytes_(static_cast<std::size_t>(features.light_index_bits / 8)),
      program_(build_program(
          gpu, kStage,
          BuildOptions()
              .define("HAS_SPOT_LIGHTS", features.spot_lights)
              .define("LIGHT_INDEX", features.light_index_bits == 16 ? "ushort" : "uint"))),
      prefix_sum_(gpu, tuning),
      cursors_(gpu, kStage),
      counts_(gpu, kStage),
      offsets_(gpu, kStage),
      lists_(gpu, kStage) {
    lists_.reserve(kFirstEntries * index_bytes_);
}

// Of kernels/cull_lights.cl: as many vectors of lanes as hold a chunk's clusters.
std::size_t CullLights::cursor_stride(const ClusterGrid& grid) const {
    return round_up(grid.cluster_count, static_cast<std::size_t>(gpu_.info.lane_width));
}

CoarseLists CullLights::make_lists(const ClusterGrid& grid) {
    CoarseLists out;
    out.offsets = offsets_.reserve((grid.cluster_count + std::size_t{1}) * sizeof(uint));
    out.lists = lists_.get();
    out.capacity =
        static_cast<uint>(std::min<std::size_t>(lists_.bytes() / index_bytes_, 0xfffffff0u));
    counts_.reserve(cursor_stride(grid) * sizeof(uint));
    return out;
}

CoarseLists CullLights::enqueue(const PreparedLights& lights, const ClusterBoxes& boxes,
                                StageTimer& timer, const cl::Buffer& occupied) {
    return in_stage(kStage, [&] {
        const ClusterGrid& grid = boxes.grid;
        CoarseLists out = make_lists(grid);
        const auto chunks =
            std::clamp<std::size_t>(lights.count, 1, static_cast<std::size_t>(tuning_.cull_chunks));
        const auto group = static_cast<std::size_t>(tuning_.cull_group);
        const cl::EnqueueArgs chunk_items(gpu_.queue, cl::NDRange(chunks * group),
                                          cl::NDRange(group));
        const cl::Buffer& cursors = cursors_.reserve(chunks * cursor_stride(grid) * sizeof(uint));
        cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, uint, ClusterGrid, cl::Buffer,
                          cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer>
            count(program_, "cull_lights_count");
        timer.record(kStage,
                     count(chunk_items, lights.lights, lights.bounds, lights.extents, lights.count,
                           grid, boxes.columns, boxes.rows, boxes.depths, occupied, cursors));
        cl::KernelFunctor<uint, uint, cl::Buffer, cl::Buffer> offset(program_,
                                                                     "cull_lights_offset");
        const auto map_group = static_cast<std::size_t>(tuning_.light_group);
        const std::size_t vectors =
            cursor_stride(grid) / static_cast<std::size_t>(gpu_.info.lane_width);
        timer.record(kStage,
                     offset(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(vectors, map_group)),
                                            cl::NDRange(map_group)),
                            grid.cluster_count, static_cast<uint>(chunks), cursors, counts_.get()));
        prefix_sum_.enqueue(counts_.get(), grid.cluster_count, out.offsets, timer, kStage);
        cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, uint, ClusterGrid, cl::Buffer,
                          cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer,
                          uint>
            fill(program_, "cull_lights_fill");
        timer.record(kStage, fill(chunk_items, lights.lights, lights.bounds, lights.extents,
                                  lights.count, grid, boxes.columns, boxes.rows, boxes.depths,
                                  occupied, cursors, out.offsets, out.lists, out.capacity));
        return out;
    });
}

CoarseLists CullLights::brute_force(const PreparedLights& lights, const ClusterBoxes& boxes,
                                    StageTimer& timer) {
    return in_stage("cull_lights_brute_force", [&] {
        const ClusterGrid& grid = boxes.grid;
        CoarseLists out = make_lists(grid);
        cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, uint, ClusterGrid, cl::Buffer,
                          cl::Buffer, cl::Buffer, uint, cl::Buffer, cl::Buffer, cl::Buffer>
            kernel(program_, "cull_lights_brute_force");
        const auto group = static_cast<std::size_t>(tuning_.light_group);
        const cl::EnqueueArgs items(gpu_.queue, cl::NDRange(round_up(grid.cluster_count, group)),
                                    cl::NDRange(group));
        const auto run = [&](uint fill) {
            timer.record("cull_lights_brute_force",
                         kernel(items, lights.lights, lights.bounds, lights.extents, lights.count,
                                grid, boxes.columns, boxes.rows, boxes.depths, fill, counts_.get(),
                                out.offsets, out.lists));
        };
        run(0);
        prefix_sum_.enqueue(counts_.get(), grid.cluster_count, out.offsets, timer,
                            "cull_lights_brute_force");
        if (!fits()) out = make_lists(grid);
        run(1);
        return out;
    });
}

bool CullLights::fits() {
    const std::uint64_t entries = std::uint64_t{checked_list_size(pairs(), kStage)};
    if (entries * index_bytes_ <= lists_.bytes()) return true;
    // An eighth more, so that moving lights do not grow it frame by frame.
    lists_.reserve((entries + entries / 8) * index_bytes_);
    return false;
}

}  // namespace kilolux
