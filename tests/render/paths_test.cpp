// SPDX-License-Identifier: Apache-2.0
// The four renderers against each other: lists must not change a picture.
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr uint kLayouts[] = {GBUFFER_PACKED, GBUFFER_FULL, GBUFFER_HALF, GBUFFER_NORMAL_XY,
                             GBUFFER_OCT_2X4};

Frame render_as(const Scene& scene, RenderSettings settings, RendererKind renderer) {
    settings.renderer = renderer;
    return render_once(scene, settings);
}

// The lit share of the picture: a comparison of black pictures would prove nothing.
double lit_share(const Frame& frame) {
    std::size_t lit = 0;
    for (const float value : frame.radiance) lit += value > 1e-3f;
    return static_cast<double>(lit) / static_cast<double>(frame.radiance.size());
}

void expect_same_bits(const Frame& a, const Frame& b) {
    ASSERT_EQ(a.radiance.size(), b.radiance.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) different += a.radiance[i] != b.radiance[i];
    EXPECT_EQ(different, 0u) << "of " << a.radiance.size();
    EXPECT_EQ(a.display, b.display);
}

// The scene with glass for the first mesh's material.
Scene with_glass() {
    Scene scene = make_generated_scene("grid");
    int glass = -1;
    for (const Instance& instance : scene.instances) {
        const int material = scene.meshes[static_cast<std::size_t>(instance.mesh)].material;
        if (material > glass) glass = material;
    }
    Material& material = scene.materials[static_cast<std::size_t>(glass)];
    material.alpha_mode = AlphaMode::blend;
    material.base_color.w = 0.5f;
    return scene;
}

// OpenGL draws while the device still moves lights: a moment of both has one row.
// A moment that has two rows, or none, is in every frame; a busy machine disturbs some of them.
TEST(Paths, RowsOfStagesAreWithinTheFrame) {
    constexpr double kClocksMs = 0.2;  // between the host's clock and the device's
    constexpr int kFrames = 30;
    const Scene scene = make_generated_scene("grid");
    for (const RendererKind kind : {RendererKind::forward, RendererKind::deferred}) {
        RenderSettings settings = small_settings(4, 4, 300000);
        settings.renderer = kind;
        Renderer renderer(scene, settings);
        bool fits = false;
        std::string seen;
        for (int i = 0; i < kFrames && !fits; ++i) {
            const FrameStats stats = renderer.render(first_camera(scene), 0.01 * i).stats;
            double sum = 0.0;
            for (const StageTime& stage : stats.stages) sum += stage.ms;
            fits = sum <= stats.frame_ms + kClocksMs && sum > 0.9 * stats.frame_ms;
            seen += fmt::format(" {} of {} ms", sum, stats.frame_ms);
        }
        EXPECT_TRUE(fits) << static_cast<int>(kind) << seen;
    }
}

// Programs that the first frame needs, and what drivers do before first launches.
TEST(Paths, BuildingIsNoTimeOfTheFrame) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 36, 100);
    settings.opened = std::make_shared<Gpu>(choose_device(settings.device));  // without programs
    Renderer renderer(scene, settings);
    const auto start = std::chrono::steady_clock::now();
    const FrameStats first = renderer.render(first_camera(scene), 0.0).stats;
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    EXPECT_GT(first.build_ms, 0.0);
    EXPECT_LE(first.build_ms + first.frame_ms, taken.count());
    double sum = 0.0;
    for (const StageTime& stage : first.stages) sum += stage.ms;
    EXPECT_LE(sum, first.frame_ms + 0.2);
    const FrameStats second = renderer.render(first_camera(scene), 0.0).stats;
    EXPECT_EQ(second.build_ms, 0.0);
    EXPECT_GE(1e3 * renderer.gpu().programs->build_seconds(), first.build_ms);
}

