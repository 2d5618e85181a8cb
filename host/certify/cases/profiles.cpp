// SPDX-License-Identifier: Apache-2.0
// Case 34, light-profiles: photometric webs where their angles are hard to tell.
#include <fmt/format.h>
#include <functional>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/lights/photometry/photometry_file.h"

namespace kilolux {
namespace {

using Angles = std::vector<double>;  // [deg]

PhotometricWeb web_of(const Angles& vertical, const Angles& horizontal,
                      const std::function<double(double, double)>& candela) {
    std::string text = fmt::format("IES:LM-63-2019\nTILT=NONE\n1 -1 1 {} {} 1 2 0 0 0\n1 1 1\n",
                                   vertical.size(), horizontal.size());
    for (const double v : vertical) text += fmt::format("{} ", v);
    for (const double h : horizontal) text += fmt::format("{} ", h);
    for (const double h : horizontal) {
        for (const double v : vertical) text += fmt::format("{} ", candela(v, h));
    }
    return read_photometric_web(std::move(text), "light-profiles");
}

// A beam of a degree; a ridge along the seam of the horizontal angles; light that only goes up; and
// poles whose rings differ, so that the horizontal angle counts where it is hardest to tell.
std::vector<PhotometricWeb> hard_webs() {
    return {web_of({0, 0.25, 0.5, 0.75, 1, 90}, {0},
                   [](double v, double) { return std::max(0.0, 1000.0 - 1000.0 * v); }),
            web_of({0, 45, 90}, {0, 5, 180, 355, 360},
                   [](double v, double h) { return (h == 0 || h == 360 ? 100 : 1) * (90 - v); }),
            web_of({90, 120, 180}, {0}, [](double v, double) { return v - 90; }),
            web_of({0, 90, 180}, {0, 90, 180, 270, 360},
                   [](double v, double h) { return h == 360 ? 1 + v : 1 + v + h; })};
}

// Lights over and among the bodies, aimed down and up along an axis and aslant.
Scene profile_scene() {
    Scene scene = make_generated_scene("plain");
    scene.webs = hard_webs();
    const Box box = bounds(scene);
    const glm::dvec3 directions[] = {{0, -1, 0}, {0, 1, 0}, {0.6, -0.8, 0}, {0.48, -0.6, 0.64}};
    Random random(34);
    for (std::size_t i = 0; i < 192; ++i) {
        SceneLight light;
        const glm::dvec3 t{random.unit(), random.unit(), random.unit()};
        light.position = box.min + t * box.size() + glm::dvec3(0.0, 0.5, 0.0);
        light.direction = directions[i / 4 % 4];
        light.side = glm::normalize(glm::cross(light.direction, glm::dvec3(0.8, 0.0, 0.6)));
        light.intensity = glm::vec3(50.0f);
        light.range = static_cast<float>(0.5 * glm::length(box.size()));
        light.profile = static_cast<int>(i);
        scene.lights.push_back(light);
        scene.aimed_profiles.push_back({i % 4, i % 8 > 3});
    }
    return scene;
}

}  // namespace

void try_light_profiles(const Gpu& gpu, Findings& findings) {
    const Scene scene = profile_scene();
    const Camera camera = frame_box(bounds(scene));
    for (const Shading shading : {Shading::lambert, Shading::pbr}) {
        RenderSettings settings = scene_settings(gpu, 193, 129);
        settings.shading = shading;
        settings.gbuffer = GBUFFER_FULL;
        settings.ambient = 0.0f;
        Renderer renderer(scene, settings);
        const std::vector<float> listed = renderer.render(camera, 0.0).radiance;
        const ReferencePicture exact =
            shade_reference(renderer.lit_surfaces(), reference_options(renderer, camera));
        Worst worst;
        for (std::size_t i = 0; i < listed.size(); ++i) {
            const double scale = exact.scale.rgb[i];
            if (scale <= 0.0) continue;
            worst.add(std::abs(double{listed[i]} - exact.radiance.rgb[i]) / scale,
                      [&] { return fmt::format("value {}", i); });
        }
        findings.at_most("|d|/E", worst, 3e-6);
        findings.at_least("lit values", worst.checked, 5000);
        settings.renderer = RendererKind::deferred_all;
        check_same_bits(findings, "values unlike those of all lights", listed,
                        Renderer(scene, settings).render(camera, 0.0).radiance);
    }
}

}  // namespace kilolux
