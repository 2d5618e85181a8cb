// SPDX-License-Identifier: Apache-2.0
// The background of a scene: in every renderer, behind blended surfaces, in bands and samples;
// nothing else changes.
#include "host/base/error.h"
#include "host/base/formats/srgb.h"
#include "host/scene/lights/prefiltered_environment.h"
#include "tests/support/box_scene.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

std::shared_ptr<const Environment> map_of_directions() {
    Environment map{64, 32, {}};
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            map.rows.emplace_back(0.6 + 0.5 * map.direction(x, y));
        }
    }
    return std::make_shared<const Environment>(std::move(map));
}

std::shared_ptr<const Environment> color(const glm::vec3& radiance) {
    return std::make_shared<const Environment>(Environment{1, 1, {radiance}});
}

// A box before nothing; the camera sees around it.
Scene lonely_box() {
    Scene scene = box_scene(glm::dvec3(2.0, 1.0, 1.0));
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(glm::dvec3(-0.4, -1.0, -0.7));
    scene.lights.push_back(sun);
    return scene;
}

Frame render_box(const Scene& scene, RenderSettings settings) {
    settings.want.aovs = {"depth", "albedo"};
    return render_once(scene, settings);
}

TEST(Background, IsSeenByEveryRendererWhereNoSurfaceIs) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(96, 54, 0);
    const Frame black = render_box(scene, settings);
    settings.background = map_of_directions();
    const Frame first = render_box(scene, settings);
    ASSERT_EQ(first.aovs[0].values, black.aovs[0].values);
    ASSERT_EQ(first.aovs[1].values, black.aovs[1].values) << "layers say what surfaces are";
    std::size_t open = 0;
    const Camera camera = first_camera(scene);
    for (std::size_t i = 0; i < 96u * 54u; ++i) {
        const bool drawn = black.aovs[0].values[i] != 0.0f;
        open += drawn ? 0 : 1;
        const View view = view_of(camera, 96, 54);
        const FV3 p = view_position(view, static_cast<float>(i % 96) + 0.5f,
                                    static_cast<float>(i / 96) + 0.5f, 1.0f);
        const glm::dvec3 d = glm::normalize(camera.world_from_view * glm::dvec3(p.x, p.y, p.z));
        for (std::size_t c = 0; c < 3; ++c) {
            const float seen = first.radiance[3 * i + c];
            if (drawn) {
                ASSERT_EQ(seen, black.radiance[3 * i + c]) << i;
            } else {
                // The map is linear in directions, its texels 0.1 rad.
                ASSERT_NEAR(seen, 0.6 + 0.5 * d[static_cast<int>(c)], 2e-3) << i;
            }
        }
    }
    EXPECT_GT(open, 1000u);
    for (const RendererKind kind :
         {RendererKind::deferred_all, RendererKind::forward, RendererKind::forward_plus}) {
        settings.renderer = kind;
        const Frame other = render_box(scene, settings);
        for (std::size_t i = 0; i < other.radiance.size(); ++i) {
            if (kind != RendererKind::deferred_all && black.aovs[0].values[i / 3] != 0.0f) continue;
            ASSERT_EQ(other.radiance[i], first.radiance[i]) << static_cast<int>(kind) << " " << i;
        }
    }
}

TEST(Background, ChangesNoBitOfBandsSamplesAndBloom) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(96, 70, 0);
    settings.background = map_of_directions();
    settings.samples = 3;
    settings.bloom = 0.2f;
    const Frame whole = render_once(scene, settings);
    settings.band_rows = 16;
    const Frame bands = render_once(scene, settings);
    EXPECT_EQ(whole.radiance, bands.radiance);
    EXPECT_EQ(whole.display, bands.display);
    // Bloom carries the background's light over the surfaces' edges.
    settings.want.shown_light = true;
    const Frame bloomed = render_once(scene, settings);
    settings.background.reset();
    EXPECT_NE(render_once(scene, settings).shown_light, bloomed.shown_light);
}