TEST(Paths, RenderersThatShareASceneRenderInTurn) {
    const Scene scene = with_glass();
    const std::shared_ptr<RenderScene> shared = shared_scene(scene);
    const Camera camera = first_camera(scene);
    std::vector<RenderSettings> settings(3, small_settings());
    settings[0].geometry = Geometry::ids;
    settings[1].geometry = Geometry::planes;
    settings[2].renderer = RendererKind::forward_plus;
    std::vector<Renderer> renderers;
    for (const RenderSettings& s : settings) renderers.emplace_back(shared, s);
    for (int frame = 0; frame < 2; ++frame) {
        for (std::size_t i = 0; i < settings.size(); ++i) {
            expect_same_bits(renderers[i].render(camera, 0.0), render_once(scene, settings[i]));
        }
    }
    renderers.erase(renderers.begin());
    expect_same_bits(renderers[0].render(camera, 0.0), render_once(scene, settings[1]));
}

TEST(Paths, DeferredIsDeferredAllBitForBit) {
    const Scene scenes[] = {make_generated_scene("grid"), make_generated_scene("plain"),
                            grid_with_every_light()};
    for (const Scene& scene : scenes) {
        for (const uint layout : kLayouts) {
            SCOPED_TRACE(scene.name + ", " + gbuffer_layout_name(layout) + ", " +
                         std::to_string(scene.lights.size()) + " own lights");
            RenderSettings settings = small_settings();
            settings.gbuffer = layout;
            for (const Geometry geometry : {Geometry::ids, Geometry::compute}) {
                settings.geometry = geometry;
                const Frame all = render_as(scene, settings, RendererKind::deferred_all);
                expect_same_bits(all, render_as(scene, settings, RendererKind::deferred));
                EXPECT_GT(lit_share(all), 0.2);
            }
        }
    }
}

// OpenCL draws the same as OpenGL, but for pixels whose centre is next to an edge.
TEST(Paths, ComputeDrawsAsIdsDo) {
    for (const Scene& scene :
         {make_generated_scene("grid"), make_generated_scene("corridor"), with_glass()}) {
        RenderSettings settings = small_settings(192, 108);
        settings.geometry = Geometry::ids;
        const Frame ids = render_as(scene, settings, RendererKind::deferred);
        settings.geometry = Geometry::compute;
        const Frame compute = render_as(scene, settings, RendererKind::deferred);
        const auto differences = picture_differences(ids, compute);
        EXPECT_EQ(quantile(differences, 0.99), 0.0) << scene.name;
        EXPECT_GT(lit_share(compute), 0.2) << scene.name;
    }
}

TEST(Paths, ForwardPlusIsForwardBitForBit) {
    for (const Scene& scene : {make_generated_scene("grid"), grid_with_every_light()}) {
        const RenderSettings settings = small_settings();
        const Frame forward = render_as(scene, settings, RendererKind::forward);
        expect_same_bits(forward, render_as(scene, settings, RendererKind::forward_plus));
        EXPECT_GT(lit_share(forward), 0.2);
    }
}

TEST(Paths, AllFourAgreeWithTheFullGBuffer) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(192, 108);
    settings.gbuffer = GBUFFER_FULL;
    settings.geometry = Geometry::planes;  // OpenGL's fragments, as in the forward renderers
    const Frame deferred = render_as(scene, settings, RendererKind::deferred);
    for (const RendererKind other :
         {RendererKind::deferred_all, RendererKind::forward, RendererKind::forward_plus}) {
        SCOPED_TRACE(static_cast<int>(other));
        const auto differences = picture_differences(deferred, render_as(scene, settings, other));
        EXPECT_LT(quantile(differences, 0.5), 1e-4);
        EXPECT_LT(quantile(differences, 0.999), 1e-2);
    }
}

