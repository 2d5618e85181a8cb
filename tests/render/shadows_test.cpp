// SPDX-License-Identifier: Apache-2.0
// Exact shadows: against rays in double, and the same bits in every form.
#include <gtest/gtest.h>

#include "host/base/error.h"
#include "host/certify/shadow_scenarios.h"
#include "host/measure/bench/lighting_bench.h"
#include "host/measure/reference/shadow_caster.h"
#include "tests/support/full.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

RenderSettings shadow_settings(int width = 96, int height = 54, std::uint64_t lights = 0) {
    RenderSettings settings = small_settings(width, height, lights);
    settings.shadows = Shadows::exact;
    settings.ambient = 0.0f;
    return settings;
}

ShadowAgreement compare(const ShadowScenario& scenario, Geometry geometry) {
    RenderSettings settings = shadow_settings(160, 90);
    settings.geometry = geometry;
    return compare_shadows(scenario, settings);
}

void expect_like_rays_in_double(const ShadowScenario& scenario, double least_hidden) {
    for (const Geometry geometry : {Geometry::ids, Geometry::compute}) {
        SCOPED_TRACE(scenario.name);
        const ShadowAgreement found = compare(scenario, geometry);
        EXPECT_GT(found.pixels, 1000);
        EXPECT_GE(found.hidden, least_hidden * found.pixels);
        EXPECT_EQ(found.unfounded, 0);
        EXPECT_LE(found.differ, found.pixels / 200);
    }
}

// Exactly representable, so that only the sums with it round.
const glm::dvec3 kFar(0x1p20, -0x1p20, 0x1p20);

TEST(Shadows, OfARowOfColumnsAreThoseOfRaysInDouble) {
    expect_like_rays_in_double(columns_scenario(), 0.05);
    expect_like_rays_in_double(moved(columns_scenario(), kFar), 0.05);
}

TEST(Shadows, NoLightComesThroughAWallOfAMillimetre) {
    expect_like_rays_in_double(thin_wall_scenario(), 0.5);
    expect_like_rays_in_double(moved(thin_wall_scenario(), kFar), 0.5);
}

TEST(Shadows, AFloorUnderAGrazingLightHidesNothing) {
    expect_like_rays_in_double(grazing_scenario(), 0.0);
    expect_like_rays_in_double(moved(grazing_scenario(), kFar), 0.0);
}

TEST(Shadows, OfRoundBodiesAreThoseOfRaysInDouble) {
    expect_like_rays_in_double(spheres_scenario(), 0.05);
}

TEST(Shadows, ASheetSeesNoLightBehindIt) { expect_like_rays_in_double(sheet_scenario(), 1.0); }

// Stored positions err by millimetres; rays still end on the triangles.
TEST(Shadows, AreThoseOfTheTrianglesWhateverTheGBufferStores) {
    // Moved to where half floats round the floor downwards.
    const ShadowScenario scenario = moved(columns_scenario(), {0.1234, 1.3372, 0.271});
    RenderSettings settings = shadow_settings(160, 90);
    settings.want.aovs = {"visibility"};
    const auto visibility = [&](uint layout) {
        settings.gbuffer = layout;
        return Renderer(scenario.scene, settings).render(scenario.camera, 0.0).aovs.front().values;
    };
    const std::vector<float> exact = visibility(GBUFFER_PACKED);
    const std::vector<float> stray = visibility(GBUFFER_HALF);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) differ += exact[i] != stray[i] ? 1 : 0;
    EXPECT_LE(differ, exact.size() / 50);
}

TEST(Shadows, AreTheSameBitsWithEveryLight) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = shadow_settings(96, 54, 300);
    settings.samples = 2;
    const Frame listed = render_once(scene, settings);
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(render_once(scene, settings).radiance, listed.radiance);
    settings.renderer = RendererKind::deferred;
    settings.shadows = Shadows::off;
    EXPECT_NE(render_once(scene, settings).radiance, listed.radiance);
}

