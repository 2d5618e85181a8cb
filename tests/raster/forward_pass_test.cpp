// SPDX-License-Identifier: Apache-2.0
#include "raster/forward_pass.h"

#include <algorithm>
#include <random>

#include "host/base/error.h"
#include "raster/forward_lights.h"
#include "tests/raster/gl_fixture.h"

// The host's evaluate(), for what the fragments should be.
#define SHADING 2
#define HAS_SPOT_LIGHTS 1
#define HAS_METALLIC 1
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // of features that are left out
#include "kernels/shared/evaluate.h"
#pragma GCC diagnostic pop

namespace kilolux {
namespace {

using ForwardPassTest = GlTest;

constexpr int kForwardWidth = 75;
constexpr int kForwardHeight = 41;
constexpr uint kForwardStride = 80;

// Relative to the sum of what the lights could add: float32 sums in another order of rounding, and
// divisions that a GPU may round otherwise.
constexpr double kForwardTolerance = 1e-5;

// A wall, metallic panels in front of it, and a fence with holes.
Scene boxes_scene() {
    Scene scene = one_object(quad_mesh(6.0f));
    scene.materials[0].roughness = 0.7f;
    scene.materials[0].metallic = 0.0f;
    scene.materials[0].base_color = {0.6f, 0.7f, 0.3f, 1};
    Material shiny;
    shiny.roughness = 0.25f;
    shiny.metallic = 0.75f;
    shiny.base_color = {0.9f, 0.5f, 0.2f, 1};
    shiny.emissive = {0.25f, 0, 0.5f};
    scene.materials.push_back(shiny);
    scene.meshes.push_back(quad_mesh(0.8f));
    scene.meshes[1].material = 1;
    for (int i = 0; i < 5; ++i) {
        const double angle = 0.3 * (i - 2);
        glm::dmat4 world(glm::dmat3(std::cos(angle), 0, -std::sin(angle), 0, 1, 0, std::sin(angle),
                                    0, std::cos(angle)));
        world[3] = glm::dvec4(1.5 * (i - 2), 0.4 * i - 1, 0.7 * i, 1);
        scene.instances.push_back({1, world});
    }
    // A fence in front of all, half of it cut away.
    Material fence;
    fence.alpha_mode = AlphaMode::mask;
    fence.base_color_texture = add_texture(scene, 2, 1, {255, 255, 255, 0, 200, 200, 200, 255});
    fence.base_color_texture.uv_from_texcoord[0].x = 4.0f;
    fence.double_sided = true;
    scene.materials.push_back(fence);
    scene.meshes.push_back(quad_mesh(1.5f));
    scene.meshes[2].material = 2;
    scene.instances.push_back({2, translation({0.5, 0.5, 3.5})});
    return scene;
}

Camera boxes_camera() { return look_at({1, 1.5, 6}, {0, 0, 0}, {0, 1, 0}, glm::radians(60.0)); }

struct Lights {
    std::vector<Light> local;
    std::vector<DirectionalLight> directional;

