// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/panel_stats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <algorithm>

#include "host/base/text.h"
#include "host/picture/listed_lights.h"

namespace kilolux {
namespace {

std::string fixed(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

void cell(const std::string& text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
}

void number_cell(const std::string& text) {
    ImGui::TableNextColumn();
    const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(room, 0.0f));
    ImGui::TextUnformatted(text.c_str());
}

void stage_row(const StageHistory& history, std::size_t stage,
               const std::vector<StageReport>& reports) {
    const double ms = history.median_ms(stage);
    if (ms < 0.0) return;
    const std::string& name = history.stages()[stage];
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = 0.62f * ImGui::GetFontSize();
    const float drop = 0.5f * (ImGui::GetTextLineHeight() - side);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, at.y + drop}, {at.x + side, at.y + drop + side}, stage_color(stage), 2.0f);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 1.6f * side);
    ImGui::TextUnformatted(name.c_str());
    const auto found = std::find_if(reports.begin(), reports.end(),
                                    [&](const StageReport& r) { return r.stage == name; });
    const bool limited = found != reports.end() && found->limit_ms > 0.0;
    number_cell(fixed(ms, 2));
    number_cell(limited ? fixed(found->limit_ms, 2) : "");
    number_cell(limited ? fixed(100.0 * found->limit_ms / ms, 0) + " %" : "");
    if (limited && ImGui::IsItemHovered()) ImGui::SetTooltip("bound by %s", found->bound.c_str());
}

void stage_table(const PanelFacts& facts, const std::vector<StageReport>& reports) {
    if (!ImGui::BeginTable("stages", 4, ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableSetupColumn("stage", 0, 2.4f);
    ImGui::TableSetupColumn("ms", 0, 1.0f);
    ImGui::TableSetupColumn("limit", 0, 1.0f);
    ImGui::TableSetupColumn("ratio", 0, 0.9f);
    ImGui::TableNextRow();
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    cell("stage");
    for (const char* text : {"ms", "limit", "of limit"}) number_cell(text);
    ImGui::PopStyleColor();
    for (std::size_t i = 0; i < facts.history.stages().size(); ++i) {
        stage_row(facts.history, i, reports);
    }
    ImGui::TableNextRow();
    cell("whole picture");
    number_cell(fixed(facts.history.median_frame_ms(), 2));
    ImGui::EndTable();
}

struct ErrorLine {
    const char* name;
    double (*value)(const ReferenceError& error);
};

constexpr ErrorLine kErrorLines[] = {
    {"max relative", [](const ReferenceError& e) { return e.hdr.relative.max; }},
    {"99.9 % below", [](const ReferenceError& e) { return e.hdr.relative.percentile_99_9; }},
    {"mean relative", [](const ReferenceError& e) { return e.hdr.relative.mean; }},
    {"RMSE", [](const ReferenceError& e) { return e.hdr.rmse; }},
    {"FLIP, mean", [](const ReferenceError& e) { return e.flip_mean; }},
    {"FLIP, max", [](const ReferenceError& e) { return e.flip_max; }}};

void error_table(const FrameError& error) {
    if (!ImGui::BeginTable("error", 3)) return;
    ImGui::TableNextRow();
    for (const char* text : {"against float64", "kernels", "with G-buffer"}) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", text);
    }
    const auto text = [](double value) {
        return value == 0.0 ? "0" : fmt::format("{:.2e}", value);
    };
    for (const ErrorLine& line : kErrorLines) {
        ImGui::TableNextRow();
        cell(line.name);
        cell(error.kernels ? text(line.value(*error.kernels)) : "-");
        cell(text(line.value(error.whole)));
    }
    ImGui::EndTable();
    ImGui::TextDisabled("%d x %d pixels, %.1f lights reach one", error.width, error.height,
                        error.lights_per_pixel);
}

std::string lights_text(const FrameStats& s) {
    std::string out = short_count(s.lights_used) + " used";
    if (s.lights_rejected > 0) out += fmt::format(", {} rejected", s.lights_rejected);
    return out;
}

void count_lines(const FrameStats& s) {
    fact_line("Lights", lights_text(s));
    if (lists_lights(s) && s.evaluations_per_pixel >= 0.0) {
        std::string text = "k " + fixed(s.evaluations_per_pixel, 1) + " evaluated";
        if (s.useful_evaluations_per_pixel >= 0.0) {
            text += ", k* " + fixed(s.useful_evaluations_per_pixel, 1) + " useful";
        }
        fact_line("A pixel", text);
    }
    if (s.layers > 0) {
        fact_line("Layers",
                  fmt::format("{} over a pixel, {} pixels", s.layers, short_count(s.layer_pixels)));
    }
    if (s.grid[2] == 0) return;
    fact_line("Grid", fmt::format("{}", fmt::join(s.grid, " x ")));
    if (s.coarse_pairs > 0) fact_line("Coarse pairs", short_count(s.coarse_pairs));
    if (s.active_clusters == 0) return;
    fact_line("Active", short_count(s.active_clusters) + " clusters, " +
                            short_count(s.refined_pairs) + " pairs");
}

void wrapped(const char* name, const std::string& text) {
    ImGui::TextDisabled("%s", name);
    ImGui::TextWrapped("%s", text.c_str());
}

}  // namespace