TEST(Background, IsSeenThroughWhatBlends) {
    Scene scene = lonely_box();
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color = {0.0f, 0.0f, 0.0f, 0.25f};
    scene.materials[0].specular = 0.0f;
    RenderSettings settings = small_settings(48, 27, 0);
    settings.background = color({2.0f, 1.0f, 0.5f});
    for (const RendererKind kind :
         {RendererKind::deferred, RendererKind::deferred_all, RendererKind::forward_plus}) {
        settings.renderer = kind;
        const Frame frame = render_once(scene, settings);
        const std::size_t middle = 3 * (13 * 48 + 24);
        // A black face of opacity 1/4 is before it.
        EXPECT_NEAR(frame.radiance[middle], 1.5f, 0.01f) << static_cast<int>(kind);
        EXPECT_NEAR(frame.radiance[middle + 2], 0.375f, 0.01f);
        EXPECT_FLOAT_EQ(frame.radiance[0], 2.0f);
    }
}

std::shared_ptr<const Environment> shown_color(const glm::u8vec3& code) {
    const auto table = srgb_to_linear_table();
    return std::make_shared<const Environment>(
        Environment{1, 1, {glm::dvec3(table[code.x], table[code.y], table[code.z])}, true});
}

// At the corner, where no surface is.
glm::u8vec3 corner_code(const Frame& frame) {
    return {frame.display[0], frame.display[1], frame.display[2]};
}

TEST(Background, AColourOfTheDisplayIsShownAsItIs) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(48, 27, 0);
    settings.background = color(glm::vec3(0.25f));
    Renderer renderer(scene, settings);
    const Frame lit = renderer.render(first_camera(scene), 0.0);
    const std::size_t middle = 4 * (13 * 48 + 24);
    for (const glm::u8vec3 code : {glm::u8vec3(0x33, 0x44, 0x55), glm::u8vec3(0xff, 0, 0),
                                   glm::u8vec3(255), glm::u8vec3(0), glm::u8vec3(1, 200, 254)}) {
        settings.background = shown_color(code);
        for (const ToneCurve curve :
             {ToneCurve::none, ToneCurve::neutral, ToneCurve::aces, ToneCurve::agx}) {
            settings.tone_curve = curve;
            for (const float exposure : {0.0f, -2.5f, 4.0f}) {
                for (const int samples : {1, 7}) {
                    settings.exposure = exposure;
                    settings.samples = samples;
                    renderer.change(settings);
                    const Frame frame = renderer.render(first_camera(scene), 0.0);
                    ASSERT_EQ(corner_code(frame), code)
                        << static_cast<int>(curve) << " " << exposure << " EV " << samples;
                    if (curve != ToneCurve::neutral || exposure != 0.0f || samples != 1) continue;
                    EXPECT_EQ(frame.display[middle], lit.display[middle]) << "of the box";
                }
            }
        }
    }
    settings.renderer = RendererKind::forward;
    renderer.change(settings);
    EXPECT_EQ(corner_code(renderer.render(first_camera(scene), 0.0)), glm::u8vec3(1, 200, 254));
}

TEST(Background, ItsLightIsWhatTheCurveShowsNearest) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(48, 27, 0);
    for (const ToneCurve curve :
         {ToneCurve::none, ToneCurve::neutral, ToneCurve::aces, ToneCurve::agx}) {
        settings.tone_curve = curve;
        settings.exposure = curve == ToneCurve::agx ? -1.5f : 2.0f;  // the light is divided by it
        settings.background = shown_color({0x33, 0x44, 0x55});
        const Frame shown = render_once(scene, settings);
        settings.background =
            color({shown.radiance[0], shown.radiance[1], shown.radiance[2]});  // as light
        const glm::ivec3 code = corner_code(render_once(scene, settings));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(code[c], (glm::ivec3(0x33, 0x44, 0x55))[c], 1) << static_cast<int>(curve);
        }
    }
}

