// SPDX-License-Identifier: Apache-2.0
// GGX light of area lights is the same in GLSL as in C++.
#include "kernels/shared/area/ggx_area.h"

#include <random>

#include "raster/compute_probe.h"
#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using GgxAreaTest = GlTest;

// A lobe about +z and a light.
struct Probe {
    float4 eye_roughness;
    LightShape shape;
    float4 center;
};

std::vector<Probe> probes() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> some(-1.0f, 1.0f);
    std::vector<Probe> probes;
    for (int i = 0; i < 500; ++i) {
        const float z = 0.55f + 0.45f * some(random), x = std::sqrt(1.0f - z * z);
        const float size = std::exp(2.0f * some(random));
        const auto half = [&](float w) {
            return float4{size * some(random), size * some(random), size * some(random), w};
        };
        const float kinds[] = {SHAPE_RECTANGLE, SHAPE_DISK, SHAPE_SPHERE, SHAPE_TRIANGLE};
        Probe probe{{x, 0.0f, z, 0.6f + 0.4f * some(random)},
                    {half(-kinds[i % 4]), half(1.0f)},
                    {2.0f * some(random), 2.0f * some(random), 2.0f, 0.0f}};
        probes.push_back(probe);
    }
    return probes;
}

float4 light_of(const Probe& probe) {
    const FV3 up = fv3(0.0f, 0.0f, 1.0f);
    const FV3 eye = fv3(probe.eye_roughness.x, probe.eye_roughness.y, probe.eye_roughness.z);
    const GgxLobe lobe = make_ggx_lobe(up, eye, probe.eye_roughness.w);
    const AreaFrame frame = make_area_frame(up, eye);
    const AreaLobe area = make_area_lobe(lobe, lobe.alpha);
    const FramedLight seen =
        seen_light(fv3(probe.center.x, probe.center.y, probe.center.z), probe.shape);
    const LobeLight light = area_ggx(frame, lobe, area, light_in_frame(frame, seen));
    return {light.light, light.rise, 0.0f, 0.0f};
}

TEST_F(GgxAreaTest, GlslAndCppAgree) {
    const GlProgram program = compute_program(
        {"kernels/shared/area/ggx_area.h"},
        "layout(local_size_x = 64) in;\n"
        "struct Probe { vec4 eye_roughness; LightShape shape; vec4 center; };\n"
        "layout(std430, binding = 0) buffer In { Probe probe[]; };\n"
        "layout(std430, binding = 1) buffer Out { vec4 result[]; };\n"
        "void main() {\n"
        "    uint i = gl_GlobalInvocationID.x;\n"
        "    if (i >= probe.length()) return;\n"
        "    FV3 up = fv3(0.0, 0.0, 1.0);\n"
        "    vec4 e = probe[i].eye_roughness, c = probe[i].center;\n"
        "    FV3 eye = fv3(e.x, e.y, e.z);\n"
        "    GgxLobe lobe = make_ggx_lobe(up, eye, e.w);\n"
        "    AreaFrame frame = make_area_frame(up, eye);\n"
        "    AreaLobe area = make_area_lobe(lobe, lobe.alpha);\n"
        "    FramedLight seen = seen_light(fv3(c.x, c.y, c.z), probe[i].shape);\n"
        "    LobeLight light = area_ggx(frame, lobe, area, light_in_frame(frame, seen));\n"
        "    result[i] = vec4(light.light, light.rise, 0.0, 0.0);\n"
        "}\n");
    const std::vector<Probe> in = probes();
    const std::vector<float4> out = run_compute<float4>(program, in);
    int lit = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
        const float4 expected = light_of(in[i]);
        lit += expected.x > 0.01f;
        EXPECT_NEAR(out[i].x, expected.x, 1e-4f * expected.x + 1e-5f) << i;
        EXPECT_NEAR(out[i].y, expected.y, 1e-4f) << i;
    }
    EXPECT_GT(lit, 200);
}

}  // namespace
}  // namespace kilolux
