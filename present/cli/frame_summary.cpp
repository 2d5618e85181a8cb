// SPDX-License-Identifier: Apache-2.0
#include "present/cli/frame_summary.h"

#include <fmt/format.h>

#include <map>

#include "host/base/version.h"
#include "host/measure/bench/sweep.h"
#include "host/measure/roofline/stage_report.h"
#include "host/measure/roofline/stages.h"
#include "host/picture/listed_lights.h"
#include "present/cli/names.h"
#include "present/cli/option_values.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

std::string grid_text(const FrameStats& stats) {
    return fmt::format("{}x{}x{}", stats.grid[0], stats.grid[1], stats.grid[2]);
}

std::string time_line(std::string_view name, double ms) {
    return fmt::format("  {:<16} {:9.2f} ms", name, ms);
}

std::string group_lines(const FrameStats& stats) {
    std::map<StageGroup, double> times = {{StageGroup::host, outside_stages_ms(stats)}};
    for (const StageTime& stage : stats.stages) times[group_of(stage.name)] += stage.ms;
    std::string out;
    for (const auto& [group, ms] : times)
        out += time_line(kStageGroupNames[static_cast<std::size_t>(group)], ms) + "\n";
    return out;
}

std::string stage_lines(const FrameStats& stats) {
    std::string out;
    for (const StageTime& stage : stats.stages) {
        out += time_line(stage.name, stage.ms);
        if (stage.limit_ms > 0.0) out += fmt::format("  (limit {:.2f} ms)", stage.limit_ms);
        out += "\n";
    }
    return out + time_line(kOtherStage, outside_stages_ms(stats)) + "\n";
}

std::string light_line(const FrameStats& s) {
    std::string out = fmt::format("lights  {} of {} used, {} rejected", s.lights_used,
                                  s.lights_given, s.lights_rejected);
    const bool listed = lists_lights(s);
    if (listed && s.evaluations_per_pixel >= 0.0) {
        out += fmt::format("; {:.1f} evaluated a pixel", s.evaluations_per_pixel);
    }
    if (listed && s.useful_evaluations_per_pixel >= 0.0) {
        out += fmt::format(", {:.1f} useful", s.useful_evaluations_per_pixel);
    }
    return out + "\n";
}

std::string cluster_line(const FrameStats& s) {
    if (s.grid[0] == 0) return "";
    return fmt::format("grid    {} clusters, {} pairs; {} active, {} pairs\n", grid_text(s),
                       s.coarse_pairs, s.active_clusters, s.refined_pairs);
}

std::string layer_line(const FrameStats& s) {
    if (s.layers == 0) return "";
    return fmt::format("layers  {} over one pixel at most, {} layer pixels in all\n", s.layers,
                       s.layer_pixels);
}

std::string sample_line(const SampleCounts& s) {
    if (s.total == 0) return "";
    const double mean = static_cast<double>(s.total) / static_cast<double>(s.pixels);
    const std::string tiles =
        s.open_tiles == 0
            ? fmt::format("all {} tiles are within --sample-error", s.tiles)
            : fmt::format("{} of {} tiles are not within --sample-error", s.open_tiles, s.tiles);
    return fmt::format("samples {:.1f} a pixel, from {} to {}; {}\n", mean, s.least, s.most, tiles);
}

}  // namespace

std::string comparison_text(const Comparison& comparison) {
    std::string value = fmt::format("{:.6g}", comparison.value);
    const std::string threshold = fmt::format("{:.6g}", comparison.threshold);
    if (value == threshold)
        value = text_of(
            comparison.value);  // a value just above the threshold must not look equal to it
    return fmt::format("{} {} (threshold {})", comparison.metric, value, threshold);
}

ImageNotes picture_notes(const SharedOptions& options, const DeviceInfo& device,
                         const FrameStats& stats) {
    ImageNotes notes;
    SharedOptions shown = options;
    for (const Setting& setting : settings_of(shown)) {
        const std::string text = setting.show();
        const bool is_noted = setting.text.effect.changes == Changes::picture && !text.empty();
        if (is_noted) notes.strings.emplace_back(setting.word(), text);
    }
    const std::string lights = fmt::format("{}", stats.lights_given);
    notes.strings.insert(notes.strings.end(), {{"lights-given", lights},
                                               {"clusters", grid_text(stats)},
                                               {"device", device.name + ", " + device.version},
                                               {"version", version()}});
    return notes;
}

std::string picture_header(const Renderer& renderer) {
    const DeviceInfo& device = renderer.device();
    const RenderSettings& s = renderer.settings();
    const Scene& scene = renderer.scene();
    std::string out =
        fmt::format("device  {} ({}), {} lanes\nscene   {}, {} triangles\npicture {}x{}, {}",
                    device.name, device.version, device.lane_width, scene.name,
                    triangle_count(scene), s.width, s.height, name_of(s.renderer));
    if (has_clusters(s.renderer)) {
        out += fmt::format(", grid {}x{}x{}", s.grid.tiles_x, s.grid.tiles_y,
                           s.grid.slices_per_octave);
    }
    return out + (s.samples > 1 ? fmt::format(", {} samples", s.samples) : "");
}

std::string frame_summary(const FrameRecord& last, const JobSummary& job) {
    std::string out = light_line(last.stats) + layer_line(last.stats) +
                      sample_line(last.stats.samples) + cluster_line(last.stats) +
                      (job.by_stage ? stage_lines(last.stats) : group_lines(last.stats)) +
                      time_line(kFrameStage, last.stats.frame_ms) + "\n";
    if (job.build_seconds >= kLongBuildSeconds) {
        out += fmt::format("kernels built in {:.1f} s; drivers keep them for the next run\n",
                           job.build_seconds);
    }
    if (last.comparison) out += "error   " + comparison_text(*last.comparison) + "\n";
    out += "wrote   " + last.file;
    if (is_video(last.file) || last.file == output_name("-"))
        return out + fmt::format(", {} frames", job.pictures);
    if (job.pictures > 1) out += fmt::format(" and {} more", job.pictures - 1);
    return out;
}

}  // namespace kilolux
