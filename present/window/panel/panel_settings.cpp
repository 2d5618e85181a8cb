// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/panel_settings.h"

#include <fmt/format.h>
#include <imgui.h>
#include <cmath>

#include "host/picture/views.h"
#include "host/render/plan/settings_check.h"
#include "host/scene/lights/light_generator.h"
#include "present/cli/names.h"
#include "present/window/overlay/light_outlines.h"
#include "present/window/panel/panel_stats.h"

namespace kilolux {
namespace {

// A slider and a box for a value that is automatic at 0.
void automatic_slider(Widgets& ui, const char* label, double& value, double automatic,
                      const SliderRange& range) {
    bool is_automatic = value <= 0.0;
    double shown = is_automatic ? automatic : value;
    if (ui.slider(label, shown, range, "auto")) {
        value = shown;
        is_automatic = false;
    }
    ImGui::SameLine();
    if (ui.checkbox("auto", is_automatic, label)) value = is_automatic ? 0.0 : automatic;
}

// Why each choice is refused beside lights with a size, if there are some.
template <typename Choice, typename Problem>
std::vector<std::string> refusals(bool has_area_lights, const Problem& problem) {
    std::vector<std::string> out(names_of<Choice>().size());
    for (std::size_t i = 0; has_area_lights && i < out.size(); ++i) {
        out[i] = problem(static_cast<Choice>(i));
    }
    return out;
}

}  // namespace

void PanelSettings::picture() const {
    if (!ui.section("Picture", true)) return;
    RenderSettings& s = state.settings;
    ui.choice("Renderer", s.renderer, names_of<RendererKind>());
    const bool has_area = has_sizes();
    ui.choice("Shading", s.shading, names_of<Shading>(),
              refusals<Shading>(has_area, [](auto shading) {
                  return area_lights_problem(model_of(shading), Shadows::off);
              }));
    ui.choice("Shadows", s.shadows, names_of<Shadows>(),
              refusals<Shadows>(has_area, [](auto shadows) {
                  return area_lights_problem(SHADING_PBR, shadows);
              }));
    ui.choice("G-buffer", s.gbuffer, gbuffer_choices().names);
    ui.choice("Show", s.want.view, view_names());
    ui.slider("Exposure", s.exposure, {-8.0, 8.0, false, "%+.1f EV"});
    ui.choice("Tone map", s.tone_curve, names_of<ToneCurve>());
    ui.slider("Bloom", s.bloom, {0.0, 1.0, false, "%.2f"});
    ui.slider("Ambient", s.ambient, {0.0, 1.0, false, "%.3f"});
    ui.slider("Samples", s.samples, {1, 16, false, "%.0f"});
    ui.tip("Jittered samples per pixel, one after the other while nothing changes");
}

void PanelSettings::lights() const {
    if (!ui.section("Lights", true)) return;
    LightOptions& lights = state.settings.lights;
    const LightScale scale = automatic_light_scale(lights, facts.scene);
    ui.choice("Rig", state.rig, names_of<Rig>());
    ui.tip("What lights the scene beside its own lights; it sets Lights and Ambient");
    emissive_lights();
    ui.slider("Lights", lights.count, {1.0, 1e6, true, "%.0f"});
    ui.tip("Generated point lights; Ctrl+click to type a number");
    automatic_slider(ui, "Radius", lights.radius, scale.radius, {0.05, 100.0, true, "%.2f m"});
    automatic_slider(ui, "Intensity", lights.intensity, scale.intensity,
                     {1e-4, 1e4, true, "%.3g cd"});
    size();
    if (facts.own_lights.has_unranged()) {
        ui.choice("Tails", state.settings.tails, names_of<Tails>());
        ui.tip("Where the file's lights without a range end");
        if (state.settings.tails == Tails::tree) {
            ui.slider("Tree share", state.settings.tree_share, {0.001, 1.0, true, "%.3f"});
        }
    }
    ui.checkbox("Lights move", state.lights_move);
    ui.slider("Speed", state.light_speed, {0.05, 20.0, true, "%.2fx"});
    ui.slider("Seed", lights.seed, {1, 100, false, "%.0f"});
}

// Whether the settings ask for lights with a size.
bool PanelSettings::has_sizes() const {
    return has_area_lights(facts.own_lights.lights(), state.settings.lights) ||
           (facts.can_glow && state.emissive_lights == EmissiveLights::on);
}

void PanelSettings::emissive_lights() const {
    if (!facts.can_glow) return;
    const RenderSettings& s = state.settings;
    std::vector<std::string> problems(names_of<EmissiveLights>().size());
    problems[static_cast<std::size_t>(EmissiveLights::on)] =
        area_lights_problem(model_of(s.shading), s.shadows);
    ui.choice("Emissive", state.emissive_lights, names_of<EmissiveLights>(), problems);
    ui.tip("Whether emissive surfaces light the others; auto: where nothing else lights");
}

void PanelSettings::size() const {
    RenderSettings& s = state.settings;
    ui.begin_refusal(has_sizes() ? "" : area_lights_problem(model_of(s.shading), s.shadows));
    ui.slider("Size", s.lights.size, {0.0, 10.0, true, s.lights.size > 0.0 ? "%.3f m" : "points"});
    ui.tip("Radius of the generated lights, and of the file's points that give none: spheres");
    ui.end_refusal();
    ui.checkbox("Outlines", state.outlines);
    ui.tip(fmt::format("Of the {} nearest lights with a size: the scene's own, and generated ones "
                       "up to {}",
                       kMostOutlines, kMostSearched)
               .c_str());
}

void PanelSettings::clusters() const {
    if (!ui.section("Clusters", false)) return;
    GridSettings& grid = state.settings.grid;
    ui.slider("Tiles across", grid.tiles_x, {1, 64, true, "%.0f"});
    ui.slider("Tiles down", grid.tiles_y, {1, 64, true, "%.0f"});
    ui.slider("Slices", grid.slices_per_octave, {1, 64, true, "%.0f"});
    ui.tip("Depth slices for each doubling of the distance");
    ui.slider("Fine slices", grid.fine_per_octave, {1, 64, true, "%.0f"});
    ui.tip("Of the active clusters; rounded down to the slices times a power of two");
    const std::vector<std::string> lanes = {"auto", "1", "2", "4", "8", "16"};
    int lane = state.settings.kernels.lanes;
    lane = lane == 0 ? 0 : 1 + static_cast<int>(std::lround(std::log2(lane)));
    if (ui.choice("Lanes", lane, lanes)) {
        state.settings.kernels.lanes = lane == 0 ? 0 : 1 << (lane - 1);
    }
    ui.tip("Pixels or lights per work-item; changes no bit on CPUs");
    ui.checkbox("Point at a pixel", state.probe);
    ui.tip("Shows its tile, slice and box, and what each light of its list adds");
    ui.checkbox("Freeze", state.frozen);
    ui.tip("Draws the active clusters of this picture as boxes");
    if (!state.frozen) return;
    ui.slider("Least lights", state.box_lights, {0, 200, false, "%.0f"});
    fact_line("Boxes", short_count(facts.boxes));
}

void PanelSettings::camera(const CameraRig& rig) const {
    if (!ui.section("Camera", false)) return;
    ui.choice("Mode", state.camera_mode, {"fly", "orbit"});
    if (!facts.scene.cameras.empty()) {
        std::vector<std::string> names = {"-"};
        for (std::size_t i = 0; i < facts.scene.cameras.size(); ++i) {
            const std::string& name = facts.scene.cameras[i].name;
            names.push_back(fmt::format("{}{}{}", i, name.empty() ? "" : " ", name));
        }
        int chosen = 0;
        if (ui.choice("Go to", chosen, names) && chosen > 0) actions.scene_camera = chosen - 1;
    }
    const glm::dvec3& p = rig.camera().position;
    fact_line("Position", fmt::format("{:.2f}, {:.2f}, {:.2f} m", p.x, p.y, p.z));
    fact_line("Fly speed", fmt::format("{:.3g} m/s", rig.speed()));
    actions.reset_camera |= ui.button("Reset");
    ImGui::SameLine();
    actions.frame_scene |= ui.button("Frame");
    ImGui::SameLine();
    actions.copy_camera |= ui.button("Copy camera");
    actions.copy_command |= ui.button("Copy the command that renders this", true);
}

void PanelSettings::window() const {
    if (!ui.section("Window", false)) return;
    ui.checkbox("Adaptive scale", state.adaptive);
    ui.tip("Renders fewer pixels while something moves, all of them at rest");
    if (state.adaptive) {
        ui.slider("Target", state.target_ms, {10.0, 1000.0, true, "%.0f ms"});
    } else {
        ui.slider("Scale", state.fixed_scale, {0.1, 1.0, false, "%.2f"});
    }
    ui.checkbox("Render always", state.continuous);
    ui.tip("Renders also when nothing changes, for steady times");
    ui.checkbox("Vsync", state.vsync);
    ui.checkbox("Overlay", state.show_overlay);
    actions.save_png |= ui.button("Save PNG");
    ImGui::SameLine();
    actions.save_exr |= ui.button("Save EXR");
    ImGui::SameLine();
    actions.full_screen |= ui.button("Full screen");
    actions.help |= ui.button("Help");
    ImGui::SameLine();
    actions.reset_settings |= ui.button("All settings to their defaults");
}

}  // namespace kilolux
