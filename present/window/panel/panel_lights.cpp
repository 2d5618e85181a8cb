// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/panel_lights.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "host/scene/lights/light_aim.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_ranges.h"
#include "host/scene/lights/light_shape.h"
#include "present/window/panel/panel_stats.h"

namespace kilolux {
namespace {

constexpr double kLeast = 1e-6, kMost = 1e6;  // [m, cd, lx] of numbers that are positive
constexpr double kFarthest = 1e9;             // [m] of positions
constexpr double kStepShare = 0.005;          // of a value that a pixel of a drag adds

double step_of(double value, double least = 1e-3) {
    return kStepShare * std::max(std::abs(value), least);
}

// "inner_cone" as "Inner cone".
std::string label_of(const LightNumber& number) {
    std::string out = number.name;
    std::ranges::replace(out, '_', ' ');
    out[0] = static_cast<char>(out[0] - 'a' + 'A');
    return out;
}

float brightest(const glm::vec3& color) { return std::max({color.x, color.y, color.z}); }

std::string kinds_text(const OwnLights& lights) {
    std::string out;
    for (const LightKind& kind : kLightKinds) {
        const std::size_t count = lights.count(kind.type);
        if (count == 0) continue;
        out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, kind.name);
    }
    return out;
}

// A number of the light's kind. The range may be that of the tails: 0.
bool change_number(Widgets& ui, const LightNumber& number, SceneLight& light) {
    const double unit = number.is_angle ? glm::pi<double>() / 180.0 : 1.0;
    float& member = light.*number.member;
    const bool may_lack = number.member == &SceneLight::range;
    bool lacks = may_lack && member == 0.0f;
    const double start = lacks_range(light) ? range_of_light(brightest(light.intensity)) : 1.0;
    double shown = lacks ? start : double{member} / unit;
    DragRange range{number.is_positive ? kLeast : -kMost, kMost,
                    step_of(shown, number.is_positive ? 1e-3 : 0.1), lacks ? "none" : "%.4g m"};
    if (number.is_angle) range = {0.0, 90.0, 0.25, "%.4g deg"};
    const std::string label = label_of(number);
    bool changed = ui.drag(label.c_str(), shown, range, may_lack ? "none" : "");
    if (changed) member = static_cast<float>(shown * unit);
    if (!may_lack) return changed;
    ImGui::SameLine();
    if (ui.checkbox("none", lacks, label.c_str())) {
        member = lacks ? 0.0f : static_cast<float>(start);
        changed = true;
    }
    ui.tip("The light reaches as far as Tails says");
    return changed;
}

}  // namespace

void PanelLights::own_lights(const CameraRig& rig) const {
    if (facts.own_lights.lights().empty() || !ui.section("Scene lights", false)) return;
    ui.begin_group("light");
    fact_line("Kinds", kinds_text(facts.own_lights));
    select(rig);
    if (state.light >= 0) change(static_cast<std::size_t>(state.light));
    reset();
    ui.end_group();
}

void PanelLights::select(const CameraRig& rig) const {
    const std::vector<SceneLight>& lights = facts.own_lights.lights();
    const int last = static_cast<int>(lights.size()) - 1;
    const int before = state.light;
    state.light = std::min(state.light, last);
    ui.slider("Number", state.light,
              {-1.0, static_cast<double>(last), false, state.light < 0 ? "none" : "%.0f"});
    ui.tip("Ctrl+click to type a number");
    if (ui.button("Nearest")) state.light = light_in_view(lights, rig.camera());
    ui.tip("The light nearest to the middle of the picture");
    ImGui::SameLine();
    if (ui.button("Previous")) state.light = state.light <= 0 ? last : state.light - 1;
    ImGui::SameLine();
    if (ui.button("Next")) state.light = state.light == last ? 0 : state.light + 1;
    ImGui::SameLine();
    if (ui.button("None")) state.light = -1;
    if (state.light != before) state.light_color = glm::vec3(1.0f);
}

