// SPDX-License-Identifier: Apache-2.0
// Text about pictures: on stderr, and in the files themselves.
#pragma once

#include <string>

#include "present/cli/options.h"
#include "present/cli/stats_json.h"
#include "present/image/image_file.h"

namespace kilolux {

/// "rmse 0.0012 (threshold 0.01)"
std::string comparison_text(const Comparison& comparison);

/// Every shared option that changes the picture by its word, lights, clusters, device and version,
/// for an image's own attributes.
ImageNotes picture_notes(const SharedOptions& options, const DeviceInfo& device,
                         const FrameStats& stats);

/// What frame_summary() tells of a job.
struct JobSummary {
    std::size_t pictures = 1;
    double build_seconds = 0.0;  // of kernels
    bool by_stage = false;       // times by stages, not by groups of them
};

/// What is rendered, before it is: device, scene, and the picture with its renderer and grid.
std::string picture_header(const Renderer& renderer);

/// Lights, times of the last frame, how long kernels took to build where that was long, and the
/// files; several lines.
std::string frame_summary(const FrameRecord& last, const JobSummary& job);

}  // namespace kilolux
