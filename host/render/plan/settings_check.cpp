// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/settings_check.h"

#include <algorithm>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/render/plan/scene_plan.h"

namespace kilolux {
namespace {

void check_forced(const std::vector<std::string>& names) {
    const std::vector<std::string>& known = forceable_features();
    for (const std::string& name : names) {
        if (std::ranges::count(known, name) > 0) continue;
        throw Error("scene plan: '" + name + "' cannot be forced; these can: " + joined(known));
    }
}

// Shadow rays end on a triangle that OpenCL resolved, and deferred keeps their results.
void check_shadows(const RenderSettings& settings) {
    const FrameRequest& want = settings.want;
    const bool wants_bits = want.view == ViewKind::shadows || want.has_aov("visibility");
    if (wants_bits &&
        (settings.shadows != Shadows::exact || settings.renderer != RendererKind::deferred)) {
        throw UsageError("shadows: to show them takes --shadows exact and --renderer deferred");
    }
    if (settings.shadows == Shadows::off) return;
    if (is_forward(settings.renderer)) {
        throw UsageError("shadows: the forward renderers cast none; take --renderer deferred");
    }
    if (!resolves_ids(settings.geometry)) {
        throw UsageError("shadows: none with --geometry planes; take ids or compute");
    }
}

void check_tails(const RenderSettings& settings) {
    const bool is_stochastic = settings.tails == Tails::stochastic;
    const bool deferred = settings.renderer == RendererKind::deferred;
    if (settings.want.has_aov("sample-count") && !settings.auto_samples.on) {
        throw UsageError("aov sample-count: needs --samples auto");
    }
    if (settings.want.has_aov("error-standard") && !settings.auto_samples.on) {
        if (!is_stochastic && settings.shadows != Shadows::sampled) {
            throw UsageError(
                "aov error-standard: only --samples auto, --shadows sampled and --tails stochastic "
                "have one");
        }
        if (is_stochastic && !deferred) {
            throw UsageError(
                "aov error-standard: of --tails stochastic only --renderer deferred "
                "has one");
        }
    }
    if (settings.tails == Tails::tree && !deferred) {
        throw UsageError("tails tree: only --renderer deferred has it; take --tails exact");
    }
    if (settings.tails == Tails::tree && settings.shadows != Shadows::off) {
        throw UsageError(
            "tails tree: its nodes cast no shadows; take --shadows off, or --tails stochastic");
    }
    if (settings.want.has_aov("error-bound") && (is_stochastic || !deferred)) {
        throw UsageError(
            "aov error-bound: it takes --renderer deferred, and not --tails stochastic, which has "
            "error-standard");
    }
}

// Deferred shading alone has lists, and knows which of their lights reach a pixel in vain.
void check_view(const RenderSettings& settings) {
    if (settings.want.view == ViewKind::false_positives &&
        settings.renderer != RendererKind::deferred) {
        throw UsageError("--show false-positives: shows the lists of --renderer deferred only");
    }
}

void check_light_groups(const RenderSettings& settings) {
    if (settings.light_groups.empty()) return;
    if (is_forward(settings.renderer)) {
        throw UsageError(
            "light groups: the forward renderers have no layers; take --renderer deferred, or "
            "--no-light-layers");
    }
    if (settings.auto_samples.on) {
        throw UsageError(
            "light groups: no layers with --samples auto; give a number of samples, or take "
            "--no-light-layers");
    }
}

void check_illuminance(const RenderSettings& settings) {
    if (settings.shading == Shading::illuminance && settings.reflections) {
        throw UsageError("shading illuminance: it is that of lights; leave out --reflections");
    }
    if (settings.shading == Shading::illuminance && settings.want.view == ViewKind::luminance) {
        throw UsageError("--show luminance: not of --shading illuminance; take --show illuminance");
    }
    if (!settings.want.illuminance()) return;
    if (is_forward(settings.renderer)) {
        throw UsageError("illuminance: of the forward renderers only --shading illuminance");
    }
    if (settings.tails == Tails::stochastic) {
        throw UsageError(
            "illuminance: a layer has no stochastic tails; take --tails bounded, or --shading "
            "illuminance");
    }
    if (settings.shadows == Shadows::sampled) {
        throw UsageError(
            "illuminance: a layer has no sampled shadows; take --shadows exact, or --shading "
            "illuminance");
    }
}

}  // namespace

void check_settings(const RenderSettings& settings) {
    check_forced(settings.force_features);
    check_shadows(settings);
    check_tails(settings);
    check_view(settings);
    check_light_groups(settings);
    check_illuminance(settings);
}

std::string area_lights_problem(int shading, Shadows shadows) {
    if (shadows == Shadows::exact) {
        return "shadows exact: a point may see a part of a light with a size; use --shadows "
               "sampled, with many --shadow-rays for little noise";
    }
    if (shading != SHADING_BLINN_PHONG) return "";
    return "shading blinn-phong: it has no highlights of lights with a size; use pbr or lambert";
}

void check_area_lights(int shading, Shadows shadows) {
    const std::string problem = area_lights_problem(shading, shadows);
    if (!problem.empty()) throw UsageError(problem);
}

// Shading::automatic is one of the models that take them.
bool take_area_lights(const RenderSettings& settings) {
    const int shading =
        settings.shading == Shading::automatic ? SHADING_PBR : model_of(settings.shading);
    return area_lights_problem(shading, settings.shadows).empty();
}

bool tree_can_light(const Scene& scene, const RenderSettings& settings) {
    return settings.renderer == RendererKind::deferred && settings.shadows == Shadows::off &&
           settings.light_groups.empty() && !has_blended_surfaces(scene);
}

}  // namespace kilolux