void PanelLights::change(std::size_t number) const {
    SceneLight light = facts.own_lights.lights()[number];
    const bool is_changed = facts.own_lights.is_changed(number);
    fact_line("Kind", fmt::format("{}{}", kind_of(light).name, is_changed ? ", changed" : ""));
    bool changed = change_color(light);
    changed |= change_numbers(light);
    changed |= change_position(light);
    changed |= change_aim(light);
    if (changed) actions.change_light = {number, light};
}

bool PanelLights::change_color(SceneLight& light) const {
    const float strength = brightest(light.intensity);
    if (strength > 0.0f) state.light_color = light.intensity / strength;
    glm::vec3 color = state.light_color;
    float next = strength;
    const bool colored = ui.color("Colour", color) && brightest(color) > 0.0f;
    if (colored) state.light_color = color / brightest(color);
    const bool is_placed = kind_of(light).is_placed;
    const bool dimmed =
        ui.drag("Intensity", next,
                {0.0, kMost, step_of(double{strength}), is_placed ? "%.4g cd" : "%.4g lx"});
    ui.tip(is_placed ? "Straight ahead, the brightest channel" : "The brightest channel");
    if (colored || dimmed) light.intensity = next * state.light_color;
    if (is_area_light(light)) {
        const double luminance = double{brightest(light.intensity)} / seen_area(light);
        fact_line("Luminance", fmt::format("{:.4g} nit", luminance));
    }
    return colored || dimmed;
}

bool PanelLights::change_numbers(SceneLight& light) const {
    bool changed = false;
    for (const LightNumber& number : kLightNumbers) {
        if (kind_of(light).*number.has) changed |= change_number(ui, number, light);
    }
    if (kind_of(light).is_flat) changed |= ui.checkbox("Two-sided", light.two_sided);
    return changed;
}

bool PanelLights::change_position(SceneLight& light) const {
    if (!kind_of(light).is_placed) return false;
    const double step = 1e-3 * std::max(glm::length(resting_bounds(facts.scene).size()), 1e-3);
    bool changed = false;
    for (int axis = 0; const char* name : {"X", "Y", "Z"}) {
        changed |= ui.drag(name, light.position[axis++], {-kFarthest, kFarthest, step, "%.6g m"});
    }
    return changed;
}

bool PanelLights::change_aim(SceneLight& light) const {
    if (!is_aimed_light(light)) return false;
    constexpr DragRange kAround{-540.0, 540.0, 0.5, "%.4g deg"};  // past half a turn it goes on
    LightAim& aim = state.light_aim;
    SceneLight aimed = light;
    set_aim(aimed, aim);
    if (aimed != light) aim = aim_of(light);
    bool changed = ui.drag("Azimuth", aim.azimuth, kAround);
    ui.tip("The way that it shines, seen from above: 0 is -Z, 90 is +X");
    changed |= ui.drag("Elevation", aim.elevation, {-90.0, 90.0, 0.25, "%.4g deg"});
    ui.tip("The way that it shines: 90 is straight up, -90 straight down");
    if (has_roll(light)) {
        changed |= ui.drag("Roll", aim.roll, kAround);
        ui.tip("How it is turned about the way that it shines");
    }
    if (!changed) return false;
    for (double* angle : {&aim.azimuth, &aim.roll}) *angle = std::remainder(*angle, 360.0);
    set_aim(light, aim);
    return true;
}

void PanelLights::reset() const {
    const OwnLights& own = facts.own_lights;
    const auto number = static_cast<std::size_t>(std::max(state.light, 0));
    const bool is_changed = state.light >= 0 && own.is_changed(number);
    if (ui.button("Reset", false, is_changed)) actions.reset_light = number;
    ui.tip("This light as in the file");
    ImGui::SameLine();
    actions.reset_lights |= ui.button("Reset all", false, own.changed_count() > 0);
    ImGui::SameLine();
    ImGui::TextDisabled("%zu changed", own.changed_count());
}

}  // namespace kilolux
