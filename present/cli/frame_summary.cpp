// SPDX-License-Identifier: Apache-2.0
#include "present/cli/frame_summary.h"

#include <charconv>
#include <cstdio>

#include "host/base/version.h"
#include "present/cli/names.h"

namespace kilolux {
namespace {

std::string fixed(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string grid_text(const FrameStats& stats) {
    return std::to_string(stats.grid[0]) + "x" + std::to_string(stats.grid[1]) + "x" +
           std::to_string(stats.grid[2]);
}

std::string time_line(const std::string& name, double ms) {
    char line[160];
    std::snprintf(line, sizeof line, "  %-16s %9.2f ms", name.c_str(), ms);
    return line;
}

std::string stage_lines(const FrameStats& stats) {
    std::string out;
    for (const StageTime& stage : stats.stages) {
        out += time_line(stage.name, stage.ms);
        if (stage.limit_ms > 0.0) out += "  (limit " + fixed(stage.limit_ms, 2) + " ms)";
        out += "\n";
    }
    return out;
}

std::string light_line(const FrameStats& s) {
    std::string out = "lights  " + std::to_string(s.lights_used) + " of " +
                      std::to_string(s.lights_given) + " used, " +
                      std::to_string(s.lights_rejected) + " rejected, " +
                      std::to_string(s.lights_dropped) + " dropped";
    if (s.evaluations_per_pixel >= 0.0) {
        out += "; " + fixed(s.evaluations_per_pixel, 1) + " evaluated a pixel";
    }
    if (s.useful_evaluations_per_pixel >= 0.0) {
        out += ", " + fixed(s.useful_evaluations_per_pixel, 1) + " useful";
    }
    return out + "\n";
}

std::string cluster_line(const FrameStats& s) {
    if (s.grid[0] == 0) return "";
    return "grid    " + grid_text(s) + " clusters, " + std::to_string(s.coarse_pairs) + " pairs; " +
           std::to_string(s.active_clusters) + " active, " + std::to_string(s.refined_pairs) +
           " pairs\n";
}

}  // namespace

std::string number_text(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return {text, end};
}

std::string comparison_text(const Comparison& comparison) {
    return comparison.metric + " " + number_text(comparison.value) + " (threshold " +
           number_text(comparison.threshold) + ")";
}

ImageNotes picture_notes(const SharedOptions& options, const DeviceInfo& device,
                         const FrameStats& stats) {
    ImageNotes notes;
    notes.strings = {{"scene", options.scene},
                     {"lights", std::to_string(stats.lights_given)},
                     {"seed", std::to_string(options.settings.lights.seed)},
                     {"renderer", name_of(options.settings.renderer)},
                     {"shading", name_of(options.settings.shading)},
                     {"gbuffer", gbuffer_names().at(options.settings.gbuffer)},
                     {"grid", grid_text(stats)},
                     {"device", device.name + ", " + device.version},
                     {"version", version()}};
    return notes;
}

std::string frame_summary(const Scene& scene, const DeviceInfo& device,
                          const std::vector<FrameRecord>& records) {
    const FrameRecord& last = records.back();
    std::string out = "device  " + device.name + " (" + device.version + "), " +
                      std::to_string(device.lane_width) + " lanes\n" + "scene   " + scene.name +
                      ", " + std::to_string(triangle_count(scene)) + " triangles\n" +
                      light_line(last.stats) + cluster_line(last.stats) + stage_lines(last.stats) +
                      time_line("frame", last.stats.frame_ms) + "\n";
    if (last.comparison) out += "error   " + comparison_text(*last.comparison) + "\n";
    out += "wrote   " + last.file;
    if (records.size() > 1) out += " and " + std::to_string(records.size() - 1) + " more";
    return out;
}

Verbosity verbosity_of(const SharedOptions& options) {
    if (options.quiet) return Verbosity::quiet;
    return options.verbose ? Verbosity::verbose : Verbosity::normal;
}

}  // namespace kilolux
