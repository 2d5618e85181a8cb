// SPDX-License-Identifier: Apache-2.0
// Radiance of images: against double over the decoded G-buffer, and lists against all lights, bit
// for bit.
#include "host/stages/shading/shade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/certify/synthetic/host_lists.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/opencl/shading/shading_reference.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

// Relative to the larger of radiance and intensity * falloff.
constexpr double kShadeTolerance = 1e-5;
constexpr float kAmbient = 0.05f;

const std::vector<DirectionalLight>& sun() {
    static const std::vector<DirectionalLight> lights = {
        {{0.48f, 0.6f, 0.64f, 0.0f}, {0.5f, 0.6f, 0.7f, 0.0f}},
        {{0.0f, -1.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.2f, 0.0f}}};
    return lights;
}

struct Frame {
    std::vector<float> listed, all;  // radiance by lists and by all lights
    std::string lists;               // fingerprint
    std::vector<ShadeLight> lights;
    std::vector<DirectionalLight> directional;
};

struct FrameInput {
    KernelFeatures features;
    ViewShape shape;
    GridRequest request{16, 9, 4, 0.5f, 50.0f, 0.0f};
    DepthOf depth = noise_depth(0.3, 60.0, 0.2, 8);
    std::vector<Light> lights;
};

Frame shade_frame(const Gpu& gpu, const FrameInput& in, const Tuning& tuning) {
    const View view = make_view(in.shape);
    const ClusterGrid grid = make_cluster_grid(in.request, view.width, view.height);
    const GBuffer gbuffer = upload_gbuffer(gpu, make_synthetic(view, in.features, in.depth));
    Shade shade(gpu, tuning, in.features);
    shade.set_ambient(kAmbient);
    ShadeAll shade_all(gpu, tuning, in.features);
    shade_all.set_ambient(kAmbient);
    const ListedLights lists = list_everywhere(
        gpu, tuning, in.features, {gbuffer, upload_lights(gpu, in.lights, sun()), grid});
    StageTimer timer;
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    Frame frame;
    frame.listed = download<float>(gpu, shade.enqueue(lists.at(gbuffer), timer).planes, size);
    frame.all = download<float>(gpu, shade_all.enqueue(gbuffer, lists.lights, timer).planes, size);
    frame.lists = fingerprint(download_lists(gpu, in.features, lists));
    frame.lights = download<ShadeLight>(gpu, lists.lights.lights, in.lights.size());
    frame.directional = download<DirectionalLight>(gpu, lists.lights.directional, sun().size());
    return frame;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

KernelFeatures full_features(int shading) {
    KernelFeatures features;
    features.shading = shading;
    features.material = features.metallic = features.occlusion = features.specular = true;
    features.clearcoat = features.coat_normals = features.sheen = features.anisotropy = true;
    features.spot_lights = features.directional_lights = true;
    return features;
}

FrameInput usual_input(int shading, std::uint32_t light_count) {
    FrameInput in;
    in.features = full_features(shading);
    in.shape.width = 83;
    in.shape.height = 45;
    RandomLightOptions mix;
    mix.count = light_count;
    mix.spots = 0.4;
    in.lights = random_lights(make_view(in.shape), mix);
    return in;
}

SurfaceD surface_at(const Planes& planes, uint x, uint y) {
    SurfaceD s;
    s.position = planes.vector(SURFACE_POSITION, x, y);
    s.normal = planes.vector(SURFACE_NORMAL, x, y);
    s.albedo = planes.vector(SURFACE_ALBEDO, x, y);
    s.emissive = planes.vector(SURFACE_EMISSIVE, x, y);
    s.roughness = planes.at(SURFACE_ROUGHNESS, x, y);
    s.metallic = planes.at(SURFACE_METALLIC, x, y);
    s.specular = planes.vector(SURFACE_SPECULAR, x, y);
    s.specular_f90 = planes.at(SURFACE_SPECULAR_F90, x, y);
    s.occlusion = planes.at(SURFACE_OCCLUSION, x, y);
    s.coat = planes.at(SURFACE_COAT, x, y);
    s.coat_roughness = planes.at(SURFACE_COAT_ROUGHNESS, x, y);
    s.coat_normal = planes.vector(SURFACE_COAT_NORMAL, x, y);
    s.sheen = planes.vector(SURFACE_SHEEN, x, y);
    s.sheen_roughness = planes.at(SURFACE_SHEEN_ROUGHNESS, x, y);
    s.tangent = planes.vector(SURFACE_TANGENT, x, y);
    s.anisotropy = planes.at(SURFACE_ANISOTROPY, x, y);
    return s;
}

// Lobes narrower than roughness 0.3 and normals away from the eye are evaluate_test.cpp's subject.
bool is_well_conditioned(const SurfaceD& s, bool orthographic) {
    const glm::dvec3 eye = orthographic ? glm::dvec3{0, 0, 1} : s.position * -1.0;
    return std::min({s.roughness, s.coat_roughness, s.sheen_roughness}) >= 0.3 &&
           dot(s.normal, eye) > 0;
}

void expect_as_double(const FrameInput& in) {
    const Gpu gpu = test_gpu();
    const Frame frame = shade_frame(gpu, in, default_tuning(gpu.info));
    const View view = make_view(in.shape);
    const Planes planes =
        decode(gpu, in.features, upload_gbuffer(gpu, make_synthetic(view, in.features, in.depth)));
    const Lighting lighting{frame.lights, frame.directional, kAmbient, view.orthographic != 0,
                            in.features.shading};
    const std::size_t size = std::size_t{view.stride} * view.height;
    std::size_t compared = 0;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.stride; ++x) {
            const std::size_t i = std::size_t{y} * view.stride + x;
            const glm::dvec3 found{frame.listed[i], frame.listed[size + i],
                                   frame.listed[2 * size + i]};
            if (x >= view.width ||
                planes.at(SURFACE_ROUGHNESS, x, y) + planes.at(SURFACE_OCCLUSION, x, y) == 0 ||
                length(planes.vector(SURFACE_NORMAL, x, y)) == 0) {
                ASSERT_EQ(length(found), 0.0) << "background at " << x << ", " << y;
                continue;
            }
            const SurfaceD surface = surface_at(planes, x, y);
            if (!is_well_conditioned(surface, lighting.orthographic)) continue;
            ++compared;
            ASSERT_LE(relative_error(found, reference_radiance(surface, lighting)), kShadeTolerance)
                << "pixel " << x << ", " << y;
        }
    }
    EXPECT_GT(compared, std::size_t{view.width} * view.height / 10);
}

