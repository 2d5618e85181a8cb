// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "host/gpu/flow.h"
#include "host/gpu/stage_info.h"
#include "host/stages/lists/prefix_sum.h"

namespace kilolux {

StageWork cull_lights_work(const StageCounts& counts);
inline constexpr StageInfo kCullLightsStage = {"cull_lights", StageGroup::lists, cull_lights_work};

/// Lists, for each coarse cluster, the lights whose sphere (and cone) touches the cluster's box.
///
/// A stable counting sort: count, prefix sum, fill. by_item: a work-item walks a chunk of lights.
/// by_group: a work-group takes a task, a cluster and a segment of the lights that can reach it. No
/// light is ever left out: the lists have as many entries as there are pairs. enqueue() works with
/// the room of the last frame; when that was too little, fits() grows it and the caller enqueues
/// the frame's lists again.
class CullLights {
 public:
    /// most_tasks: of the form by_group, to reserve, 12 bytes each, but at least one a cluster.
    /// With fewer, segments are longer.
    CullLights(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
               std::size_t most_tasks = std::size_t{1} << 22);

    /// Enqueues only. Lists ascend by light index within a cluster, whatever the tuning.
    /// `occupied`: ActiveClusters'; other clusters get empty lists. Null: all get lists.
    CoarseLists enqueue(const PreparedLights& lights, const ClusterBoxes& boxes, StageTimer& timer,
                        const DeviceArray<std::uint8_t>& occupied = {});

    /// The brute-force kernel: every light against every cluster's box; blocks. The oracle. Lists
    /// are enqueue()'s plus lights that touch only the part of a box outside the cluster's part of
    /// the frustum. Its times count to "cull_lights_brute_force", but for the prefix sum's.
    CoarseLists brute_force(const PreparedLights& lights, const ClusterBoxes& boxes,
                            StageTimer& timer);

    /// Pairs of the last enqueue: on the device; on the host, which blocks.
    DeviceArray<std::uint64_t> total() const { return lists_.total(); }
    std::uint64_t pairs() const { return lists_.read_total(); }

    /// True if there is room for the last enqueue's `pairs`; else makes room for the next. Without
    /// a number it blocks to read it. Throws Error when the pairs exceed what 32-bit offsets or the
    /// device can hold.
    bool fits(std::uint64_t pairs) { return lists_.fits(pairs); }
    bool fits() { return fits(pairs()); }

 private:
    std::size_t cursor_stride(const ClusterGrid& grid) const;
    std::size_t segment_count(std::size_t lights, const ClusterGrid& grid) const;
    CoarseLists lists_so_far(const DeviceArray<uint>& offsets) const;
    CoarseLists enqueue_by_item(const PreparedLights& lights, const ClusterBoxes& boxes,
                                StageTimer& timer, const DeviceArray<std::uint8_t>& occupied);
    CoarseLists enqueue_by_group(const PreparedLights& lights, const ClusterBoxes& boxes,
                                 StageTimer& timer, const DeviceArray<std::uint8_t>& occupied);

    // What work-groups skip by, and their tasks: clusters and segments of lights that reach them.
    struct ByGroup {
        ByGroup(const Gpu& gpu, const KernelProgram& program);
        Kernel cull_blocks, cull_tasks;
        GrowingArray<LightExtent> blocks, spans;
        uint segment_count = 0;
        GrowingArray<uint> task_count, tasks, cluster_tasks, task_lights, task_starts;

        void each(auto&& set) const {  // TASK_ARGS of kernels/lists/cull_lights_by_group.cl
            set("segment_count", segment_count);
            set("blocks", blocks.get());
            set("spans", spans.get());
            set("task_count", task_count.get());
            set("tasks", tasks.get());
        }
    };

    Tuning tuning_;
    std::size_t most_tasks_;
    std::size_t groups_;  // that share the tasks
    int block_group_;     // work-items that join a span's extents
    KernelProgram program_;
    Kernel count_, starts_, fill_, brute_force_;
    std::optional<ByGroup> by_group_;
    GrowingArray<uint> cursors_;  // by_item
    CountedList lists_;
};

}  // namespace kilolux
