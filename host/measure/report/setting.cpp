// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "host/base/formats/gbuffer_layout.h"
#include "host/measure/bench/sweep.h"
#include "host/measure/reference/reference.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/plan/settings_check.h"
#include "host/scene/lights/light_tree.h"

namespace kilolux {
namespace {

constexpr const char* kAxisNames[] = {"default", "gbuffer",  "geometry", "lanes",   "math",
                                      "grid",    "renderer", "shading",  "shadows", "cut-off"};

// Collects settings that differ from a base.
struct Variants {
    const RenderSettings& base;
    SettingChoice choice;
    std::vector<ReportSetting> settings;

    // Adds the base as `change` alters it.
    template <typename Change>
    void add(SettingAxis axis, const std::string& name, const std::string& options,
             const Change& change) {
        settings.push_back({axis, name, options, base});
        change(settings.back().settings);
    }

    // Adds the base with another value of the axis' option.
    template <typename Change>
    void add_option(SettingAxis axis, std::string_view value, const Change& change) {
        const std::string name = fmt::format("{} {}", axis_name(axis), value);
        add(axis, name, "--" + name, change);
    }
};

bool has_shadows(const RenderSettings& settings) { return settings.shadows != Shadows::off; }

void add_gbuffers(Variants& v) {
    for (const uint layout : {uint{GBUFFER_PACKED}, uint{GBUFFER_FULL}, uint{GBUFFER_HALF},
                              uint{GBUFFER_NORMAL_XY}, uint{GBUFFER_OCT_2X4}}) {
        if (layout == v.base.gbuffer) continue;
        v.add_option(SettingAxis::gbuffer, gbuffer_layout_name(layout),
                     [&](RenderSettings& s) { s.gbuffer = layout; });
    }
}

void add_geometry(Variants& v, const DeviceInfo& device) {
    constexpr std::pair<Geometry, const char*> kWays[] = {
        {Geometry::ids, "ids"}, {Geometry::compute, "compute"}, {Geometry::planes, "planes"}};
    const bool is_automatic = v.base.geometry == Geometry::automatic;
    const bool computes = choose_tuning(device, v.base.kernels).tuning.geometry == 1;
    const Geometry chosen = computes ? Geometry::compute : Geometry::ids;
    const Geometry base = is_automatic ? chosen : v.base.geometry;
    for (const auto& [geometry, name] : kWays) {
        const bool lacks_shadows = has_shadows(v.base) && !resolves_ids(geometry);
        if (geometry == base || lacks_shadows) continue;
        v.add_option(SettingAxis::geometry, name,
                     [way = geometry](RenderSettings& s) { s.geometry = way; });
    }
}

void add_lanes(Variants& v, const DeviceInfo& device) {
    const int chosen = choose_tuning(device, v.base.kernels).lanes;
    for (const int lanes : {1, 2, 4, 8, 16}) {
        if (lanes == chosen || (v.choice.quick && lanes != 1 && lanes != 16)) continue;
        v.add_option(SettingAxis::lanes, fmt::to_string(lanes),
                     [&](RenderSettings& s) { s.kernels.lanes = lanes; });
    }
}

void add_math(Variants& v) {
    constexpr std::pair<MathMode, const char*> kModes[] = {{MathMode::exact, "exact"},
                                                           {MathMode::fast_relaxed, "fast-relaxed"},
                                                           {MathMode::native, "native"}};
    for (const auto& [math, name] : kModes) {
        if (math == v.base.kernels.math) continue;
        v.add_option(SettingAxis::math, name,
                     [mode = math](RenderSettings& s) { s.kernels.math = mode; });
    }
    const bool half = v.base.kernels.light_colors == LightColors::half;
    const std::string name = half ? "light-colors float" : "light-colors half";
    v.add(SettingAxis::math, name, "--" + name, [&](RenderSettings& s) {
        s.kernels.light_colors = half ? LightColors::single : LightColors::half;
    });
}

void add_grids(Variants& v) {
    constexpr int kGrids[][3] = {{4, 4, 1},  {30, 17, 16}, {8, 5, 2},
                                 {16, 9, 1}, {16, 9, 16},  {60, 34, 4}};
    const GridSettings& base = v.base.grid;
    for (const auto& [x, y, slices] :
         std::span(kGrids).first(v.choice.quick ? 2 : std::size(kGrids))) {
        GridSettings grid = base;
        grid.tiles_x = x;
        grid.tiles_y = y;
        grid.slices_per_octave = slices;
        if (grid == base) continue;
        v.add_option(SettingAxis::grid, fmt::format("{},{},{}", x, y, slices),
                     [&](RenderSettings& s) { s.grid = grid; });
    }
}

void add_renderers(Variants& v) {
    for (const RendererKind renderer : {RendererKind::deferred, RendererKind::deferred_all,
                                        RendererKind::forward_plus, RendererKind::forward}) {
        const bool too_slow = v.choice.quick && renderer == RendererKind::forward;
        const bool lacks_shadows = has_shadows(v.base) && is_forward(renderer);
        const bool lacks_trees = v.base.tails == Tails::tree;  // deferred alone has them
        if (renderer == v.base.renderer || too_slow || lacks_shadows || lacks_trees) continue;
        v.add_option(SettingAxis::renderer, renderer_name(renderer),
                     [&](RenderSettings& s) { s.renderer = renderer; });
    }
}

void add_shadings(Variants& v, const Scene& scene) {
    constexpr std::pair<Shading, const char*> kShadings[] = {{Shading::lambert, "lambert"},
                                                             {Shading::blinn_phong, "blinn-phong"},
                                                             {Shading::pbr, "pbr"}};
    const KernelFeatures kernels = make_scene_plan(scene, v.base, 0).kernels;
    for (const auto& [model, name] : kShadings) {
        const bool lacks_areas = kernels.area_lights && model == Shading::blinn_phong;
        if (model == shading_of(kernels) || lacks_areas) continue;
        v.add_option(SettingAxis::shading, name,
                     [shading = model](RenderSettings& s) { s.shading = shading; });
    }
}

// Lights with a size have no exact ones.
void add_shadows(Variants& v, const Scene& scene) {
    const RenderSettings& base = v.base;
    const bool has_areas = make_scene_plan(scene, base, 0).kernels.area_lights;
    constexpr std::pair<Shadows, const char*> kWays[] = {{Shadows::off, "off"},
                                                         {Shadows::exact, "exact"}};
    for (const auto& [shadows, name] : kWays) {
        if (shadows == base.shadows || (has_areas && shadows == Shadows::exact)) continue;
        v.add_option(SettingAxis::shadows, name,
                     [way = shadows](RenderSettings& s) { s.shadows = way; });
    }
    std::vector<int> all_rays = v.choice.shadow_rays;
    if (all_rays.empty())
        all_rays = has_areas ? std::vector{1, 2, 4, 8, 16, 32} : std::vector{1, 4, 16};
    for (const int rays : all_rays) {
        if (base.shadows == Shadows::sampled && rays == base.shadow_rays) continue;
        v.add(SettingAxis::shadows, fmt::format("shadows sampled {}", rays),
              fmt::format("--shadows sampled --shadow-rays {}", rays), [&](RenderSettings& s) {
                  s.shadows = Shadows::sampled;
                  s.shadow_rays = rays;
              });
    }
}

bool can_group(const Scene& scene, const RenderSettings& settings) {
    const auto points = std::ranges::count_if(scene.lights, is_for_tree);
    return static_cast<std::size_t>(points) > kExactTails && tree_can_light(scene, settings);
}

// Adds ways other than ranges of shading many lights that lack a range.
void add_tails(Variants& v, const Scene& scene) {
    if (v.base.renderer == RendererKind::deferred) {
        for (const int samples : {1, 4, 16}) {
            if (v.choice.quick && samples != 4) continue;
            v.add(SettingAxis::cut_off, fmt::format("tails stochastic {}", samples),
                  fmt::format("--tails stochastic --range-budget 0.0625 --samples {}", samples),
                  [&](RenderSettings& s) {
                      s.tails = Tails::stochastic;
                      s.range_budget = 0.0625;
                      s.samples = samples;
                  });
        }
    }
    if (!can_group(scene, v.base)) return;
    for (const float share : {0.01f, 0.03f, 0.1f, 0.3f, 1.0f}) {
        if (v.base.tails == Tails::tree && share == v.base.tree_share) continue;
        if (v.choice.quick && share != kDefaultTreeShare) continue;
        v.add(SettingAxis::cut_off, fmt::format("tails tree {}", share),
              fmt::format("--tails tree --tree-share {}", share), [&](RenderSettings& s) {
                  s.tails = Tails::tree;
                  s.tree_share = share;
              });
    }
}

void add_cut_offs(Variants& v, const Scene& scene) {
    const bool generated = v.base.lights.count > 0;
    const bool lacks_ranges = std::ranges::any_of(scene.lights, lacks_range);
    if (lacks_ranges &&
        tails_for(scene.lights, v.base.tails, v.base.range_budget) != Tails::exact) {
        v.add(SettingAxis::cut_off, "tails exact", "--tails exact",
              [](RenderSettings& s) { s.tails = Tails::exact; });
        add_tails(v, scene);
    }
    if (!generated && !lacks_ranges) return;
    const double intensity = automatic_light_scale(v.base.lights, scene).intensity;
    for (const int divisor : {4, 16, 64, 256, 1024}) {
        if (v.choice.quick && divisor != 16 && divisor != 256) continue;
        const double budget = 1.0 / divisor;
        const double radius = range_of_light(intensity, budget);
        std::string options = fmt::format("--tails bounded --range-budget {}", budget);
        if (generated) {
            options += fmt::format(" --light-radius {} --light-intensity {}", radius, intensity);
        }
        v.add(SettingAxis::cut_off, fmt::format("cut-off 1/{}", divisor), options,
              [&](RenderSettings& s) {
                  s.tails = Tails::bounded;
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
                                           const DeviceInfo& device, const SettingChoice& choice) {
    Variants variants{base, choice, {{SettingAxis::none, "default", "", base}}};
    if (!is_forward(base.renderer)) {
        add_gbuffers(variants);
        add_geometry(variants, device);
        add_lanes(variants, device);
        add_math(variants);
    }
    if (base.renderer != RendererKind::forward) add_grids(variants);
    add_renderers(variants);
    add_shadings(variants, scene);
    if (has_shadows(base)) add_shadows(variants, scene);
    add_cut_offs(variants, scene);
    return std::move(variants.settings);
}

double cut_off_of(const Scene& scene, const RenderSettings& settings) {
    if (settings.lights.count == 0) {
        const bool cuts =
            std::ranges::any_of(scene.lights, lacks_range) &&
            tails_for(scene.lights, settings.tails, settings.range_budget) == Tails::bounded;
        return cuts ? double{settings.range_budget} : 0.0;
    }
    const LightScale scale = automatic_light_scale(settings.lights, scene);
    return scale.intensity / (std::numbers::pi * scale.radius * scale.radius);
}

}  // namespace kilolux
