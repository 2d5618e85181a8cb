// SPDX-License-Identifier: Apache-2.0
// Surfaces that blend: their order, their light, and what they cost a scene without them.
#include <algorithm>
#include <random>

#include "host/scene/lights/prefiltered_environment.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr int kWidth = 96, kHeight = 64;

// A parallelogram around `center` with half its sides.
struct Pane {
    glm::dvec3 center, across, up;
    glm::vec4 color;  // its light and alpha
};

void add_pane(Scene& scene, const Pane& pane, AlphaMode mode) {
    Material material;
    material.base_color = pane.color;
    material.alpha_mode = mode;
    material.unlit = true;
    material.double_sided = true;
    scene.materials.push_back(material);
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size()) - 1;
    scene.meshes.push_back(mesh);
    const glm::dvec3 normal = glm::normalize(glm::cross(pane.across, pane.up));
    glm::dmat4 place(1.0);
    place[0] = glm::dvec4(pane.across, 0.0);
    place[1] = glm::dvec4(pane.up, 0.0);
    place[2] = glm::dvec4(normal, 0.0);
    place[3] = glm::dvec4(pane.center, 1.0);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

// Panes of any direction around the origin, which cut each other.
std::vector<Pane> random_panes(int count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    std::vector<Pane> panes;
    while (static_cast<int>(panes.size()) < count) {
        const Pane pane{0.7 * vector(), 1.5 * vector(), 1.5 * vector(),
                        glm::vec4(0.5 + 0.5 * vector(), 0.5 + 0.4 * unit(random))};
        if (glm::length(glm::cross(pane.across, pane.up)) > 0.3) panes.push_back(pane);
    }
    return panes;
}

// Where a ray meets a pane.
struct PaneHit {
    double distance;
    glm::dvec4 color;
    bool near_edge;
};

std::optional<PaneHit> hit_of(const Pane& pane, const glm::dvec3& from, const glm::dvec3& along) {
    const glm::dvec3 s =
        glm::inverse(glm::dmat3(pane.across, pane.up, -along)) * (from - pane.center);
    constexpr double kEdge = 0.05;
    if (s.z < 0.1 || std::max(std::abs(s.x), std::abs(s.y)) > 1.0 + kEdge) return {};
    return PaneHit{s.z, pane.color, std::max(std::abs(s.x), std::abs(s.y)) > 1.0 - kEdge};
}

struct Seen {
    glm::dvec3 light{0.0};
    std::size_t panes = 0;
};

// What a ray sees. None near an edge, and where panes cross.
std::optional<Seen> seen_along(std::span<const Pane> panes, const glm::dvec3& from,
                               const glm::dvec3& along) {
    std::vector<PaneHit> hits;
    for (const Pane& pane : panes) {
        if (const auto hit = hit_of(pane, from, along)) hits.push_back(*hit);
    }
    std::ranges::sort(hits, std::greater(), &PaneHit::distance);
    Seen seen{{}, hits.size()};
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].near_edge) return {};
        if (i > 0 && hits[i - 1].distance - hits[i].distance < 1e-4) return {};
        seen.light = glm::mix(seen.light, glm::dvec3(hits[i].color), hits[i].color.w);
    }
    return seen;
}

RenderSettings layer_settings(RendererKind kind = RendererKind::deferred) {
    RenderSettings settings = small_settings(kWidth, kHeight, 0);
    settings.gbuffer = GBUFFER_FULL;  // colours are floats
    settings.renderer = kind;
    return settings;
}

Camera pane_camera() { return look_at({0.3, 0.4, 5.0}, {0, 0, 0}, {0, 1, 0}, 0.7); }

Scene scene_of(std::span<const Pane> panes) {
    Scene scene;
    scene.name = "panes";
    // The first pane is opaque.
    for (std::size_t i = 0; i < panes.size(); ++i) {
        add_pane(scene, panes[i], i == 0 ? AlphaMode::opaque : AlphaMode::blend);
    }
    return scene;
}

Frame render_panes(const Scene& scene, RenderSettings settings) {
    return Renderer(scene, settings).render(pane_camera(), 0.0);
}

