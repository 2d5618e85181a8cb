// SPDX-License-Identifier: Apache-2.0
// The ids pass and resolve_surfaces against float64 rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/gltf/load_scene.h"
#include "host/stages/surfaces/decode_gbuffer.h"
#include "host/surfaces/surface_scene.h"
#include "raster/gl_context.h"
#include "raster/solid_pass.h"
#include "tests/support/paths.h"
#include "tests/support/quad_scene.h"
#include "tests/support/render_fixture.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

class Resolving {
 public:
    Resolving(const Scene& scene, uint layout = GBUFFER_FULL)
        : scene_(scene), gpu_scene_(scene, 1, GpuSceneUse::covered), ids_(gpu_scene_) {
        needs_.layout = layout;
        needs_.material = needs_.occlusion = needs_.gloss = true;
        features_.gbuffer = layout;
        features_.material = features_.occlusion = features_.metallic = true;
    }

    SurfaceSamples at(const Camera& camera, int width, int height) {
        const Gpu& gpu = test_gpu();
        const Tuning tuning = default_tuning(gpu.info);
        const View view = view_of(camera, width, height);
        ids_.draw(camera, width, height);
        const std::size_t count = std::size_t{view.stride} * view.height;
        std::vector<uint> ids(count);
        read_plane(ids_.targets(), ids_.targets().reads().front(), view.stride, ids.data());
        GrowingArray<uint> device_ids(gpu, "test");
        upload<uint>(gpu, device_ids.reserve(count), ids);
        const SurfaceFeatures surfaces = surface_features(scene_, needs_, 1);
        SurfaceScene scene(gpu, tuning, scene_, surfaces);
        ResolveSurfaces resolve(gpu, tuning, features_, surfaces);
        DecodeGBuffer decode(gpu, tuning, features_);
        StageTimer timer;
        const GBuffer gbuffer =
            resolve.enqueue(device_ids.get(), scene.at(ids_.draws()),
                            make_gbuffer_layout(needs_, view.stride, view.height), view, timer);
        DecodedSurfaces decoded;
        decoded.view = view;
        decoded.planes = download<float>(gpu, decode.enqueue(gbuffer, timer),
                                         std::size_t{SURFACE_PLANES} * count);
        SurfaceSamples out = surface_samples(decoded);
        name_triangles(ids, view, out);
        return out;
    }

 private:
    void name_triangles(const std::vector<uint>& ids, const View& view, SurfaceSamples& out) const {
        for (int y = 0; y < out.height; ++y) {
            for (int x = 0; x < out.width; ++x) {
                const uint id =
                    ids[static_cast<std::size_t>(y) * view.stride + static_cast<std::size_t>(x)];
                if (id == 0) continue;
                for (const Draw& draw : ids_.draws()) {
                    if (draw.row.first_triangle > id - 1) break;
                    out.at(x, y).instance = static_cast<std::uint32_t>(draw.instance);
                    out.at(x, y).triangle = id - 1 - draw.row.first_triangle;
                }
            }
        }
    }

    const Scene& scene_;
    GpuScene gpu_scene_;
    IdsPass ids_;
    GBufferNeeds needs_;
    KernelFeatures features_;
};

bool same_triangle(const SurfaceSample& a, const SurfaceSample& b) {
    return a.kind == b.kind && (a.kind == SurfaceKind::background ||
                                (a.instance == b.instance && a.triangle == b.triangle));
}

// Whether the 3x3 pixels about (x, y) show one triangle, the same in both.
bool is_interior(const SurfaceSamples& a, const SurfaceSamples& b, int x, int y) {
    if (x < 1 || y < 1 || x + 1 >= a.width || y + 1 >= a.height) return false;
    if (b.at(x, y).kind == SurfaceKind::background) return false;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            if (!same_triangle(a.at(x + dx, y + dy), b.at(x, y))) return false;
            if (!same_triangle(b.at(x + dx, y + dy), b.at(x, y))) return false;
        }
    }
    return true;
}

// Largest errors of a picture's interior pixels.
struct Errors {
    std::vector<double> depth, normal, albedo, roughness;
};

