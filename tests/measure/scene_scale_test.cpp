// SPDX-License-Identifier: Apache-2.0
// The same object is equally bright at any size, and kernels, OpenGL's shaders and the float64
// reference use the same least distance of lights.
#include <gtest/gtest.h>

#include <numeric>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/reference.h"
#include "host/render/renderer.h"
#include "host/scene/framing.h"
#include "host/scene/lights/light_region.h"
#include "host/scene/lights/rig.h"
#include "tests/support/box_scene.h"
#include "tests/support/full.h"

namespace kilolux {
namespace {

// [m]; each builds kernels with its least distance, but for those from 1 m on.
std::vector<double> sizes() {
    return runs_full() ? std::vector{1e-3, 1e-2, 0.1, 1.0, 1e4} : std::vector{1e-3, 1e4};
}

RenderSettings settings_of(std::uint64_t lights, RendererKind renderer = RendererKind::deferred) {
    RenderSettings settings;
    settings.width = 96;
    settings.height = 64;
    settings.lights.count = lights;
    settings.renderer = renderer;
    settings.ambient = 0.0f;
    return settings;
}

double mean(const Frame& frame) {
    return std::accumulate(frame.radiance.begin(), frame.radiance.end(), 0.0) /
           static_cast<double>(frame.radiance.size());
}

Frame render_framed(const Scene& scene, const RenderSettings& settings) {
    return Renderer(scene, settings).render(framing_camera(scene, 1.5), 0.0);
}

Scene lit_box(double size, bool inwards, Rig rig) {
    Scene scene = box_scene(glm::dvec3(size, 0.8 * size, 1.1 * size), inwards);
    scene.lights = rig_lights(rig);
    return scene;
}

TEST(SceneScale, TheSameObjectIsAsBrightAtEverySize) {
    for (const bool inwards : {false, true}) {
        for (const Rig rig : {Rig::swarm, Rig::studio, Rig::headlight}) {
            const RenderSettings settings = settings_of(rig == Rig::swarm ? 2000 : 0);
            const double wanted = mean(render_framed(lit_box(1.0, inwards, rig), settings));
            EXPECT_GT(wanted, 0.05) << static_cast<int>(rig);
            EXPECT_LT(wanted, 0.6) << static_cast<int>(rig);
            for (const double size : sizes()) {
                const double seen = mean(render_framed(lit_box(size, inwards, rig), settings));
                EXPECT_NEAR(seen / wanted, 1.0, 0.1) << size << " m, rig " << static_cast<int>(rig);
            }
        }
    }
}

TEST(SceneScale, AFlatSceneIsLitAtEverySize) {
    double wanted = 0.0;
    for (const double size : sizes()) {
        const double seen = mean(render_framed(box_scene({size, 0.0, size}), settings_of(2000)));
        if (wanted == 0.0) wanted = seen;
        EXPECT_GT(seen, 0.02) << size;
        EXPECT_NEAR(seen / wanted, 1.0, 0.1) << size;
    }
}

TEST(SceneScale, ListsChangeNoBitOfSmallOrLargeScenes) {
    for (const double size : sizes()) {
        const Scene scene = box_scene(glm::dvec3(size));
        EXPECT_EQ(render_framed(scene, settings_of(2000)).radiance,
                  render_framed(scene, settings_of(2000, RendererKind::deferred_all)).radiance)
            << size;
    }
}

// A box whose only light is a hundredth of its least distance off a face that the camera sees.
Scene box_with_light_at_its_face(double size) {
    Scene scene = box_scene(glm::dvec3(size));
    SceneLight light;
    light.position = {0.1 * size, 0.05 * size, 0.5 * size + 0.01 * double{light_d_min(scene)}};
    light.range = static_cast<float>(size);
    light.intensity = glm::vec3(static_cast<float>(size * size));
    scene.lights.push_back(light);
    return scene;
}

TEST(SceneScale, KernelsShadersAndReferenceHaveOneLeastDistance) {
    for (const double size : runs_full() ? std::vector{1e-3, 0.05, 1.0} : std::vector{1e-3, 1.0}) {
        const Scene scene = box_with_light_at_its_face(size);
        RenderSettings settings = settings_of(0);
        settings.gbuffer = GBUFFER_FULL;
        // So near that pixels lie within the least distance of the light.
        const double d_min = light_d_min(scene);
        Camera camera = look_at(scene.lights[0].position + glm::dvec3(0, 0, 8.0 * d_min),
                                scene.lights[0].position, {0, 1, 0}, 0.7);
        camera.z_near = 0.1 * d_min;
        Renderer renderer(scene, settings);
        EXPECT_EQ(renderer.plan().kernels.light_d_min, light_d_min(scene));
        const Frame frame = renderer.render(camera, 0.0);
        const ReferencePicture reference =
            shade_reference(renderer.lit_surfaces(), reference_options(renderer, camera));
        const Frame forward =
            Renderer(scene, settings_of(0, RendererKind::forward)).render(camera, 0.0);
        double brightest = 0.0;
        for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
            const double scale = reference.scale.rgb[i];
            brightest = std::max(brightest, scale);
            // 1e-5 as certify's case 13; OpenGL's interpolated positions are a thousandth off.
            EXPECT_NEAR(frame.radiance[i], reference.radiance.rgb[i], 1e-5 * scale) << size;
            EXPECT_NEAR(forward.radiance[i], reference.radiance.rgb[i], 1e-3 * scale) << size;
        }
        EXPECT_NEAR(brightest * d_min * d_min / (size * size), 1.0, 1e-3) << "a pixel is within it";
    }
}

}  // namespace
}  // namespace kilolux