TEST(Layers, ThatCutEachOtherBlendFromFarToNear) {
    std::vector<Pane> panes = random_panes(14);
    panes[0].color.w = 1.0f;
    for (const Geometry geometry : {Geometry::compute, Geometry::ids, Geometry::planes}) {
        RenderSettings settings = layer_settings();
        settings.geometry = geometry;
        const Frame frame = render_panes(scene_of(panes), settings);
        const Camera camera = pane_camera();
        const View view = view_of(camera, kWidth, kHeight);
        int compared = 0, several = 0;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            const FV3 p = view_position(view, static_cast<float>(i % kWidth) + 0.5f,
                                        static_cast<float>(i / kWidth) + 0.5f, 1.0f);
            const glm::dvec3 along = camera.world_from_view * glm::dvec3(p.x, p.y, p.z);
            const auto seen = seen_along(panes, camera.position, along);
            if (!seen) continue;
            ++compared;
            several += seen->panes > 2 ? 1 : 0;
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(
                    frame.radiance[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(c)],
                    seen->light[c], 1e-5)
                    << "pixel " << i % kWidth << ", " << i / kWidth;
            }
        }
        EXPECT_GT(compared, kWidth * kHeight / 3);
        EXPECT_GT(several, kWidth * kHeight / 10);
    }
}

TEST(Layers, InOnePlaneAllCount) {
    const Pane pane{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0.5f, 0.25f, 1.0f, 0.5f}};
    Pane wall = pane;
    wall.center.z = -1.0;
    wall.color = {0, 0, 0, 1};
    const std::vector<Pane> panes = {wall, pane, pane, pane};
    const Frame frame = render_panes(scene_of(panes), layer_settings());
    for (std::size_t i = 0; i < frame.radiance.size(); i += 3) {
        ASSERT_FLOAT_EQ(frame.radiance[i], 0.875f * 0.5f);
        ASSERT_FLOAT_EQ(frame.radiance[i + 1], 0.875f * 0.25f);
        ASSERT_FLOAT_EQ(frame.radiance[i + 2], 0.875f);
    }
}

// Sixty layers: there is no most.
TEST(Layers, AreAsManyAsThereAreFragments) {
    std::vector<Pane> panes;
    double seen = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double z = 0.05 * ((7 * i) % 60);
        panes.push_back({{0, 0, z}, {9, 0, 0}, {0, 9, 0}, {1.0f, 1.0f, 1.0f, 0.02f}});
        seen += i == 0 ? 0.0 : 0.02 * (1.0 - seen);
    }
    panes[0].color = {0, 0, 0, 1};
    const Frame frame = render_panes(scene_of(panes), layer_settings());
    for (const float value : frame.radiance) ASSERT_NEAR(value, seen, 1e-5);
}

// A lit room whose first material is half transparent.
Scene lit_panes() {
    Scene scene = make_generated_scene("grid");
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.5f;
    return scene;
}

TEST(Layers, DeferredIsDeferredAllBitForBit) {
    const Scene scene = lit_panes();
    for (const Shadows shadows : {Shadows::off, Shadows::exact}) {
        RenderSettings settings = small_settings(kWidth, kHeight, 300);
        settings.shadows = shadows;
        settings.background =
            std::make_shared<const Environment>(Environment{1, 1, {glm::vec3(0.3f)}});
        const Frame lists = render_once(scene, settings);
        settings.renderer = RendererKind::deferred_all;
        const Frame all = render_once(scene, settings);
        EXPECT_TRUE(lists.radiance == all.radiance);
        settings.kernels.lanes = 1;
        EXPECT_TRUE(render_once(scene, settings).radiance == all.radiance) << "one lane";
    }
}

TEST(Layers, OfAlphaOneAreLitAsOpaqueSurfacesAre) {
    Scene opaque = make_generated_scene("grid");
    opaque.materials[0].emissive = {0.1f, 0.2f, 0.3f};
    Scene blended = opaque;
    blended.materials[0].alpha_mode = AlphaMode::blend;
    RenderSettings settings = small_settings(kWidth, kHeight, 300);
    settings.geometry = Geometry::compute;
    settings.reflections = std::make_shared<const PrefilteredEnvironment>(
        prefiltered(Environment{16, 8, std::vector<glm::vec3>(128, glm::vec3(0.3f))}));
    EXPECT_TRUE(render_once(opaque, settings).radiance == render_once(blended, settings).radiance);
}

