// SPDX-License-Identifier: Apache-2.0
#include "present/cli/stats_json.h"

#include <array>

#include "host/base/error.h"
#include "host/base/system/atomic_write.h"
#include "host/measure/roofline/stage_report.h"
#include "host/picture/listed_lights.h"

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
                     {"dropped", 0}};  // lists have no capacity limit
    out["normals"] = {{"zero", s.zero_normals}};
    out["clusters"] = {{"grid", {s.grid[0], s.grid[1], s.grid[2]}},
                       {"coarse_pairs", s.coarse_pairs},
                       {"active", s.active_clusters},
                       {"refined_pairs", s.refined_pairs}};
    if (s.triangles > 0) {
        out["triangles"] = {{"in_view", s.triangles}, {"tile_pairs", s.triangle_pairs}};
    }
    if (s.layers > 0) out["layers"] = {{"most", s.layers}, {"pixels", s.layer_pixels}};
    if (s.layer_tiles > 0) out["layers"]["tiles"] = s.layer_tiles;
    const auto counted = [&](double mean) {
        return mean < 0.0 || !lists_lights(s) ? Json(nullptr) : Json(mean);
    };
    out["evaluations"] = {{"per_pixel", counted(s.evaluations_per_pixel)},
                          {"useful_per_pixel", counted(s.useful_evaluations_per_pixel)}};
    if (s.samples.total > 0) {
        out["samples"] = {{"of_all_pixels", s.samples.total},
                          {"least", s.samples.least},
                          {"most", s.samples.most},
                          {"tiles", s.samples.tiles},
                          {"tiles_above_error", s.samples.open_tiles}};
    }
    out["stages"] = Json::array();
    for (const StageTime& stage : s.stages) {
        const Json limit = stage.limit_ms > 0.0 ? Json(stage.limit_ms) : Json(nullptr);
        out["stages"].push_back({{"name", stage.name}, {"ms", stage.ms}, {"limit_ms", limit}});
    }
    out["stages"].push_back(
        {{"name", kOtherStage.name}, {"ms", outside_stages_ms(s)}, {"limit_ms", nullptr}});
    out["frame_ms"] = s.frame_ms;
    out["build_ms"] = s.build_ms;
    if (record.comparison) out["error"] = comparison_json(*record.comparison);
}

std::string printed(const Json& json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::detail::error_handler_t::replace);
}

[[noreturn]] void fail_to_print() { throw Error("standard output: cannot write"); }

}  // namespace

Json device_json(const DeviceInfo& device) {
    return {{"name", device.name},
            {"version", device.version},
            {"driver", device.driver},
            {"platform", device.platform},
            {"cpu", device.is_cpu},
            {"lane_width", device.lane_width},
            {"compute_units", device.compute_units},
            {"memory_bytes", device.memory_bytes},
            {"max_allocation_bytes", device.max_allocation_bytes}};
}

Json cost_json(const FeatureCost& cost) {
    Json out = {{"name", cost.feature}, {"bytes_per_pixel", cost.bytes_per_pixel}};
    if (!cost.measured) {
        out["ms"] = nullptr;
        out["why"] = cost.why;
        return out;
    }
    out["measurable"] = cost.measurable;
    out["ms"] = cost.ms;
    out["noise_ms"] = cost.noise_ms;
    out["percent"] = cost.percent;
    return out;
}

Json stats_json(const DeviceInfo& device, const ScenePlan& plan, const FrameRecord& last) {
    Json out;
    out["device"] = device_json(device);
    out["plan"] = plan.features;
    out["left_out"] = Json::array();
    for (const FeatureCost& cost : left_out_features(plan))
        out["left_out"].push_back(cost_json(cost));
    out["gbuffer_bytes_per_pixel"] = plan.gbuffer_bytes_per_pixel;
    add_frame(out, last);
    return out;
}

FrameLog::FrameLog() : file_(std::tmpfile(), std::fclose) {
    if (!file_) fail_to_write(std::filesystem::temp_directory_path());
}

void FrameLog::add(const FrameRecord& record) {
    Json entry{{"frame", record.frame}, {"time", record.time}, {"file", record.file}};
    add_frame(entry, record);
    const std::string text = (empty_ ? "    " : ",\n    ") + printed(entry, -1);
    empty_ = false;
    if (std::fputs(text.c_str(), file_.get()) < 0) {
        fail_to_write(std::filesystem::temp_directory_path());
    }
}

void FrameLog::read(const std::function<void(std::string_view)>& take) const {
    if (std::fflush(file_.get()) != 0) fail_to_write(std::filesystem::temp_directory_path());
    std::rewind(file_.get());
    std::array<char, 65536> text;
    while (const std::size_t size = std::fread(text.data(), 1, text.size(), file_.get())) {
        take({text.data(), size});
    }
    if (std::ferror(file_.get())) throw Error("temporary file: cannot read");
}

void write_json(const std::string& file, const Json& document, const FrameLog* frames) {
    std::optional<AtomicFile> out;
    if (file != "-") out.emplace(file);
    const auto write = [&out](std::string_view text) {
        if (out) return out->write(text);
        if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail_to_print();
    };
    std::string text = printed(document, 2);
    if (frames != nullptr) {
        text.resize(text.size() - 2);  // "\n}"
        write(text + ",\n  \"frames\": [\n");
        frames->read(write);
        text = "\n  ]\n}";
    }
    write(text + "\n");
    if (out) return out->commit();
    if (std::fflush(stdout) != 0) fail_to_print();
}

void print_result(bool json, const Json& document, const std::string& text) {
    if (json) return write_json("-", document);
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);  // before what follows on stderr, where both are one file
}

}  // namespace kilolux
