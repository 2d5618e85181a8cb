// SPDX-License-Identifier: Apache-2.0
// Case 35, area-lights: every kind of light with a size, unshadowed and with sampled shadows.
#include <fmt/format.h>

#include <algorithm>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/measure/bench/lighting_bench.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/lights/light_kinds.h"

namespace kilolux {
namespace {

// Lights over and among the bodies: small and large ones, some that cut through the floor, flat
// ones of one and of two sides, aimed down, up and aslant.
Scene area_scene() {
    Scene scene = make_generated_scene("plain");
    const Box box = bounds(scene);
    const glm::dvec3 directions[] = {{0, -1, 0}, {0, 1, 0}, {0.6, -0.8, 0}, {0.48, -0.6, 0.64}};
    Random random(35);
    std::size_t i = 0;
    for (const LightKind& kind : kLightKinds) {
        for (int n = 0; n < 16 && kind.shape != SHAPE_POINT; ++n, ++i) {
            SceneLight& light = scene.lights.emplace_back();
            const glm::dvec3 t{random.unit(), random.unit(), random.unit()};
            light.type = kind.type;
            light.position = box.min + t * box.size();
            light.direction = directions[i % 4];
            light.side = glm::normalize(glm::cross(light.direction, glm::dvec3(0.8, 0.0, 0.6)));
            light.width = static_cast<float>(random.uniform(0.02, 1.5));
            light.height = static_cast<float>(random.uniform(0.02, 1.5));
            light.skew = static_cast<float>(random.uniform(-0.5, 0.5));
            light.radius = static_cast<float>(random.uniform(0.01, 0.4));
            light.two_sided = i % 3 == 0;
            light.intensity = {3.0f, 2.0f, 2.5f};
            light.range = static_cast<float>(random.uniform(0.2, 0.6) * glm::length(box.size()));
        }
    }
    return scene;
}

std::vector<float> picture_of(const Scene& scene, const RenderSettings& settings) {
    return Renderer(scene, settings).render(camera_of(scene.cameras.front()), 0.0).radiance;
}

// Diffuse light is a closed form; the specular lobes are approximations and have no bound here.
void check_diffuse(const Gpu& gpu, Findings& findings, const Scene& scene) {
    RenderSettings settings = scene_settings(gpu, 65, 37);
    settings.shading = Shading::lambert;
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.0f;
    const Camera camera = camera_of(scene.cameras.front());
    Renderer renderer(scene, settings);
    const std::vector<float> found = renderer.render(camera, 0.0).radiance;
    const ReferencePicture exact =
        shade_reference(renderer.lit_surfaces(), reference_options(renderer, camera));
    Worst worst;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double scale = exact.scale.rgb[i];
        if (scale <= 0.0) continue;
        worst.add(std::abs(double{found[i]} - exact.radiance.rgb[i]) / scale,
                  [&] { return fmt::format("value {}", i); });
    }
    findings.at_most("Lambert: |d|/E", worst, 2e-5);
    findings.at_least("lit values", worst.checked, 2000);
}

// All lights, another grid, bands, and on CPUs one lane.
void check_forms(const Gpu& gpu, Findings& findings, const Scene& scene, RenderSettings settings) {
    const std::vector<float> listed = picture_of(scene, settings);
    const auto bad = std::ranges::count_if(listed, [](float v) { return !std::isfinite(v); });
    findings.none("NaN or Inf", static_cast<std::uint64_t>(bad), listed.size());
    const auto check = [&](const char* what, const auto& change) {
        RenderSettings other = settings;
        change(other);
        check_same_bits(findings, what, picture_of(scene, other), listed);
    };
    check("values unlike those of all lights",
          [](RenderSettings& s) { s.renderer = RendererKind::deferred_all; });
    check("of another grid", [](RenderSettings& s) { s.grid = {5, 3, 2, 2}; });
    check("of bands", [](RenderSettings& s) { s.band_rows = 16; });
    if (!gpu.info.is_cpu) return;
    check("of one lane", [&](RenderSettings& s) {
        s.kernels.lanes = 1;
        s.opened = std::make_shared<const Gpu>(gpu.with_lanes(1));
    });
}

// The ways of casting the rays.
void check_casts(Findings& findings, const Scene& scene, const RenderSettings& settings) {
    LightingBench bench(scene, settings, camera_of(scene.cameras.front()));
    LightingRequest request = bench.request();
    request.runs = 1;
    request.tuning.tuning.shadow_group = 1;
    const std::uint64_t expected = bench.run(request).picture;
    std::uint64_t others = 0;
    for (const int group : {0, 32, 64}) {
        request.tuning.tuning.shadow_group = group;
        others += bench.run(request).picture != expected;
    }
    findings.none("work-groups whose shadows differ", others, 3);
}

}  // namespace

void try_area_lights(const Gpu& gpu, Findings& findings) {
    const Scene scene = area_scene();
    check_diffuse(gpu, findings, scene);
    RenderSettings settings = scene_settings(gpu, 96, 54);
    check_forms(gpu, findings, scene, settings);
    settings.shadows = Shadows::sampled;
    settings.shadow_rays = 6;
    check_forms(gpu, findings, scene, settings);
    check_casts(findings, scene, settings);
    const std::vector<float> shadowed = picture_of(scene, settings);
    settings.shadows = Shadows::off;
    const Worst shaded = different_bits(shadowed, picture_of(scene, settings));
    findings.at_least("values in shadow", static_cast<std::uint64_t>(shaded.value), 1000);
}

}  // namespace kilolux