// The tolerance of an edge that points at the light is wide; all walks must find the same part of
// it.
TEST(Shadows, OfEdgesThatPointAtTheLightAreTheSameBitsWithEveryLight) {
    const ShadowScenario scenario = needles_scenario();
    RenderSettings settings = shadow_settings(480, 270);
    const Frame listed = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(Renderer(scenario.scene, settings).render(scenario.camera, 0.0).radiance,
              listed.radiance);
    EXPECT_EQ(compare(scenario, Geometry::ids).unfounded, 0);
}

TEST(Shadows, AreTheSameBitsInBandsAndInAnotherGrid) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = shadow_settings(96, 64, 300);
    settings.want.aovs = {"visibility"};
    const Frame whole = render_once(scene, settings);
    settings.band_rows = 16;
    const Frame banded = render_once(scene, settings);
    EXPECT_EQ(banded.radiance, whole.radiance);
    EXPECT_EQ(banded.aovs.front().values, whole.aovs.front().values);
    settings.band_rows = 0;
    settings.grid = {5, 3, 2, 2};
    EXPECT_EQ(render_once(scene, settings).radiance, whole.radiance);
}

TEST(Shadows, AreTheSameBitsForEveryLaunch) {
    const Scene scene = grid_with_every_light();
    const RenderSettings settings = shadow_settings(96, 54, 200);
    LightingBench bench(scene, settings, first_camera(scene));
    LightingRequest request = bench.request();
    request.runs = 1;
    request.tuning.tuning.shadow_group = 1;
    const std::uint64_t picture = bench.run(request).picture;
    for (const int group : {0, 32, 64, 256}) {
        request.tuning.tuning.shadow_group = group;
        EXPECT_EQ(bench.run(request).picture, picture) << group << " work-items";
    }
    request.tuning.tuning.shadow_group = 1;
    for (const int lanes : lane_widths()) {
        request.tuning.lanes = lanes;
        request.tuning.tuning.shade_rows = 1;
        EXPECT_EQ(bench.run(request).picture, picture) << lanes << " lanes";
    }
}

// A lamp over a floor with a board between them, of which alpha cuts two opposite quarters away.
ShadowScenario masked_scenario() {
    Scene scene = shadow_stage();
    add_box(scene, {12.0, 0.5, 12.0}, {0.0, -0.25, 0.0});
    Material leaf = scene.materials.front();
    leaf.alpha_mode = AlphaMode::mask;
    leaf.alpha_cutoff = 0.5f;
    Image image;
    image.width = image.height = 2;
    image.rgba = {200, 200, 200, 255, 200, 200, 200, 0, 200, 200, 200, 0, 200, 200, 200, 255};
    scene.images.push_back(image);
    scene.textures.push_back({0, {}});
    scene.textures.front().sampler.magnify = Filter::nearest;
    leaf.base_color_texture.texture = 0;
    scene.materials.push_back(leaf);
    Mesh board;
    board.positions = {{-2, 2, -2}, {2, 2, -2}, {2, 2, 2}, {-2, 2, 2}};
    board.normals.assign(4, {0, 1, 0});
    board.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    board.indices = {0, 2, 1, 0, 3, 2};
    board.material = 1;
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::dmat4(1.0)});
    scene.meshes.push_back(board);
    scene.lights.push_back(lamp({0.0, 4.0, 0.0}));
    return {"masked", scene, look_at({0.0, 3.0, 9.0}, {0.0, 0.0, 1.0}, {0, 1, 0}, 0.9)};
}

TEST(Shadows, AlphaCutsThem) {
    expect_like_rays_in_double(masked_scenario(), 0.05);
    // Without the mask twice as much is hidden.
    ShadowScenario whole = masked_scenario();
    whole.scene.materials[1].alpha_mode = AlphaMode::opaque;
    const int cut = compare(masked_scenario(), Geometry::ids).hidden;
    EXPECT_GT(compare(whole, Geometry::ids).hidden, cut + cut / 2);
}

TEST(Shadows, FollowWhatMoves) {
    ShadowScenario scenario = columns_scenario();
    const RenderSettings settings = shadow_settings();
    Renderer renderer(scenario.scene, settings);
    const Frame before = renderer.render(scenario.camera, 0.0);
    scenario.scene.instances[3].world_from_object[3].x += 1.5;
    ++scenario.scene.revisions.placement;
    const Frame after = renderer.render(scenario.camera, 0.0);
    EXPECT_NE(after.radiance, before.radiance);
    EXPECT_EQ(after.radiance,
              Renderer(scenario.scene, settings).render(scenario.camera, 0.0).radiance);
}

