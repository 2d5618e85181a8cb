// SPDX-License-Identifier: Apache-2.0
#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "present/cli/names.h"
#include "present/window/panel/panel.h"

namespace kilolux {
namespace {

void bench_table_of(const std::vector<BenchRow>& rows) {
    if (!ImGui::BeginTable("bench", 4, ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableNextRow();
    for (const char* text : {"renderer", "lights", "ms", "max rel. error"}) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", text);
    }
    for (const BenchRow& row : rows) {
        if (row.stage != kFrameStage) continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name_of(row.point.renderer).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(short_count(static_cast<double>(row.point.lights)).c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.1f", row.ms.median);
        ImGui::TableNextColumn();
        ImGui::Text("%.2g", row.error.max_relative);
    }
    ImGui::EndTable();
}

std::string scientific(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value == 0.0 ? "0" : "%.2e", value);
    return text;
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
    if (!ImGui::BeginTable("error", 3, ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableNextRow();
    for (const char* text : {"against float64", "kernels", "with G-buffer"}) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", text);
    }
    for (const ErrorLine& line : kErrorLines) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line.name);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(error.kernels ? scientific(line.value(*error.kernels)).c_str()
                                             : "-");
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(scientific(line.value(error.whole)).c_str());
    }
    ImGui::EndTable();
    ImGui::TextDisabled("%d x %d pixels, %.1f lights reach one", error.width, error.height,
                        error.lights_per_pixel);
}

}  // namespace

void Panel::error(const std::shared_ptr<ErrorProgress>& progress) const {
    if (!ui.section("Error", false)) return;
    if (progress && progress->running) {
        ImGui::ProgressBar(progress->share, {-FLT_MIN, 0.0f}, "float64 reference");
    } else {
        wishes.measure_error |= ui.button("Measure error", true);
        ui.tip("Compares this picture, at a reduced size, with float64 and every light");
    }
    if (!progress) return;
    const std::lock_guard lock(progress->mutex);
    if (progress->result) error_table(*progress->result);
}

void Panel::bench(const std::shared_ptr<BenchProgress>& progress) const {
    if (!ui.section("Benchmark", false)) return;
    const bool running = progress && progress->running;
    ui.slider("Most lights", state.bench_lights, {256, 1048576, true, "%.0f"});
    if (running) {
        wishes.stop_bench |= ui.button("Stop");
        const auto total = static_cast<float>(std::max<std::size_t>(progress->frames_total, 1));
        ImGui::SameLine();
        ImGui::ProgressBar(static_cast<float>(progress->frames_done) / total, {-FLT_MIN, 0.0f});
    } else {
        wishes.start_bench |= ui.button("Run benchmark");
        ui.tip("Deferred and forward-plus over numbers of lights, from this camera; a CSV is kept");
    }
    if (!progress) return;
    const std::lock_guard lock(progress->mutex);
    draw_bench_plot(progress->rows, 9.0f * ImGui::GetFontSize());
    bench_table_of(progress->rows);
    if (!progress->failure.empty()) ImGui::TextWrapped("%s", progress->failure.c_str());
}

}  // namespace kilolux
