// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/stage_info.h"

namespace kilolux {

/// Every stage. FrameStats::stages has only those that a frame runs: counting, decoding, and the
/// installed library's packing are not timed.
std::span<const StageInfo* const> all_stages();

/// A stage by its name in FrameStats::stages; null for one that is not among them.
const StageInfo* stage_info(std::string_view name);

/// The group of a row; host for one that is no stage.
StageGroup group_of(std::string_view stage);

}  // namespace kilolux
