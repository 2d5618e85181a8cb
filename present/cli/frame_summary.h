// SPDX-License-Identifier: Apache-2.0
// What the program says about its pictures in words: on stderr, and in the files themselves.
#pragma once

#include <string>
#include <vector>

#include "host/base/log.h"
#include "present/cli/options.h"
#include "present/cli/stats_json.h"
#include "present/image/image_file.h"

namespace kilolux {

/// The shortest text that reads back as the same number.
std::string number_text(double value);

/// "rmse 0.0012 (threshold 0.01)"
std::string comparison_text(const Comparison& comparison);

/// Scene, seed, lights, renderer, grid, device and version, for an image's own attributes.
ImageNotes picture_notes(const SharedOptions& options, const DeviceInfo& device,
                         const FrameStats& stats);

/// Device, what was lit, what it cost a stage (of the last frame), and the files; several lines.
std::string frame_summary(const Scene& scene, const DeviceInfo& device,
                          const std::vector<FrameRecord>& records);

Verbosity verbosity_of(const SharedOptions& options);

}  // namespace kilolux