TEST(Shade, AgreesWithDoubleForEveryModel) {
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        SCOPED_TRACE("shading " + std::to_string(shading));
        FrameInput in = usual_input(shading, 150);
        expect_as_double(in);
        in.shape.orthographic = true;
        in.shape.half_x = 20;
        in.shape.half_y = 15;
        expect_as_double(in);
    }
}

TEST(Shade, FeaturesLeftOutChangeNothingButThemselves) {
    // Without spots, directional lights, materials and occlusion compiled in, dielectrics included.
    FrameInput in = usual_input(SHADING_PBR, 100);
    in.features = {};
    in.features.shading = SHADING_PBR;
    for (Light& light : in.lights)
        light =
            point_light({light.position_range.x, light.position_range.y, light.position_range.z},
                        light.position_range.w, {1, 2, 3});
    const Gpu gpu = test_gpu();
    const Frame lean = shade_frame(gpu, in, default_tuning(gpu.info));
    EXPECT_TRUE(same_bits(lean.listed, lean.all));
    in.features.spot_lights = true;
    const Frame with_spots = shade_frame(gpu, in, default_tuning(gpu.info));
    EXPECT_TRUE(same_bits(lean.listed, with_spots.listed));
}

TEST(Shade, ListsGiveTheBitsOfAllLightsForEveryModelAndImage) {
    const Gpu gpu = test_gpu();
    const DepthOf depths[] = {noise_depth(0.3, 60.0, 0.2, 8), checkerboard_depth(0.4, 55.0),
                              slanted_depth(1, 20, 83), no_depth()};
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        FrameInput in = usual_input(shading, 3000);
        int index = 0;
        for (const DepthOf& depth : depths) {
            in.depth = depth;
            const Frame frame = shade_frame(gpu, in, default_tuning(gpu.info));
            EXPECT_TRUE(same_bits(frame.listed, frame.all))
                << "shading " << shading << ", depth " << index;
            ++index;
        }
    }
}