// A lamp before a pane that hides a part of the wall from it.
TEST(Layers, AreShadowedByOpaqueSurfaces) {
    const Pane wall{{0, 0, -1}, {3, 0, 0}, {0, 3, 0}, {0.8f, 0.6f, 0.4f, 1.0f}};
    const Pane shade{{0.2, 0.1, 0}, {0.4, 0, 0}, {0, 0.4, 0}, {0.5f, 0.5f, 0.5f, 1.0f}};
    const auto scene_with = [&](AlphaMode mode) {
        Scene scene;
        add_pane(scene, wall, mode);
        add_pane(scene, shade, AlphaMode::opaque);
        for (Material& material : scene.materials) material.unlit = false;
        SceneLight lamp;
        lamp.position = {-0.5, 0.5, 2.0};
        lamp.intensity = glm::vec3(9.0f);
        lamp.range = 20.0f;
        scene.lights.push_back(lamp);
        return scene;
    };
    RenderSettings settings = layer_settings();
    settings.geometry = Geometry::compute;
    settings.ambient = 0.0f;
    settings.shadows = Shadows::exact;
    const Frame opaque = render_panes(scene_with(AlphaMode::opaque), settings);
    EXPECT_TRUE(opaque.radiance == render_panes(scene_with(AlphaMode::blend), settings).radiance);
    settings.shadows = Shadows::off;
    const auto differences =
        picture_differences(render_panes(scene_with(AlphaMode::blend), settings), opaque);
    EXPECT_GT(std::ranges::count(differences, 1.0, [](double d) { return std::round(d); }), 100);
}

// One pane covers the view, another one a pixel beside a corner of four tiles, and no tile twice.
TEST(Layers, AreCounted) {
    const Pane wall{{0, 0, -1}, {9, 0, 0}, {0, 9, 0}, {0, 0, 0, 1}};
    const Pane all{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {1, 1, 1, 0.5f}};
    const Pane dot{{0.02, 0.02, 1.0}, {0.03, 0, 0}, {0, 0.03, 0}, {1, 1, 1, 0.5f}};
    RenderSettings settings = layer_settings();
    settings.want.counts = true;
    const Frame frame = Renderer(scene_of(std::vector{wall, all, dot}), settings)
                            .render(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.7), 0.0);
    EXPECT_EQ(frame.stats.layers, 2u);
    const std::uint64_t dots = frame.stats.layer_pixels - kWidth * kHeight;
    EXPECT_GT(dots, 0u);
    EXPECT_LT(dots, 16u);
    EXPECT_EQ(frame.stats.layer_tiles, kWidth * kHeight / (FINE_TILE * FINE_TILE) + 1u);
}

// A lit wall behind small panes in one corner of the view.
Scene corner_panes(int count, bool with_clear_pane) {
    Scene scene;
    add_pane(scene, {{0, 0, -1}, {9, 0, 0}, {0, 9, 0}, {0.8f, 0.6f, 0.4f, 1.0f}},
             AlphaMode::opaque);
    for (int i = 0; i < count; ++i) {
        const double x = 0.9 + 0.05 * i, z = 0.1 * i;
        const Pane pane{{x, -0.5, z}, {0.2, 0, 0.05}, {0, 0.3, 0}, {0.3f, 0.6f, 0.9f, 0.4f}};
        add_pane(scene, pane, AlphaMode::blend);
    }
    add_pane(scene, {{0.9, -0.4, 0.5}, {0.15, 0, 0}, {0, 0.15, 0}, {1, 1, 1, 1}},
             AlphaMode::opaque);
    if (with_clear_pane) {
        add_pane(scene, {{0, 0, 2}, {9, 0, 0}, {0, 9, 0}, {1, 1, 1, 0}}, AlphaMode::blend);
    }
    for (Material& material : scene.materials) material.unlit = false;
    for (int i = 0; i < 12; ++i) {
        SceneLight lamp;
        lamp.position = {0.3 * i - 1.5, 0.2 * (i % 5) - 0.6, 0.5 + 0.1 * i};
        lamp.intensity = glm::vec3(0.3f, 0.1f * static_cast<float>(i % 4), 0.2f);
        lamp.range = 3.0f;
        scene.lights.push_back(lamp);
    }
    return scene;
}