void fact_line(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(ImGui::GetFontSize() * 6.6f);
    ImGui::TextWrapped("%s", value.c_str());
}

std::string short_count(std::uint64_t value) {
    const auto number = static_cast<double>(value);
    if (value < 10'000) return fmt::to_string(value);
    return value < 1'000'000 ? fixed(1e-3 * number, 1) + " k" : fixed(1e-6 * number, 2) + " M";
}

std::string byte_text(std::uint64_t bytes) {
    constexpr double kMiB = 1024.0 * 1024.0;
    return fixed(static_cast<double>(bytes) / kMiB, 1) + " MiB";
}

void PanelStats::speed() const {
    if (!ui.section("Speed", true)) return;
    std::vector<StageReport> reports;
    if (facts.limits) {
        reports = stage_reports(facts.stats, *facts.limits,
                                frame_setup(facts.displayed, facts.plan, facts.device));
    }
    draw_stage_history(facts.history, 6.0f * ImGui::GetFontSize());
    stage_table(facts, reports);
    if (facts.limits) {
        const Efficiency efficiency = efficiency_of(reports, facts.stats);
        std::string text = fixed(100.0 * efficiency.hardware, 0) + " % of the device's limits";
        if (efficiency.algorithm >= 0.0) {
            text += ", " + fixed(100.0 * efficiency.algorithm, 0) + " % useful";
        }
        fact_line("Kernels", text);
    }
    count_lines(facts.stats);
    ui.checkbox("Count k*", state.settings.want.counts);
    ui.tip("Counts the evaluated lights whose range covers the pixel: one more pass");
    fact_line("Memory", byte_text(facts.device_bytes) + " OpenCL, " +
                            byte_text(facts.process_bytes) + " process");
}

void PanelStats::error() const {
    if (!ui.section("Error", false)) return;
    if (facts.error.is_open()) {
        ImGui::ProgressBar(facts.error.share(), {-FLT_MIN, 0.0f}, "float64 reference");
    } else {
        actions.measure_error |= ui.button("Measure error", true);
        ui.tip("Compares this picture, at a reduced size, with float64 and every light");
    }
    if (!facts.error.error()) return;
    error_table(*facts.error.error());
    ui.checkbox("Error map", state.error_map);
    ui.tip("Shows each pixel's relative error, until camera, lights or settings change");
}

void PanelStats::device() const {
    if (!ui.section("Device and scene", false)) return;
    const DeviceInfo& d = facts.device;
    wrapped("OpenCL", fmt::format("{}, {}, {} units, {} lanes", d.name, d.version, d.compute_units,
                                  d.lane_width));
    wrapped("OpenGL", facts.opengl);
    wrapped("Scene", fmt::format("{}, {} triangles, {} instances, {} materials", facts.scene.name,
                                 short_count(facts.triangles), facts.scene.instances.size(),
                                 facts.scene.materials.size()));
    for (const auto& [name, features] : {std::pair("Compiled in", facts.plan.features),
                                         std::pair("Left out", facts.plan.left_out)}) {
        wrapped(name, features.empty() ? "nothing" : joined(features));
    }
    wrapped("G-buffer", fmt::format("{} bytes per pixel", facts.plan.gbuffer_bytes_per_pixel));
}

}  // namespace kilolux