bool casts_rays(const Frame& frame) {
    return std::ranges::any_of(frame.stats.stages, [](const StageTime& stage) {
        return stage.name == "cast_shadows" || stage.name == "draw_shadows";
    });
}

// Three lamps, so that sampled shadows draw some of them.
ShadowScenario lamps_scenario() {
    ShadowScenario out = masked_scenario();
    out.scene.lights.push_back(lamp({2.0, 3.5, 1.0}));
    out.scene.lights.push_back(lamp({-2.5, 4.5, 0.5}));
    return out;
}

// For one renderer: a frame after a change casts rays and equals that of a new renderer; the next
// one casts none and is equal.
class KeptShadows {
 public:
    explicit KeptShadows(const RenderSettings& settings)
        : settings_(settings), renderer_(scenario_.scene, settings) {
        expect_cast_once("the first frame");
    }

    template <typename Change>
    void expect_cast_after(const char* what, const Change& change) {
        change(scenario_);
        expect_cast_once(what);
    }

    void expect_cast_with(const char* what, void (*change)(RenderSettings&)) {
        change(settings_);
        renderer_.change(settings_);
        expect_cast_once(what);
    }

 private:
    void expect_cast_once(const char* what) {
        const Frame moved = renderer_.render(scenario_.camera, 0.0);
        EXPECT_TRUE(casts_rays(moved)) << what;
        EXPECT_EQ(moved.radiance,
                  Renderer(scenario_.scene, settings_).render(scenario_.camera, 0.0).radiance)
            << what;
        EXPECT_NE(moved.radiance, last_) << what << " changes nothing";
        const Frame still = renderer_.render(scenario_.camera, 0.0);
        EXPECT_FALSE(casts_rays(still)) << "after " << what;
        EXPECT_EQ(still.radiance, moved.radiance) << what;
        last_ = still.radiance;
    }

    ShadowScenario scenario_ = lamps_scenario();
    RenderSettings settings_;
    Renderer renderer_;
    std::vector<float> last_;
};

void expect_kept_until_something_moves(const RenderSettings& settings) {
    KeptShadows kept(settings);
    kept.expect_cast_after("a light that moves", [](ShadowScenario& s) {
        s.scene.lights[0].position.x += 0.7;
        ++s.scene.revisions.lights;
    });
    kept.expect_cast_after("a camera that moves",
                           [](ShadowScenario& s) { s.camera.position.x += 0.1; });
    kept.expect_cast_after("an instance that moves", [](ShadowScenario& s) {
        s.scene.instances.back().world_from_object[3].x += 0.5;
        ++s.scene.revisions.placement;
    });
    kept.expect_cast_after("a mesh that changes", [](ShadowScenario& s) {
        for (glm::vec3& p : s.scene.meshes.back().positions) p.x += 0.4f;
        ++s.scene.meshes.back().revision;
        ++s.scene.revisions.geometry;
    });
}

TEST(Shadows, AreKeptWhileNothingMoves) { expect_kept_until_something_moves(shadow_settings()); }

TEST(Shadows, ThatAreDrawnInBandsOrWithoutReuseAreCastEachTime) {
    const ShadowScenario scenario = masked_scenario();
    RenderSettings settings = shadow_settings(96, 64);
    for (const bool bands : {true, false}) {
        settings.band_rows = bands ? 16 : 0;
        settings.no_reuse = !bands;
        Renderer renderer(scenario.scene, settings);
        const Frame first = renderer.render(scenario.camera, 0.0);
        const Frame second = renderer.render(scenario.camera, 0.0);
        EXPECT_TRUE(casts_rays(second)) << bands;
        EXPECT_EQ(second.radiance, first.radiance) << bands;
    }
}