    ForwardLights all() const {
        ForwardLights lights;
        lights.lights = local;
        lights.directional = directional;
        lights.ambient = 0.02f;
        return lights;
    }
};

Lights some_lights(int count) {
    std::mt19937 random(21);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Lights out;
    for (int i = 0; i < count; ++i) {
        Light light{};
        light.position_range = {12 * unit(random) - 7, 6 * unit(random) - 5, 5 * unit(random) - 6,
                                0.8f + 1.7f * unit(random)};
        light.color_scale = {unit(random), unit(random), unit(random), 0.0f};
        light.axis_cos = {0, 0, 0, -1};
        light.color_scale.w = 1.0f;  // a point light: cone 1 all round
        if (i % 3 == 0) {
            light.axis_cos = {0, 0.6f, -0.8f, 0.5f};
            light.color_scale.w = 1.0f / (0.9f - 0.5f);
        }
        out.local.push_back(light);
    }
    out.directional.push_back({{0.6f, 0.0f, 0.8f, 0}, {0.3f, 0.2f, 0.1f, 0}});
    return out;
}

ForwardFeatures all_features() {
    ForwardFeatures features;
    features.shading = SHADING_PBR;
    features.spot_lights = true;
    features.directional_lights = true;
    features.metallic = true;
    return features;
}

std::vector<float> draw(const Scene& scene, const ForwardFeatures& features,
                        const ForwardLights& lights) {
    const GpuScene gpu(scene);
    ForwardPass pass(gpu, features);
    pass.draw(boxes_camera(), kForwardWidth, kForwardHeight, lights);
    return pass.read_radiance(kForwardStride);
}

HostGBuffer full_gbuffer(const Scene& scene) {
    return draw_gbuffer(scene, boxes_camera(), kForwardWidth, kForwardHeight,
                        make_needs(GBUFFER_FULL));
}

FV3 to_fv3(const glm::dvec3& v) {
    return fv3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

Surface surface_at(const HostGBuffer& g, const View& view, int x, int y, float depth) {
    const auto px = static_cast<float>(x) + 0.5f;
    const auto py = static_cast<float>(y) + 0.5f;
    Surface s;
    s.position = view_position(view, px, py, view_depth(view, px, py, depth));
    s.normal = to_fv3(g.vector(PLANE_NORMAL_X, x, y));
    s.albedo = to_fv3(g.vector(PLANE_ALBEDO_R, x, y));
    s.emissive = to_fv3(g.vector(PLANE_EMISSIVE_R, x, y));
    s.roughness = g.at<float>(PLANE_ROUGHNESS, x, y);
    s.metallic = g.at<float>(PLANE_METALLIC, x, y);
    s.occlusion = g.at<float>(PLANE_OCCLUSION_F, x, y);
    return s;
}

FV3 shade_on_host(const Surface& s, const View& view, const Lights& lights) {
    const ShadingPoint p = make_shading_point(s, false);
    LightSum sum = zero_sum();
    for (DirectionalLight light : lights.directional) {
        Light turned{};
        turned.position_range = light.to_light;
        turned.position_range.w = 1;
        light.to_light = shade_light(view, turned, 0u, 0u).position_inv_range2;
        sum = evaluate_directional(sum, p, light);
    }
    for (const Light& light : lights.local)
        sum = evaluate(sum, p, shade_light(view, light, 0u, 0u));
    return finish_shading(s, p, sum, 0.02f);
}

TEST_F(ForwardPassTest, ShadesAsTheHostDoes) {
    const Scene scene = boxes_scene();
    const Lights lights = some_lights(200);
    const View view = view_of(boxes_camera(), kForwardWidth, kForwardHeight);
    const HostGBuffer g = full_gbuffer(scene);
    const std::vector<float> radiance = draw(scene, all_features(), lights.all());
    double brightest = 0;
    for (int y = 0; y < kForwardHeight; ++y) {
        for (int x = 0; x < kForwardWidth; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(y) * kForwardStride + static_cast<std::size_t>(x);
            const float depth = g.depth(x, y);
            const auto shaded = [&](float at) {
                const FV3 out = at > 0 ? shade_on_host(surface_at(g, view, x, y, at), view, lights)
                                       : fv3(0, 0, 0);
                return glm::dvec3(out.x, out.y, out.z);
            };
            const glm::dvec3 wanted = shaded(depth);
            // Fragments are on the triangle's plane; the stored depth is rounded.
            const glm::dvec3 rounding = glm::abs(shaded(std::nextafter(depth, 2.0f)) - wanted);
            brightest = std::max(brightest, wanted.x);
            for (int c = 0; c < 3; ++c) {
                const double got =
                    radiance[pixel + static_cast<std::size_t>(c) * kForwardStride * kForwardHeight];
                ASSERT_NEAR(
                    got, wanted[c],
                    kForwardTolerance * std::max(wanted[c], 1.0) + (depth > 0 ? rounding[c] : 0.0))
                    << x << "," << y << " channel " << c;
            }
        }
    }
    EXPECT_GT(brightest, 0.3) << "the lights light something";
}

// Lists that hold only the lights that reach some pixel of the cluster: a fragment that looks into
// another cluster's list misses some of its lights.
struct ClusterLists {
    ClusterGrid grid{};
    std::vector<uint> offsets, lists;
};

ClusterLists exact_lists(const Scene& scene, const Lights& lights) {
    ClusterLists out;
    out.grid.tiles_x = 5;
    out.grid.tiles_y = 3;
    out.grid.tile_width = out.grid.tile_height = 16;
    out.grid.slices = 12;
    out.grid.slices_per_octave = 4;
    out.grid.z_first_bits = float_bits(2.0f);
    out.grid.cluster_count = 5 * 3 * 12;
    std::vector<std::vector<bool>> reached(out.grid.cluster_count,
                                           std::vector<bool>(lights.local.size(), false));
    const View view = view_of(boxes_camera(), kForwardWidth, kForwardHeight);
    const HostGBuffer g = full_gbuffer(scene);
    for (int y = 0; y < kForwardHeight; ++y) {
        for (int x = 0; x < kForwardWidth; ++x) {
            if (g.depth(x, y) == 0) continue;
            const FV3 p = surface_at(g, view, x, y, g.depth(x, y)).position;
            const uint cluster =
                cluster_index(out.grid, static_cast<uint>(x) / 16, static_cast<uint>(y) / 16,
                              slice_of_depth(out.grid, -p.z));
            for (std::size_t i = 0; i < lights.local.size(); ++i) {
                const float4 l = shade_light(view, lights.local[i], 0u, 0u).position_inv_range2;
                const FV3 v = fv3(l.x - p.x, l.y - p.y, l.z - p.z);
                if (dot3(v, v) * l.w < 1.001f) reached[cluster][i] = true;
            }
        }
    }
    for (const std::vector<bool>& cluster : reached) {
        out.offsets.push_back(static_cast<uint>(out.lists.size()));
        for (std::size_t i = 0; i < cluster.size(); ++i) {
            if (cluster[i]) out.lists.push_back(static_cast<uint>(i));
        }
    }
    out.offsets.push_back(static_cast<uint>(out.lists.size()));
    return out;
}

TEST_F(ForwardPassTest, ForwardPlusIsForwardBitForBitHoweverItReadsLights) {
    const Scene scene = boxes_scene();
    const Lights lights = some_lights(300);
    const ClusterLists clusters = exact_lists(scene, lights);
    EXPECT_LT(clusters.lists.size(), std::size_t{clusters.grid.cluster_count} * 100);
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        ForwardFeatures features = all_features();
        features.shading = shading;
        features.light_access = LightAccess::storage;
        const std::vector<float> forward = draw(scene, features, lights.all());
        ForwardLights listed = lights.all();
        listed.grid = clusters.grid;
        listed.cluster_offsets = clusters.offsets;
        listed.light_lists = clusters.lists;
        for (const LightAccess access : {LightAccess::storage, LightAccess::texture}) {
            SCOPED_TRACE("shading " + std::to_string(shading) + ", access " +
                         std::to_string(static_cast<int>(access)));
            features.light_access = access;
            features.clustered = false;
            EXPECT_EQ(draw(scene, features, lights.all()), forward);
            features.clustered = true;
            EXPECT_EQ(draw(scene, features, listed), forward);
        }
        EXPECT_TRUE(std::all_of(forward.begin(), forward.end(),
                                [](float v) { return v >= 0 && v < 1e3f; }));
        EXPECT_TRUE(std::any_of(forward.begin(), forward.end(), [](float v) { return v > 0.1f; }));
    }
}

TEST_F(ForwardPassTest, NoLightsLeaveEmissionAndAmbient) {
    Scene scene = one_object(quad_mesh(100.0f));
    scene.materials[0].emissive = {0.5f, 0.25f, 4.0f};
    scene.materials[0].base_color = {1, 0.5f, 0.25f, 1};
    ForwardLights lights;
    lights.ambient = 0.5f;
    const std::vector<float> radiance = draw(scene, ForwardFeatures{}, lights);
    const std::size_t plane = std::size_t{kForwardStride} * kForwardHeight;
    EXPECT_EQ(radiance[0], 1.0f);
    EXPECT_EQ(radiance[plane], 0.5f);
    EXPECT_EQ(radiance[2 * plane], 4.125f);
    EXPECT_EQ(radiance[kForwardWidth], 0.0f) << "past the width";
}

using LightArrayTest = GlTest;

TEST_F(LightArrayTest, RefusesMoreTexelsThanATextureHolds) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    ASSERT_GT(most, 0);
    LightArray array(GL_R32UI, sizeof(uint), "light lists");
    // Not memory: what is refused is not read.
    const std::byte* nothing = nullptr;
    const std::span<const std::byte> too_many(nothing,
                                              sizeof(uint) * (static_cast<std::size_t>(most) + 1));
    std::string message;
    try {
        array.refill(too_many, LightAccess::texture);
    } catch (const Error& error) {
        message = error.what();
    }
    EXPECT_EQ(message, "forward renderer: light lists need " +
                           std::to_string(most + std::int64_t{1}) +
                           " texels of a buffer texture; OpenGL has at most " +
                           std::to_string(most) + " here");
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

}  // namespace
}  // namespace kilolux