TEST(Shade, ListsGiveTheBitsOfAllLightsForZeroOneAndManyLights) {
    const Gpu gpu = test_gpu();
    FrameInput in = usual_input(SHADING_PBR, 0);
    for (const std::uint32_t count : {0u, 1u, 63u, 64u, 65u, 9000u}) {
        in.lights = usual_input(SHADING_PBR, count).lights;
        const Frame frame = shade_frame(gpu, in, default_tuning(gpu.info));
        EXPECT_TRUE(same_bits(frame.listed, frame.all)) << count << " lights";
    }
}

std::vector<Tuning> shade_tunings(const DeviceInfo& info) {
    std::vector<Tuning> all(4, default_tuning(info));
    all[0].shade_rows = 4;
    all[0].cull_chunks = 3;
    all[1].shade_rows = 4;
    all[1].shade_stage = 16;
    all[2].shade_rows = 16;
    all[2].shade_stage = 16;
    all[3].shade_rows = 8;
    all[3].shade_stage = 16;
    all[3].pbr_lanes = 2;
    return all;
}

// The tolerance between two lane widths where a GPU's compiler is free in divisions and square
// roots (2.5 and 3 ulp, OpenCL C 7.4): that between devices. On PoCL they are exact, and so are the
// bits.
bool same_for_lanes(const Gpu& gpu, const std::vector<float>& a, const std::vector<float>& b) {
    if (gpu.info.is_cpu) return same_bits(a, b);
    constexpr float kGate = 1e-5f;
    const auto close = [](float x, float y) {
        return std::abs(x - y) <= kGate * std::max(1.0f, std::abs(y));
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), close);
}

TEST(Shade, LaneWidthsAndTuningsGiveTheSameBitsAndLists) {
    const FrameInput in = usual_input(SHADING_PBR, 2000);
    const Frame expected = shade_frame(test_gpu(), in, default_tuning(test_gpu().info));
    for (const int lanes : lane_widths()) {
        const Gpu gpu = test_gpu(lanes);
        const Frame frame = shade_frame(gpu, in, default_tuning(gpu.info));
        EXPECT_TRUE(same_for_lanes(gpu, frame.listed, expected.listed)) << lanes << " lanes";
        EXPECT_TRUE(same_bits(frame.all, frame.listed)) << lanes << " lanes, all lights";
        EXPECT_TRUE(frame.lists == expected.lists) << lanes << " lanes";
    }
    const Gpu gpu = test_gpu(4);  // 16 lanes stage no lights
    int index = 0;
    for (const Tuning& tuning : shade_tunings(gpu.info)) {
        const Frame frame = shade_frame(gpu, in, tuning);
        EXPECT_TRUE(same_for_lanes(gpu, frame.listed, expected.listed)) << "tuning " << index;
        EXPECT_TRUE(same_bits(frame.all, frame.listed)) << "tuning " << index << ", all lights";
        ++index;
    }
}

TEST(Shade, GridDimensionsAndLightsOutOfReachChangeNoBit) {
    const Gpu gpu = test_gpu();
    FrameInput in = usual_input(SHADING_PBR, 1000);
    const Frame expected = shade_frame(gpu, in, default_tuning(gpu.info));
    for (const GridRequest& request :
         {GridRequest{1, 1, 1, 0.1f, 0.1f, 0.0f}, GridRequest{64, 64, 64, 0.01f, 1e4f, 0.0f},
          GridRequest{3, 5, 2, 5.0f, 9.0f, 0.0f}}) {
        in.request = request;
        EXPECT_TRUE(
            same_bits(shade_frame(gpu, in, default_tuning(gpu.info)).listed, expected.listed));
    }
    for (int i = 0; i < 300; ++i) {
        in.lights.push_back(i % 2 == 0 ? point_light({0, 0, 0}, 100.0, {0, 0, 0})
                                       : point_light({1e6, 0, 0}, 10.0));
    }
    EXPECT_TRUE(same_bits(shade_frame(gpu, in, default_tuning(gpu.info)).listed, expected.listed));
}

}  // namespace
}  // namespace kilolux
