// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/bench/feature_cost.h"
#include "host/picture/frame.h"
#include "host/render/renderer.h"
#include "present/image/comparison.h"

namespace kilolux {

/// What there is to say about one rendered frame.
struct FrameRecord {
    int frame = 0;      // number in the sequence
    double time = 0.0;  // [s]
    std::string file;
    FrameStats stats;
    std::optional<Comparison> comparison;
};

/// The document of --stats. At the top the keys that tools may rely on: device, plan, lights,
/// clusters, evaluations, stages, frame_ms, and error when a reference was given; of the last
/// frame. `frames` is added for a sequence and has the same for each frame. What was not counted is
/// null. `left_out`: what the plan leaves out, with its costs as `costs` knows them.
nlohmann::ordered_json stats_json(const DeviceInfo& device, const ScenePlan& plan,
                                  const std::vector<FrameRecord>& frames, bool sequence,
                                  const std::vector<FeatureCost>& costs = {});

/// Name, bytes a pixel, and either times or why there are none.
nlohmann::ordered_json cost_json(const FeatureCost& cost);

/// Writes a document, whole or not at all; "-" is standard output.
void write_json(const std::string& file, const nlohmann::ordered_json& document);

}  // namespace kilolux