// A pane of alpha 0 in front changes no bit, but makes the rectangle of the layers the whole view.
TEST(Layers, InARectangleHaveTheBitsOfTheWholeView) {
    for (const Shadows shadows : {Shadows::off, Shadows::exact, Shadows::sampled}) {
        for (const RendererKind kind : {RendererKind::deferred, RendererKind::deferred_all}) {
            RenderSettings settings = layer_settings(kind);
            settings.geometry = Geometry::compute;
            settings.shadows = shadows;
            settings.opaque_shadows = true;
            settings.shadow_rays = 1;
            settings.want.counts = true;
            settings.want.aovs = {"layer-count"};
            const Frame part = render_panes(corner_panes(3, false), settings);
            const Frame whole = render_panes(corner_panes(3, true), settings);
            EXPECT_TRUE(part.radiance == whole.radiance) << static_cast<int>(shadows);
            EXPECT_EQ(part.stats.layers, 3u);
            EXPECT_EQ(whole.stats.layers, 4u);
            EXPECT_LT(part.stats.layer_tiles, whole.stats.layer_tiles / 3);
            std::vector<uint> counts = part.aovs[0].ids;
            for (uint& count : counts) ++count;
            EXPECT_TRUE(counts == whole.aovs[0].ids);
        }
    }
}

// A frame draws as many layers at once as the last one had, and keeps what did not change.
TEST(Layers, AreTheSameInALaterFrameAsInAFirstOne) {
    const Scene scene = corner_panes(11, false);
    RenderSettings settings = layer_settings();
    settings.lights.count = 60;
    settings.geometry = Geometry::compute;
    settings.want.display = true;
    Renderer renderer(scene, settings);
    std::vector<std::uint8_t> at_rest;
    const auto camera_at = [](double x) {
        return look_at({x, 0.0, 5.0}, {x, 0, 0}, {0, 1, 0}, 0.3);
    };
    struct Step {
        double x, time;
        std::uint64_t least_layers;
    };
    for (const Step& step :
         {Step{-2.0, 0.0, 0}, Step{1.0, 0.0, 5}, Step{1.0, 0.0, 5}, Step{1.0, 1.5, 5},
          Step{-0.3, 1.5, 1}, Step{1.3, 1.5, 9}, Step{1.3, 1.5, 9}, Step{1.3, 2.0, 9}}) {
        const Frame frame = renderer.render(camera_at(step.x), step.time);
        const Frame first = Renderer(scene, settings).render(camera_at(step.x), step.time);
        EXPECT_GE(first.stats.layers, step.least_layers);
        EXPECT_EQ(frame.stats.layers, first.stats.layers);
        EXPECT_EQ(frame.stats.layer_pixels, first.stats.layer_pixels);
        EXPECT_TRUE(frame.radiance == first.radiance) << step.x << " at " << step.time;
        EXPECT_TRUE(frame.display == first.display) << step.x << " at " << step.time;
        if (step.x == 1.0 && step.time == 0.0) at_rest = frame.display;
        if (step.x == 1.0 && step.time > 0.0) {
            EXPECT_FALSE(frame.display == at_rest);
        }
    }
}

TEST(Layers, TakeNoStageOfASceneWithoutThem) {
    const RenderSettings settings = small_settings(kWidth, kHeight, 10);
    EXPECT_FALSE(has_stage(render_once(make_generated_scene("grid"), settings), "raster_layers"));
    EXPECT_TRUE(has_stage(render_once(lit_panes(), settings), "raster_layers"));
}

}  // namespace
}  // namespace kilolux
