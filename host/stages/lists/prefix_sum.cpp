// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/prefix_sum.h"

#include <algorithm>

#include "host/gpu/memory/list_size.h"

namespace kilolux {
namespace {

// Counts of earlier blocks that a work-item of the last block loads, at most, in one launch; beyond
// it three launches are faster (NVIDIA H200).
constexpr std::size_t kMostLoads = 256;

BuildOptions options_of(const Tuning& tuning) {
    return BuildOptions()
        .define("GROUP", tuning.prefix_group)
        .define("PER_ITEM", tuning.prefix_per_item);
}

}  // namespace

PrefixSum::PrefixSum(const Gpu& gpu, const Tuning& tuning, std::string_view stage)
    : tuning_(tuning),
      program_(build_program(gpu, "prefix_sum", options_of(tuning))),
      few_(gpu, program_, stage, "prefix_sum_few"),
      sum_blocks_(gpu, program_, stage, "prefix_sum_blocks"),
      scan_totals_(gpu, program_, stage, "prefix_sum_totals"),
      apply_(gpu, program_, stage, "prefix_sum_apply"),
      block_sums_(gpu, stage),
      total_(gpu, stage) {
    total_.reserve(1);
}

void PrefixSum::enqueue(const DeviceArray<uint>& counts, uint n, const DeviceArray<uint>& offsets,
                        StageTimer& timer) {
    const auto block = static_cast<std::size_t>(tuning_.prefix_group) *
                       static_cast<std::size_t>(tuning_.prefix_per_item);
    const std::size_t blocks = std::max<std::size_t>((n + block - 1) / block, 1);
    const WorkSize size = groups(blocks, tuning_.prefix_group);
    const std::size_t loads = (blocks - 1) * static_cast<std::size_t>(tuning_.prefix_per_item);
    if (loads <= kMostLoads) {
        few_.enqueue(size, timer, counts, n, offsets, total_.get());
        return;
    }
    const DeviceArray<std::uint64_t> sums = block_sums_.reserve(blocks);
    sum_blocks_.enqueue(size, timer, counts, n, sums);
    scan_totals_.enqueue(items(1, 1), timer, sums, static_cast<uint>(blocks), n, offsets,
                         total_.get());
    apply_.enqueue(size, timer, counts, n, sums, offsets);
}

CountedList::CountedList(const Gpu& gpu, const Tuning& tuning, std::string_view stage,
                         std::string_view entries, std::size_t entry_bytes)
    : gpu_(gpu),
      stage_(stage),
      name_(entries),
      entry_bytes_(entry_bytes),
      prefix_sum_(gpu, tuning, stage),
      counts_(gpu, stage),
      offsets_(gpu, stage),
      entries_(gpu, stage),
      total_(gpu) {}

DeviceArray<uint> CountedList::enqueue_offsets(uint n, StageTimer& timer) {
    DeviceArray<uint> offsets = offsets_.reserve(n + std::size_t{1});
    prefix_sum_.enqueue(counts_.get(), n, offsets, timer);
    total_.drop();
    return offsets;
}

void CountedList::start_read(StageTimer& timer) { total_.start(total(), stage_, timer); }

std::uint64_t CountedList::read_total() const {
    return total_.is_started() ? total_.get() : download(gpu_, total()).front();
}

uint CountedList::capacity() const {
    return static_cast<uint>(std::min<std::size_t>(entries_.bytes() / entry_bytes_, kMostEntries));
}

bool CountedList::fits(std::uint64_t entries) {
    const std::size_t needed = checked_list_size(entries, stage_, name_);
    if (needed <= capacity()) return true;
    entries_.reserve(needed * entry_bytes_, needed / 8 * entry_bytes_);
    return false;
}

}  // namespace kilolux