Errors interior_errors(const SurfaceSamples& resolved, const SurfaceSamples& cast) {
    Errors out;
    for (int y = 0; y < cast.height; ++y) {
        for (int x = 0; x < cast.width; ++x) {
            if (!is_interior(resolved, cast, x, y)) continue;
            const SurfaceSample& a = resolved.at(x, y);
            const SurfaceSample& b = cast.at(x, y);
            out.depth.push_back(std::abs(a.position.z / b.position.z - 1.0));
            out.normal.push_back(glm::length(a.normal - b.normal));
            out.albedo.push_back(glm::length(a.albedo - b.albedo));
            out.roughness.push_back(std::abs(a.roughness - b.roughness));
        }
    }
    return out;
}

double largest(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

class ResolvedSurfaces : public testing::Test {
 protected:
    static void SetUpTestSuite() { context_.emplace(GlContext::headless()); }
    static void TearDownTestSuite() { context_.reset(); }
    static std::optional<GlContext> context_;
};
std::optional<GlContext> ResolvedSurfaces::context_;

// Largest interior errors: of depth relative; of the rest absolute, where texels are rounded to 16
// bits a channel.
void expect_interior_like_rays(const Scene& scene, const Camera& camera, std::size_t at_least) {
    const SurfaceSamples cast = RayCaster(scene).cast(camera, 320, 180);
    Resolving resolving(scene);
    const Errors errors = interior_errors(resolving.at(camera, 320, 180), cast);
    ASSERT_GT(errors.depth.size(), at_least);
    EXPECT_LT(largest(errors.depth), 1e-5);
    EXPECT_LT(largest(errors.normal), 1e-4);
    EXPECT_LT(largest(errors.albedo), 8e-5);
    EXPECT_LT(largest(errors.roughness), 4e-5);
}

TEST_F(ResolvedSurfaces, AtriumsInteriorIsThatOfTheRays) {
    const Scene scene = make_generated_scene("atrium");
    expect_interior_like_rays(scene, first_camera(scene), 4000);
}

TEST_F(ResolvedSurfaces, SponzasInteriorIsThatOfTheRays) {
    const auto file =
        std::filesystem::path(source_root()) / ".." / "shared/scenes/sponza/Sponza.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_scene(file);
    expect_interior_like_rays(scene, look_at({-7, 2, 0}, {0, 2, 0}, {0, 1, 0}, glm::radians(45.0)),
                              2000);
}

// A textured quad, mirrored and turned, seen from both sides and by parallel rays.
TEST_F(ResolvedSurfaces, MirrorsBackFacesAndParallelRays) {
    Scene scene = quad_scene();
    scene.materials[0].double_sided = true;
    glm::dmat4& m = scene.instances[0].world_from_object;
    m[0] = glm::dvec4(-1.5, 0.2, 0.1, 0.0);
    m[1] = glm::dvec4(0.1, 0.8, -0.2, 0.0);
    for (const double side : {1.0, -1.0}) {
        Camera camera = look_at({0.3, 0.4, 4.0 * side}, {0, 0, 0}, {0, 1, 0}, 0.4);
        expect_interior_like_rays(scene, camera, 1000);
        camera.orthographic = true;
        camera.y_extent = 0.7;
        camera.z_far = 20.0;
        expect_interior_like_rays(scene, camera, 1000);
    }
}

// A pixel shows the triangle of a ray within 1/128 of a pixel of its centre: OpenGL snaps vertices
// to 1/256.
TEST_F(ResolvedSurfaces, IdsAreThoseOfRaysUpToOpenGLsSnapping) {
    const Scene scene = make_generated_scene("atrium");
    Camera camera = first_camera(scene);
    constexpr int kWidth = 320, kHeight = 180;
    const RayCaster caster(scene);
    Resolving resolving(scene);
    const SurfaceSamples drawn = resolving.at(camera, kWidth, kHeight);
    std::vector<SurfaceSamples> rays;
    for (const glm::dvec2 offset : {glm::dvec2(0), glm::dvec2(1, 0), glm::dvec2(-1, 0),
                                    glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
        camera.jitter = offset / 128.0;
        rays.push_back(caster.cast(camera, kWidth, kHeight));
    }
    int differing = 0, unexplained = 0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
        const auto agrees = [&](const SurfaceSamples& r) {
            return same_triangle(drawn.pixels[i], r.pixels[i]);
        };
        if (!agrees(rays.front())) ++differing;
        if (std::ranges::none_of(rays, agrees)) ++unexplained;
    }
    EXPECT_LT(differing, kWidth * kHeight / 50);
    // Alpha masks are sampled by OpenGL: leaves' outlines differ.
    EXPECT_LT(unexplained, kWidth * kHeight / 100) << differing;
}

}  // namespace
}  // namespace kilolux
