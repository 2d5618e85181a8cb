// SPDX-License-Identifier: Apache-2.0
#include "host/certify/tail_scenarios.h"

#include <algorithm>
#include <cmath>

#include "host/measure/reference/decoded_samples.h"
#include "host/render/light_source.h"
#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

constexpr int kTailLights = 60;

SceneLight light_at(const glm::dvec3& position, float intensity) {
    SceneLight light;
    light.position = position;
    light.intensity = intensity * glm::vec3(1.0f, 0.8f, 0.6f);
    return light;
}

// In [0, 1), evenly spread: the golden ratio's multiples.
double spread(int i, double step) { return std::fmod(0.5 + i * step, 1.0); }

glm::dvec3 place_above(const Box& box, int i) {
    return {box.min.x + spread(i, 0.618034) * box.size().x, box.max.y + 0.2 + spread(i, 0.32472),
            box.min.z + spread(i, 0.754878) * box.size().z};
}

TailScenario start(const char* name) {
    TailScenario out{name, make_generated_scene("grid"), {}};
    out.camera = frame_box(bounds(out.scene));
    return out;
}

TailScenario among_lights() {
    TailScenario out = start("camera among the lights");
    for (int i = 0; i < kTailLights; ++i) {
        const glm::dvec3 off(spread(i, 0.618034), spread(i, 0.32472), spread(i, 0.754878));
        out.scene.lights.push_back(light_at(out.camera.position + off - 0.5, 20.0f));
    }
    return out;
}

TailScenario spread_intensities() {
    TailScenario out = start("intensities over e^40");
    const Box box = bounds(out.scene);
    for (int i = 0; i < kTailLights; ++i) {
        const double exponent = -20.0 + 40.0 * i / (kTailLights - 1);
        out.scene.lights.push_back(
            light_at(place_above(box, i), static_cast<float>(std::exp(exponent))));
    }
    return out;
}

TailScenario outshone() {
    TailScenario out = start("one outshines the rest");
    const Box box = bounds(out.scene);
    for (int i = 0; i < kTailLights; ++i) {
        out.scene.lights.push_back(light_at(place_above(box, i), i == 7 ? 1e12f : 1.0f));
    }
    return out;
}

TailScenario spots() {
    TailScenario out = start("spots and points");
    const Box box = bounds(out.scene);
    for (int i = 0; i < kTailLights; ++i) {
        SceneLight light = light_at(place_above(box, i), 3.0f);
        if (i % 2 == 0) {
            light.type = LightType::spot;
            light.direction = glm::normalize(glm::dvec3(0.3, -1.0, 0.2));
            light.inner_cone = 0.3f;
            light.outer_cone = 0.9f;
        }
        out.scene.lights.push_back(light);
    }
    return out;
}

TailScenario touching() {
    TailScenario out = start("at a surface");
    const Box box = bounds(out.scene);
    for (int i = 0; i < kTailLights; ++i) {
        glm::dvec3 at = place_above(box, i);
        at.y = box.max.y + 1e-6;
        out.scene.lights.push_back(light_at(at, 1.0f));
    }
    return out;
}

}  // namespace

std::vector<TailScenario> tail_scenarios() {
    return {among_lights(), spread_intensities(), outshone(), spots(), touching()};
}

TailAgreement compare_tails(const TailScenario& scenario, RenderSettings settings) {
    settings.want.aovs = {"error-bound"};
    Renderer renderer(scenario.scene, settings);
    const Frame frame = renderer.render(scenario.camera, 0.0);
    RenderSettings unlimited = settings;
    unlimited.tails = Tails::exact;
    const std::vector<SceneLight> lights =
        lights_at(scenario.scene, unlimited, scenario.camera, 0.0);
    const ReferencePicture truth = shade_reference(
        surface_samples(renderer.lit_surfaces().surfaces),
        reference_lights(lights, scenario.camera), reference_options(renderer, scenario.camera));
    TailAgreement out;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        const double scale = truth.scale.rgb[i];
        if (!(scale > 0.0)) continue;
        ++out.values;
        const double error = std::abs(truth.radiance.rgb[i] - frame.radiance[i]);
        const double bound = frame.aovs.front().values[i];
        out.largest_error = std::max(out.largest_error, error / scale);
        out.below += error > bound + 1e-5 * scale ? 1 : 0;
        if (error > 1e-4 * scale) out.looseness.push_back(bound / error);
    }
    return out;
}

}  // namespace kilolux
