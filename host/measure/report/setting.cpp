// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/setting.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "host/base/gbuffer_layout.h"
#include "host/measure/bench/sweep.h"
#include "host/render/kernel_choice.h"
#include "host/render/scene_plan.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr const char* kAxisNames[] = {"default", "gbuffer",  "lanes",   "math",
                                      "grid",    "renderer", "shading", "cut-off"};

// Collects settings that differ from a base.
class Variants {
 public:
    Variants(const RenderSettings& base, bool quick) : base_(base), quick_(quick) {
        out_.push_back({SettingAxis::none, "default", "", base});
    }

    // Adds what `change` makes of the base; `name` is also the option without its dashes.
    template <typename Change>
    void add(SettingAxis axis, const std::string& name, Change&& change) {
        add(axis, name, "--" + name, change);
    }
    template <typename Change>
    void add(SettingAxis axis, const std::string& name, const std::string& options,
             Change&& change) {
        out_.push_back({axis, name, options, base_});
        change(out_.back().settings);
    }
    const RenderSettings& base() const { return base_; }
    bool quick() const { return quick_; }
    std::vector<ReportSetting> take() { return std::move(out_); }

 private:
    RenderSettings base_;
    bool quick_;
    std::vector<ReportSetting> out_;
};

void add_gbuffers(Variants& v) {
    for (const uint layout : std::initializer_list<uint>{GBUFFER_PACKED, GBUFFER_FULL, GBUFFER_HALF,
                                                         GBUFFER_NORMAL_XY, GBUFFER_OCT_2X4}) {
        if (layout == v.base().gbuffer) continue;
        v.add(SettingAxis::gbuffer, std::string("gbuffer ") + gbuffer_layout_name(layout),
              [&](RenderSettings& s) { s.gbuffer = layout; });
    }
}

void add_lanes(Variants& v, const DeviceInfo& device) {
    const int chosen = choose_tuning(device, v.base().kernels).lanes;
    for (const int lanes : {1, 2, 4, 8, 16}) {
        if (lanes == chosen || (v.quick() && lanes != 1 && lanes != 16)) continue;
        v.add(SettingAxis::lanes, fmt::format("lanes {}", lanes),
              [&](RenderSettings& s) { s.kernels.lanes = lanes; });
    }
}

void add_math(Variants& v) {
    constexpr std::pair<MathMode, const char*> kModes[] = {
        {MathMode::exact, "math exact"},
        {MathMode::fast_relaxed, "math fast-relaxed"},
        {MathMode::native, "math native"}};
    for (const auto& [math, name] : kModes) {
        if (math == v.base().kernels.math) continue;
        v.add(SettingAxis::math, name, [mode = math](RenderSettings& s) { s.kernels.math = mode; });
    }
    const bool half = v.base().kernels.light_colors == LightColors::half;
    v.add(SettingAxis::math, half ? "light-colors float" : "light-colors half",
          [&](RenderSettings& s) {
              s.kernels.light_colors = half ? LightColors::single : LightColors::half;
          });
}

void add_grids(Variants& v) {
    constexpr std::array<std::array<int, 3>, 6> kGrids = {
        {{4, 4, 1}, {30, 17, 16}, {8, 5, 2}, {16, 9, 1}, {16, 9, 16}, {60, 34, 4}}};
    const GridSettings& g = v.base().grid;
    const std::size_t count = v.quick() ? 2 : kGrids.size();
    for (std::size_t i = 0; i < count; ++i) {
        const auto& [x, y, slices] = kGrids[i];
        if (x == g.tiles_x && y == g.tiles_y && slices == g.slices_per_octave) continue;
        v.add(SettingAxis::grid, fmt::format("grid {},{},{}", x, y, slices),
              [&grid = kGrids[i]](RenderSettings& s) {
                  s.grid.tiles_x = grid[0];
                  s.grid.tiles_y = grid[1];
                  s.grid.slices_per_octave = grid[2];
              });
    }
}

void add_renderers(Variants& v) {
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::deferred_all,
                                        RendererKind::forward_plus, RendererKind::forward}) {
        const bool too_slow = v.quick() && renderer == RendererKind::forward;
        if (renderer == v.base().renderer || too_slow) continue;
        v.add(SettingAxis::renderer, "renderer " + renderer_name(renderer),
              [&](RenderSettings& s) { s.renderer = renderer; });
    }
}

void add_shadings(Variants& v, const Scene& scene) {
    struct Model {
        int value;
        Shading shading;
        const char* name;
    };
    constexpr Model kModels[] = {{SHADING_LAMBERT, Shading::lambert, "lambert"},
                                 {SHADING_BLINN_PHONG, Shading::blinn_phong, "blinn-phong"},
                                 {SHADING_PBR, Shading::pbr, "pbr"}};
    const int chosen = make_scene_plan(scene, v.base(), 0).kernels.shading;
    for (const Model& model : kModels) {
        if (model.value == chosen) continue;
        v.add(SettingAxis::shading, std::string("shading ") + model.name,
              [&](RenderSettings& s) { s.shading = model.shading; });
    }
}

bool lacks_ranges(const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(), [](const SceneLight& light) {
        return light.type != LightType::directional && !(light.range > 0.0f);
    });
}

void add_cut_offs(Variants& v, const Scene& scene) {
    const bool generated = v.base().lights.count > 0;
    if (!generated && !lacks_ranges(scene)) return;
    const double intensity = automatic_light_scale(v.base().lights, scene).intensity;
    for (const int divisor : {4, 16, 64, 256, 1024}) {
        if (v.quick() && divisor != 16 && divisor != 256) continue;
        const double budget = 1.0 / divisor;
        if (!generated && budget == v.base().range_budget) continue;
        const double radius = range_of_light(intensity, budget);
        std::string options = fmt::format("--range-budget {}", budget);
        if (generated) {
            options += fmt::format(" --light-radius {} --light-intensity {}", radius, intensity);
        }
        v.add(SettingAxis::cut_off, fmt::format("cut-off 1/{}", divisor), options,
              [&](RenderSettings& s) {
                  s.range_budget = budget;
                  if (!generated) return;
                  s.lights.radius = radius;
                  s.lights.intensity = intensity;
              });
    }
}

}  // namespace

const char* axis_name(SettingAxis axis) { return kAxisNames[static_cast<std::size_t>(axis)]; }

std::vector<std::string> setting_axis_names() {
    return {std::begin(kAxisNames) + 1, std::end(kAxisNames)};
}

std::vector<ReportSetting> report_settings(const Scene& scene, const RenderSettings& base,
                                           const DeviceInfo& device, bool quick) {
    Variants variants(base, quick);
    if (!is_forward(base.renderer)) {
        add_gbuffers(variants);
        add_lanes(variants, device);
        add_math(variants);
    }
    if (base.renderer != RendererKind::forward) add_grids(variants);
    add_renderers(variants);
    add_shadings(variants, scene);
    add_cut_offs(variants, scene);
    return variants.take();
}

double cut_off_of(const Scene& scene, const RenderSettings& settings) {
    if (settings.lights.count == 0) return 0.0;
    const LightScale scale = automatic_light_scale(settings.lights, scene);
    return scale.intensity / (std::numbers::pi * scale.radius * scale.radius);
}

}  // namespace kilolux
