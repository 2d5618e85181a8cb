// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/measure/bench/feature_cost.h"
#include "host/picture/frame.h"
#include "host/render/renderer.h"
#include "present/image/comparison.h"

namespace kilolux {

/// One rendered frame: its counts, times and file.
struct FrameRecord {
    int frame = 0;      // number in the sequence
    double time = 0.0;  // [s]
    std::string file;
    FrameStats stats;
    std::optional<Comparison> comparison;
};

/// The document of --stats, with the keys that tools may rely on: device, plan, lights, clusters,
/// evaluations, stages, frame_ms, and error when a reference was given; of the last frame. Values
/// that were not counted are null. lights.dropped is always 0, because lists have no capacity
/// limit. `left_out`: features that the plan leaves out, and the bytes that each would add to a
/// pixel.
nlohmann::ordered_json stats_json(const DeviceInfo& device, const ScenePlan& plan,
                                  const FrameRecord& last);

/// The frames of a sequence, with the same keys each and its number, time and file. Kept in a
/// temporary file, as there may be many. Throws Error when that cannot be written.
class FrameLog {
 public:
    FrameLog();
    void add(const FrameRecord& record);

    /// Calls `take` with the text, a JSON object a line, piece by piece.
    void read(const std::function<void(std::string_view)>& take) const;

 private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    bool empty_ = true;
};

nlohmann::ordered_json device_json(const DeviceInfo& device);

/// Name, bytes a pixel, and either times or the reason why there are none.
nlohmann::ordered_json cost_json(const FeatureCost& cost);

/// Writes a document, whole or not at all; "-" is standard output. With `frames`, they become its
/// last key, "frames".
void write_json(const std::string& file, const nlohmann::ordered_json& document,
                const FrameLog* frames = nullptr);

/// A command's result on standard output: the document with --json, else the text.
void print_result(bool json, const nlohmann::ordered_json& document, const std::string& text);

}  // namespace kilolux