TEST(Background, ComesAndGoesWithTheSettings) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(48, 27, 0);
    Renderer renderer(scene, settings);
    const Camera camera = first_camera(scene);
    const Frame black = renderer.render(camera, 0.0);
    EXPECT_EQ(black.radiance[0], 0.0f);
    for (const float radiance : {1.0f, 2.0f}) {
        settings.background = color(glm::vec3(radiance));
        renderer.change(settings);
        EXPECT_EQ(renderer.render(camera, 0.0).radiance[0], radiance);
    }
    settings.background.reset();
    renderer.change(settings);
    const Frame again = renderer.render(camera, 0.0);
    EXPECT_EQ(again.radiance, black.radiance);
    for (const StageTime& stage : again.stats.stages) EXPECT_NE(stage.name, "fill_background");
}

Scene box_with(const Material& material) {
    Scene scene = lonely_box();
    scene.materials[0] = material;
    return scene;
}

TEST(Reflections, AreAddedInEveryBandAndSampleAndByBothDeferredRenderers) {
    Material metal;
    metal.roughness = 0.4f;
    const Scene scene = box_with(metal);
    RenderSettings settings = small_settings(96, 70, 0);
    settings.ambient = 0.0f;
    const Frame plain = render_box(scene, settings);
    settings.reflections =
        std::make_shared<const PrefilteredEnvironment>(prefiltered(*map_of_directions()));
    const Frame lit = render_box(scene, settings);
    for (std::size_t i = 0; i < 96u * 70u; ++i) {
        const bool drawn = plain.aovs[0].values[i] != 0.0f;
        const float added = lit.radiance[3 * i] - plain.radiance[3 * i];
        ASSERT_EQ(added > 0.05f, drawn) << i;
    }
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(render_box(scene, settings).radiance, lit.radiance);
    settings.renderer = RendererKind::deferred;
    settings.samples = 3;
    settings.background = color(glm::vec3(0.5f));
    const Frame whole = render_once(scene, settings);
    settings.band_rows = 16;
    EXPECT_EQ(render_once(scene, settings).radiance, whole.radiance);
    settings.renderer = RendererKind::forward_plus;
    EXPECT_THROW(render_once(scene, settings), Error);
}

TEST(Reflections, LeaveUnlitSurfacesAlone) {
    Material unlit;
    unlit.unlit = true;
    const Scene scene = box_with(unlit);
    RenderSettings settings = small_settings(48, 27, 0);
    const Frame plain = render_once(scene, settings);
    settings.reflections =
        std::make_shared<const PrefilteredEnvironment>(prefiltered(*map_of_directions()));
    EXPECT_EQ(render_once(scene, settings).radiance, plain.radiance);
}

// Bytes that are planned for a picture, and that its device buffers take.
struct PictureBytes {
    std::uint64_t planned, allocated;
};

PictureBytes picture_bytes(const Scene& scene, RenderSettings settings) {
    settings.want = radiance_only();
    Renderer renderer(scene, settings);
    renderer.render(first_camera(scene), 0.0);
    const ScenePlan plan = make_scene_plan(scene, settings, settings.lights.count);
    return {plan_memory(scene, settings, plan, renderer.gpu().info).bytes,
            renderer.gpu().budget->used};
}

TEST(Background, ItsTexelsCountAsMemory) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(48, 27, 0);
    const PictureBytes without = picture_bytes(scene, settings);
    settings.background = map_of_directions();
    const PictureBytes with = picture_bytes(scene, settings);
    EXPECT_EQ(with.planned - without.planned, 64u * 32u * 12u * 4u / 3u);
    EXPECT_LE(with.allocated - without.allocated, with.planned - without.planned);
    EXPECT_GT(with.allocated - without.allocated, (with.planned - without.planned) * 99 / 100);
}

TEST(Reflections, TheirMapsCountAsMemory) {
    const Scene scene = lonely_box();
    RenderSettings settings = small_settings(48, 27, 0);
    const PictureBytes without = picture_bytes(scene, settings);
    settings.reflections =
        std::make_shared<const PrefilteredEnvironment>(prefiltered(*map_of_directions()));
    const PictureBytes with = picture_bytes(scene, settings);
    EXPECT_GT(with.allocated, without.allocated);
    EXPECT_EQ(with.planned - without.planned, with.allocated - without.allocated);
}

}  // namespace
}  // namespace kilolux