TEST(Shadows, ThatAreOffLeaveNothingInTheFrame) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings();
    const Frame frame = render_once(scene, settings);
    for (const StageTime& stage : frame.stats.stages) {
        EXPECT_EQ(stage.name.find("shadow"), std::string::npos) << stage.name;
    }
    EXPECT_FALSE(make_scene_plan(scene, settings, 300).kernels.shadows);
    settings.shadows = Shadows::exact;
    EXPECT_TRUE(make_scene_plan(scene, settings, 300).kernels.shadows);
}

// The bits of a still frame are counted, too, and counting changes none.
TEST(Shadows, AreCountedOnlyWhereItIsAskedFor) {
    const Scene scene = grid_with_every_light();
    for (const Shadows shadows : {Shadows::exact, Shadows::sampled}) {
        RenderSettings settings = shadow_settings(96, 54, 100);
        settings.shadows = shadows;
        Renderer renderer(scene, settings);
        const Frame plain = renderer.render(first_camera(scene), 0.0);
        EXPECT_EQ(plain.stats.shadows.words, 0u);
        settings.want.shadow_counts = true;
        renderer.change(settings);
        const Frame counted = renderer.render(first_camera(scene), 0.0);
        EXPECT_FALSE(casts_rays(counted));
        EXPECT_EQ(counted.radiance, plain.radiance);
        const ShadowCounts& c = counted.stats.shadows;
        EXPECT_GT(c.shafts, 0u);
        EXPECT_GT(c.rays, c.shafts);
        EXPECT_GT(c.seen, 0u);
        EXPECT_LT(c.seen, c.rays) << "something is hidden";
        EXPECT_EQ(renderer.render(first_camera(scene), 0.0).radiance, plain.radiance);
    }
}

