// SPDX-License-Identifier: Apache-2.0
#include <imgui.h>

#include <cstdio>

#include "present/window/panel/panel.h"

namespace kilolux {
namespace {

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
    const auto cell = [](double value) {
        ImGui::TableNextColumn();
        if (value == 0.0) {
            ImGui::TextUnformatted("0");
        } else {
            ImGui::Text("%.2e", value);
        }
    };
    for (const ErrorLine& line : kErrorLines) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line.name);
        if (error.kernels) {
            cell(line.value(*error.kernels));
        } else {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted("-");
        }
        cell(line.value(error.whole));
    }
    ImGui::EndTable();
    ImGui::TextDisabled("%d x %d pixels, %.1f lights reach one", error.width, error.height,
                        error.lights_per_pixel);
}

}  // namespace

void Panel::error() const {
    if (!ui.section("Error", false)) return;
    if (facts.measuring) {
        ImGui::ProgressBar(facts.error_share, {-FLT_MIN, 0.0f}, "float64 reference");
    } else {
        actions.measure_error |= ui.button("Measure error", true);
        ui.tip("Compares this picture, at a reduced size, with float64 and every light");
    }
    if (!facts.error) return;
    error_table(*facts.error);
    ui.checkbox("Error map", state.error_map);
    ui.tip("Shows each pixel's relative error, until camera, lights or settings change");
}

}  // namespace kilolux
