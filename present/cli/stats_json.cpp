// SPDX-License-Identifier: Apache-2.0
#include "present/cli/stats_json.h"

#include <cstdio>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "present/cli/device_list.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

Json comparison_json(const Comparison& comparison) {
    Json out{{"metric", comparison.metric},
             {"value", comparison.value},
             {"threshold", comparison.threshold},
             {"passed", comparison.passed()}};
    for (const auto& [name, value] : comparison.errors) out["errors"][name] = value;
    return out;
}

// Adds what one frame measured to `out`.
void add_frame(Json& out, const FrameRecord& record) {
    const FrameStats& s = record.stats;
    out["lights"] = {{"given", s.lights_given},
                     {"used", s.lights_used},
                     {"rejected", s.lights_rejected},
                     {"dropped", s.lights_dropped}};
    out["normals"] = {{"zero", s.zero_normals}};
    out["clusters"] = {{"grid", {s.grid[0], s.grid[1], s.grid[2]}},
                       {"coarse_pairs", s.coarse_pairs},
                       {"active", s.active_clusters},
                       {"refined_pairs", s.refined_pairs}};
    const auto counted = [](double mean) { return mean < 0.0 ? Json(nullptr) : Json(mean); };
    out["evaluations"] = {{"per_pixel", counted(s.evaluations_per_pixel)},
                          {"useful_per_pixel", counted(s.useful_evaluations_per_pixel)}};
    out["stages"] = Json::array();
    for (const StageTime& stage : s.stages) {
        const Json limit = stage.limit_ms > 0.0 ? Json(stage.limit_ms) : Json(nullptr);
        out["stages"].push_back({{"name", stage.name}, {"ms", stage.ms}, {"limit_ms", limit}});
    }
    out["frame_ms"] = s.frame_ms;
    if (record.comparison) out["error"] = comparison_json(*record.comparison);
}

}  // namespace

Json cost_json(const FeatureCost& cost) {
    Json out = {{"name", cost.feature}, {"bytes_per_pixel", cost.bytes_per_pixel}};
    if (!cost.measured) {
        out["ms"] = nullptr;
        out["why"] = cost.why;
        return out;
    }
    out["ms"] = cost.ms;
    out["noise_ms"] = cost.noise_ms;
    out["percent"] = cost.percent;
    return out;
}

Json stats_json(const DeviceInfo& device, const ScenePlan& plan,
                const std::vector<FrameRecord>& frames, bool sequence,
                const std::vector<FeatureCost>& costs) {
    Json out;
    out["device"] = device_json(device);
    out["plan"] = plan.features;
    out["left_out"] = Json::array();
    for (const FeatureCost& cost : costs) out["left_out"].push_back(cost_json(cost));
    out["gbuffer_bytes_per_pixel"] = plan.gbuffer_bytes_per_pixel;
    if (!frames.empty()) add_frame(out, frames.back());
    if (!sequence) return out;
    out["frames"] = Json::array();
    for (const FrameRecord& record : frames) {
        Json entry{{"frame", record.frame}, {"time", record.time}, {"file", record.file}};
        add_frame(entry, record);
        out["frames"].push_back(std::move(entry));
    }
    return out;
}

void write_json(const std::string& file, const Json& document) {
    const std::string text =
        document.dump(2, ' ', false, nlohmann::detail::error_handler_t::replace) + "\n";
    if (file != "-") return write_whole_file(file, text);
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
        throw Error("standard output: cannot write");
    }
}

}  // namespace kilolux