// Against rays in double, light by light, where the light is well within its range.
TEST(Shadows, AProbeSaysWhichLightsAPixelSees) {
    const Scene scene = make_generated_scene("plain");
    const Camera camera = first_camera(scene);
    const ShadowCaster rays(scene, camera);
    Renderer renderer(scene, shadow_settings(96, 54, 40));
    renderer.render(camera, 0.0);
    int seen = 0, hidden = 0, differ = 0;
    for (int y = 2; y < 54; y += 10) {
        for (int x = 3; x < 96; x += 15) {
            const PixelProbe probe = renderer.probe(x, y);
            if (!probe.has_surface()) continue;
            const float* p = &probe.surface[SURFACE_POSITION];
            const auto point = rays.point_at({p[0], p[1], p[2]});
            if (!point) continue;
            for (const ProbedLight& light : probe.lights) {
                ASSERT_TRUE(light.seen.has_value());
                const float4& at = light.shade.position_inv_range2;
                const glm::dvec3 way(at.x - p[0], at.y - p[1], at.z - p[2]);
                if (glm::dot(way, way) * double{at.w} > 0.98) continue;
                (*light.seen ? seen : hidden) += 1;
                differ += *light.seen != rays.sees(*point, {at.x, at.y, at.z}) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(seen, 20);
    EXPECT_GT(hidden, 5);
    EXPECT_LE(differ, (seen + hidden) / 50);
}

RenderSettings sampled_settings(int width, int height, std::uint64_t lights, int rays) {
    RenderSettings settings = shadow_settings(width, height, lights);
    settings.shadows = Shadows::sampled;
    settings.shadow_rays = rays;
    settings.want.aovs = {"error-standard"};
    return settings;
}

TEST(SampledShadows, AreTheSameBitsHoweverTheyAreMade) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = sampled_settings(96, 64, 200, 2);
    const Frame listed = render_once(scene, settings);
    const auto expect_same = [&](const char* what) {
        const Frame frame = render_once(scene, settings);
        EXPECT_EQ(frame.radiance, listed.radiance) << what;
        EXPECT_EQ(frame.aovs.front().values, listed.aovs.front().values) << what;
    };
    settings.band_rows = 16;
    expect_same("bands");
    settings.band_rows = 0;
    settings.grid = {5, 3, 2, 2};
    expect_same("grid");
    settings.grid = {};
    settings.kernels.lanes = 4;
    expect_same("lanes");
    settings.kernels.lanes = 0;
    settings.renderer = RendererKind::deferred_all;
    expect_same("all lights");
    settings.seed = 2;
    EXPECT_NE(render_once(scene, settings).radiance, listed.radiance);
}

TEST(SampledShadows, AreKeptWhileNothingMoves) {
    RenderSettings settings = sampled_settings(96, 54, 0, 1);
    settings.want.aovs.clear();
    expect_kept_until_something_moves(settings);
    KeptShadows kept(settings);
    kept.expect_cast_with("another seed", [](RenderSettings& s) { s.seed = 7; });
    kept.expect_cast_with("more rays", [](RenderSettings& s) { s.shadow_rays = 2; });
    kept.expect_cast_with("ambient light", [](RenderSettings& s) { s.ambient = 0.5f; });
}

TEST(SampledShadows, WhereNothingHidesAreThoseOfNone) {
    const ShadowScenario scenario = grazing_scenario();
    RenderSettings settings = sampled_settings(96, 54, 0, 1);
    const Frame sampled = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    settings.shadows = Shadows::off;
    settings.want.aovs.clear();
    EXPECT_EQ(Renderer(scenario.scene, settings).render(scenario.camera, 0.0).radiance,
              sampled.radiance);
}

// Over many seeds: the mean of each pixel is the exact one within its own error, and estimated
// errors equal the actual ones.
TEST(SampledShadows, AreRightInTheMeanAndTellTheirError) {
    constexpr int kSeeds = 400;
    constexpr std::size_t kPixels = 48 * 27;
    ShadowScenario scenario = columns_scenario();
    for (int i = 0; i < 9; ++i) {
        scenario.scene.lights.push_back(lamp({1.7 * i - 7.0, 1.0 + 0.4 * i, -4.0 + i}));
    }
    RenderSettings settings = sampled_settings(48, 27, 0, 2);
    settings.shadows = Shadows::exact;
    settings.want.aovs.clear();
    const Frame exact = Renderer(scenario.scene, settings).render(scenario.camera, 0.0);
    settings = sampled_settings(48, 27, 0, 2);
    Renderer renderer(scenario.scene, settings);
    std::vector<double> sum(kPixels), squares(kPixels), estimated(kPixels);
    for (int seed = 1; seed <= kSeeds; ++seed) {
        settings.seed = static_cast<uint>(seed);
        renderer.change(settings);
        const Frame frame = renderer.render(scenario.camera, 0.0);
        for (std::size_t i = 0; i < kPixels; ++i) {
            const double off = luminance_of(frame.radiance, i) - luminance_of(exact.radiance, i);
            const double error = frame.aovs.front().values[i];
            sum[i] += off;
            squares[i] += off * off;
            estimated[i] += error * error;
        }
    }
    int noisy = 0, beyond = 0;
    double seen_variance = 0.0, estimated_variance = 0.0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const double mean = sum[i] / kSeeds;
        const double variance = squares[i] / kSeeds - mean * mean;
        if (variance < 1e-12) {
            EXPECT_NEAR(mean, 0.0, 1e-5);
            continue;
        }
        ++noisy;
        beyond += std::abs(mean) > 3.0 * std::sqrt(variance / kSeeds) ? 1 : 0;
        seen_variance += variance;
        estimated_variance += estimated[i] / kSeeds;
    }
    EXPECT_GT(noisy, 100);
    EXPECT_LE(beyond, noisy / 50 + 2);
    EXPECT_NEAR(estimated_variance / seen_variance, 1.0, 0.1);
}

TEST(Shadows, AreRefusedWhereTheyCannotBe) {
    RenderSettings settings = shadow_settings();
    settings.renderer = RendererKind::forward;
    expect_refused(make_generated_scene("plain"), settings, "forward");
    settings = shadow_settings();
    settings.geometry = Geometry::planes;
    expect_refused(make_generated_scene("plain"), settings, "planes");
    settings = small_settings();
    settings.want.view = ViewKind::shadows;
    expect_refused(make_generated_scene("plain"), settings, "--shadows exact");
    settings = shadow_settings();
    settings.want.aovs = {"error-standard"};
    expect_refused(make_generated_scene("plain"), settings, "--shadows sampled");
}

}  // namespace
}  // namespace kilolux
