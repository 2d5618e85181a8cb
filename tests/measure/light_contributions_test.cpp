// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/light_contributions.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace kilolux {
namespace {

ProbedLight light_at(uint index, float z, float range) {
    ProbedLight out;
    out.index = index;
    out.shade.position_inv_range2 = {0.0f, 0.0f, z, 1.0f / (range * range)};
    out.shade.color_scale = {1.0f, 1.0f, 1.0f, 1.0f};
    out.shade.axis_cos = {0.0f, 0.0f, 0.0f, -1.0f};
    return out;
}

// A gray wall 5 m ahead that faces the camera.
PixelProbe wall() {
    PixelProbe probe;
    probe.surface.fill(0.0f);
    probe.surface[SURFACE_DEPTH] = 5.0f;
    probe.surface[SURFACE_POSITION + 2] = -5.0f;
    probe.surface[SURFACE_NORMAL + 2] = 1.0f;
    for (std::size_t c = 0; c < 3; ++c) probe.surface[SURFACE_ALBEDO + c] = 0.5f;
    probe.surface[SURFACE_ROUGHNESS] = 1.0f;
    return probe;
}

TEST(LightContributions, SayWhyALightAddsNothing) {
    PixelProbe probe = wall();
    probe.lights = {light_at(0, -4.0f, 3.0f), light_at(1, -1.0f, 2.0f), light_at(2, -6.0f, 3.0f),
                    light_at(3, -4.0f, 3.0f), light_at(4, -4.0f, 3.0f)};
    probe.lights[3].shade.axis_cos = {0.0f, 0.0f, 1.0f, 0.9f};  // a spot that points away
    probe.lights[3].shade.color_scale.w = 20.0f;
    probe.lights[4].seen = false;
    std::map<uint, std::string> why;
    for (const LightContribution& light : light_contributions(probe, {})) {
        why[light.index] = light.why_dark;
        EXPECT_EQ(light.radiance.x > 0.0, light.index == 0) << light.index;
    }
    EXPECT_EQ(why, (std::map<uint, std::string>{{0, ""},
                                                {1, "out of range"},
                                                {2, "behind the surface"},
                                                {3, "outside its cone"},
                                                {4, "hidden"}}));
}

}  // namespace
}  // namespace kilolux
