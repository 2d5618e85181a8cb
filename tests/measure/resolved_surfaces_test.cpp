// SPDX-License-Identifier: Apache-2.0
// The ids pass and resolve_surfaces against float64 rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "host/scene/generated/scenes.h"
#include "host/stages/decode_gbuffer.h"
#include "host/surfaces/surface_scene.h"
#include "raster/gl_context.h"
#include "raster/ids_pass.h"
#include "tests/support/quad_scene.h"
#include "tests/support/render_fixture.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Resolved {
    SurfaceSamples samples;  // decoded; with the instance and triangle of the ids
};

class Resolving {
 public:
    Resolving(const Scene& scene, uint layout = GBUFFER_FULL)
        : scene_(scene), gpu_scene_(scene, 0.0f, GpuSceneUse::covered), ids_(gpu_scene_) {
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
                                         std::size_t{decode.plane_count()} * count);
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

TEST_F(ResolvedSurfaces, AtriumsInteriorIsThatOfTheRays) {
    const Scene scene = make_generated_scene("atrium");
    const Camera camera = first_camera(scene);
    const SurfaceSamples cast = RayCaster(scene).cast(camera, 320, 180);
    Resolving resolving(scene);
    const Errors errors = interior_errors(resolving.at(camera, 320, 180), cast);
    ASSERT_GT(errors.depth.size(), 4000u);
    for (const auto* e : {&errors.depth, &errors.normal, &errors.albedo, &errors.roughness}) {
        printf("%g %g %g\n", quantile(*e, 0.5), quantile(*e, 0.99), largest(*e));
    }
}

}  // namespace
}  // namespace kilolux