TEST(Paths, SurfacesThatBlendAreDrawnByAll) {
    const Scene scene = with_glass();
    Scene opaque = scene;
    for (Material& m : opaque.materials) {
        if (m.alpha_mode == AlphaMode::blend) m.base_color.w = 0.0f;  // invisible
    }
    RenderSettings settings = small_settings(192, 108);
    settings.gbuffer = GBUFFER_FULL;
    settings.geometry = Geometry::planes;  // OpenGL's fragments, as in the forward renderers
    const Frame deferred = render_as(scene, settings, RendererKind::deferred);
    expect_same_bits(deferred, render_as(scene, settings, RendererKind::deferred_all));
    for (const RendererKind other : {RendererKind::forward, RendererKind::forward_plus}) {
        const auto differences = picture_differences(deferred, render_as(scene, settings, other));
        EXPECT_LT(quantile(differences, 0.5), 1e-4);
        EXPECT_LT(quantile(differences, 0.999), 1e-2);
    }
    const auto seen =
        picture_differences(deferred, render_as(opaque, settings, RendererKind::deferred));
    EXPECT_GT(quantile(seen, 0.99), 0.02) << "nothing in the picture blends";
}

TEST(Paths, CountsAreThoseOfThePath) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings();
    settings.want.counts = true;
    const auto stats = [&](RendererKind renderer) {
        return render_as(scene, settings, renderer).stats;
    };
    const FrameStats deferred = stats(RendererKind::deferred);
    const FrameStats plus = stats(RendererKind::forward_plus);
    const FrameStats forward = stats(RendererKind::forward);
    EXPECT_EQ(stats(RendererKind::deferred_all).evaluations_per_pixel, 300.0);
    // Forward-plus lists clusters without pixels, too.
    EXPECT_GT(plus.coarse_pairs, deferred.coarse_pairs);
    EXPECT_GT(deferred.coarse_pairs, 0u);
    EXPECT_GE(forward.evaluations_per_pixel, 300.0);
    EXPECT_LT(plus.evaluations_per_pixel, 300.0);
    EXPECT_GT(plus.evaluations_per_pixel, deferred.evaluations_per_pixel);
    EXPECT_GT(deferred.evaluations_per_pixel, deferred.useful_evaluations_per_pixel);
    settings.want.counts = false;
    EXPECT_LT(stats(RendererKind::forward).evaluations_per_pixel, 0.0);
}

const Layer& layer(const Frame& frame, std::string_view name) {
    for (const Layer& l : frame.aovs) {
        if (l.name == name) return l;
    }
    throw std::runtime_error("no layer " + std::string(name));
}

double largest_difference(const Layer& a, const Layer& b) {
    double out = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        out = std::max(out, std::abs(double{a.values[i]} - b.values[i]));
    }
    return out;
}

TEST(Paths, Oct2x4DecodesToWhatFullStores) {
    const Scene scene = make_generated_scene("grid");
    for (const int lanes : {1, 8}) {
        RenderSettings settings = small_settings(96, 54, 0);
        settings.want.aovs = {"depth", "position", "normal", "albedo", "roughness", "metallic"};
        settings.kernels.lanes = lanes;
        settings.gbuffer = GBUFFER_FULL;
        const Frame full = render_once(scene, settings);
        settings.gbuffer = GBUFFER_OCT_2X4;
        const Frame oct = render_once(scene, settings);
        const auto error = [&](const char* name) {
            return largest_difference(layer(full, name), layer(oct, name));
        };
        for (const char* name : {"depth", "position", "roughness", "metallic"}) {
            EXPECT_EQ(error(name), 0.0) << name;
        }
        EXPECT_LT(error("normal"), 2e-6);              // float32 rounding of the octahedron
        EXPECT_LT(error("albedo"), 0.5 / 255 + 1e-6);  // 8 bits
        EXPECT_GT(error("albedo"), 0.0);
    }
}

// Names of OpenGL's objects are small numbers in every context: deleting one renderer must not
// delete another's objects.
TEST(Renderer, AnotherOnesEndLeavesItAlone) {
    const Scene scene = make_generated_scene("grid");
    const RenderSettings settings = small_settings();
    const Camera camera = first_camera(scene);
    Renderer lasting(scene, settings);
    const Frame expected = lasting.render(camera, 0.0);
    {
        Renderer passing(scene, settings);
        passing.render(camera, 0.0);
        EXPECT_EQ(lasting.render(camera, 0.0).radiance, expected.radiance);
    }
    EXPECT_EQ(lasting.render(camera, 0.0).radiance, expected.radiance);
}

}  // namespace
}  // namespace kilolux
