// SPDX-License-Identifier: Apache-2.0
// A scene a million metres from the origin looks as it does at the origin: positions meet the
// camera in double (ACCURACY hard case 19).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/render/renderer.h"
#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

// Exactly representable, so that only the sums with it round.
const glm::dvec3 kFarAway(0x1p20, -0x1p20, 0x1p20);

Frame render_at(const glm::dvec3& offset, RendererKind renderer) {
    Scene scene = make_generated_scene("plain", 1);
    Box box = scene.light_box.empty() ? bounds(scene) : scene.light_box;
    for (Instance& instance : scene.instances) {
        instance.world_from_object[3] += glm::dvec4(offset, 0.0);
    }
    scene.light_box = Box{box.min + offset, box.max + offset};
    Camera camera = camera_of(scene.cameras.at(0));
    camera.position += offset;
    RenderSettings settings;
    settings.width = 160;
    settings.height = 90;
    settings.lights.count = 300;
    settings.renderer = renderer;
    settings.gbuffer = GBUFFER_FULL;
    return Renderer(scene, settings).render(camera, 0.0);
}

TEST(FarFromOrigin, AMillionMetresAwayThePictureIsTheSame) {
    const Frame near = render_at(glm::dvec3(0.0), RendererKind::deferred);
    const Frame far = render_at(kFarAway, RendererKind::deferred);
    std::size_t off = 0;
    for (std::size_t i = 0; i < near.radiance.size(); ++i) {
        // 1e-4: what a pixel's edge moves by when a vertex rounds; a wrong order of subtraction
        // gives 0.1.
        const float scale = std::max(near.radiance[i], 0.05f);
        if (std::abs(far.radiance[i] - near.radiance[i]) > 1e-4f * scale) ++off;
    }
    EXPECT_LE(off, near.radiance.size() / 1000);
}

TEST(FarFromOrigin, ListsChangeNoBitThere) {
    EXPECT_EQ(render_at(kFarAway, RendererKind::deferred).radiance,
              render_at(kFarAway, RendererKind::deferred_all).radiance);
}

}  // namespace
}  // namespace kilolux
