// SPDX-License-Identifier: Apache-2.0
// A scene without a feature compiles kernels without it, and its picture is bit for bit that of
// kernels with it.
#include "host/render/plan/scene_plan.h"

#include "host/base/error.h"
#include "host/scene/rows/surface_rows.h"
#include "kernels/shared/evaluate_modes.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// The build option that switches each feature.
struct Switch {
    const char* feature;
    const char* without;
    const char* with;
};
constexpr Switch kSwitches[] = {
    {"spot-lights", "HAS_SPOT_LIGHTS=0", "HAS_SPOT_LIGHTS=1"},
    {"directional-lights", "HAS_DIRECTIONAL_LIGHTS=0", "HAS_DIRECTIONAL_LIGHTS=1"},
    {"metallic", "HAS_METALLIC=0", "HAS_METALLIC=1"},
    {"emissive", "HAS_MATERIAL=0", "HAS_MATERIAL=1"},
    {"occlusion", "HAS_OCCLUSION=0", "HAS_OCCLUSION=1"},
    {"specular", "HAS_SPECULAR=0", "HAS_SPECULAR=1"},
    {"clearcoat", "HAS_CLEARCOAT=0", "HAS_CLEARCOAT=1"},
    {"coat-normals", "HAS_COAT_NORMAL=0", "HAS_COAT_NORMAL=1"},
    {"sheen", "HAS_SHEEN=0", "HAS_SHEEN=1"},
    {"anisotropy", "HAS_ANISOTROPY=0", "HAS_ANISOTROPY=1"},
    {"unlit", "HAS_UNLIT=0", "HAS_UNLIT=1"},
    {"wide-light-index", "LIGHT_INDEX=ushort", "LIGHT_INDEX=uint"}};

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string options_of(const ScenePlan& plan) { return feature_options(plan.kernels).text(); }

ScenePlan plan_of(const Scene& scene, const RenderSettings& settings) {
    return make_scene_plan(scene, settings, settings.lights.count + scene.lights.size());
}

// A scene that needs one feature only, made from one that needs none.
Scene scene_with(const std::string& feature) {
    Scene scene = make_generated_scene("plain");
    Material& material = scene.materials.front();
    SceneLight light;
    light.range = 5.0f;
    if (feature == "spot-lights") light.type = LightType::spot;
    if (feature == "directional-lights") light.type = LightType::directional;
    if (light.type != LightType::point) scene.lights.push_back(light);
    if (feature == "metallic") material.metallic = 0.5f;
    if (feature == "emissive") material.emissive = glm::vec3(0.5f);
    if (feature == "specular") material.ior = 1.33f;
    if (feature == "clearcoat" || feature == "coat-normals") material.clearcoat = 0.5f;
    if (feature == "sheen") material.sheen_color.y = 0.5f;
    if (feature == "anisotropy") material.anisotropy_strength = 0.5f;
    if (feature == "unlit") material.unlit = true;
    if (feature == "occlusion" || feature == "coat-normals") {
        scene.images.push_back({"white", 1, 1, {255, 255, 255, 255}});
        scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
        TextureUse& map =
            feature == "occlusion" ? material.occlusion_texture : material.clearcoat_normal_texture;
        map.texture = static_cast<int>(scene.textures.size()) - 1;
    }
    return scene;
}

RenderSettings settings_for(Shading shading) {
    RenderSettings settings = small_settings(80, 45, 200);
    settings.shading = shading;
    return settings;
}

TEST(ScenePlan, KernelsHoldAFeatureWhereTheSceneNeedsItAndNowhereElse) {
    const RenderSettings settings = settings_for(Shading::pbr);
    const std::string none = options_of(plan_of(make_generated_scene("plain"), settings));
    for (const Switch& s : kSwitches) {
        EXPECT_NE(none.find(s.without), std::string::npos) << s.feature << ": " << none;
        RenderSettings needing = settings;
        if (std::string(s.feature) == "wide-light-index") needing.lights.count = 65537;
        const ScenePlan plan = plan_of(scene_with(s.feature), needing);
        EXPECT_NE(options_of(plan).find(s.with), std::string::npos) << s.feature;
        EXPECT_TRUE(has(plan.features, s.feature)) << s.feature;
        EXPECT_FALSE(has(plan.left_out, s.feature)) << s.feature;
        for (const Switch& other : kSwitches) {
            // Metal and what an unlit surface emits are kept in the plane of emission; only
            // coats have normals of coats.
            const std::string feature = s.feature, with = other.feature;
            const bool shares = with == "emissive"
                                    ? feature == "metallic" || feature == "unlit"
                                    : with == "clearcoat" && feature == "coat-normals";
            if (&other == &s || shares) continue;
            EXPECT_NE(options_of(plan).find(other.without), std::string::npos)
                << s.feature << " brings " << other.feature;
        }
    }
}

TEST(ScenePlan, CompilingAFeatureInChangesNoBit) {
    const Scene scene = make_generated_scene("plain");
    for (const Shading shading : {Shading::blinn_phong, Shading::pbr}) {
        RenderSettings settings = settings_for(shading);
        const Frame without = render_once(scene, settings);
        for (const Switch& s : kSwitches) {
            settings.force_features = {s.feature};
            EXPECT_NE(options_of(plan_of(scene, settings)).find(s.with), std::string::npos);
            const Frame with = render_once(scene, settings);
            EXPECT_EQ(with.radiance, without.radiance)
                << s.feature << ", shading " << static_cast<int>(shading);
            EXPECT_EQ(with.display, without.display) << s.feature;
        }
    }
}

// A matt surface looks the same whatever else is in the scene.
TEST(ScenePlan, AutomaticShadingIsPbrWhereAnythingIsLit) {
    Scene scene = make_generated_scene("plain");
    const RenderSettings settings = settings_for(Shading::automatic);
    EXPECT_EQ(plan_of(scene, settings).kernels.shading, SHADING_PBR);
    for (Material& material : scene.materials) material.unlit = true;
    for (Mesh& mesh : scene.meshes) mesh.material = 0;
    EXPECT_EQ(plan_of(scene, settings).kernels.shading, SHADING_LAMBERT) << "nothing reflects";
    scene.materials[0].unlit = false;
    EXPECT_EQ(plan_of(scene, settings).kernels.shading, SHADING_PBR);
}

// The scene's own, and generated ones.
TEST(ScenePlan, LightsWithASizeAreAFeatureThatBlinnPhongLacks) {
    Scene scene = make_generated_scene("plain");
    RenderSettings settings = settings_for(Shading::pbr);
    const auto has_area = [&] { return has(plan_of(scene, settings).features, "area-lights"); };
    EXPECT_FALSE(has_area());
    settings.lights.size = 0.25;
    EXPECT_TRUE(has_area());
    settings.lights.count = 0;
    EXPECT_FALSE(has_area());
    SceneLight light;
    light.type = LightType::disk;
    light.range = 5.0f;
    light.width = light.height = 1.0f;
    scene.lights.push_back(light);
    EXPECT_TRUE(has_area());
    EXPECT_TRUE(plan_of(scene, settings).kernels.spot_lights) << "its half-space";
    settings.shading = Shading::blinn_phong;
    EXPECT_THROW(plan_of(scene, settings), UsageError);
    settings.shading = Shading::lambert;
    EXPECT_TRUE(has_area());
}

// A GLSL compiler may reorder operations: here features change last bits at most.
TEST(ScenePlan, ForwardShadersRoundAlikeWithAFeature) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = settings_for(Shading::pbr);
    settings.renderer = RendererKind::forward_plus;
    const Frame without = render_once(scene, settings);
    for (const char* feature :
         {"spot-lights", "directional-lights", "metallic", "specular", "unlit"}) {
        settings.force_features = {feature};
        const Frame with = render_once(scene, settings);
        for (std::size_t i = 0; i < with.radiance.size(); ++i) {
            ASSERT_NEAR(with.radiance[i], without.radiance[i], 1e-5f * (without.radiance[i] + 0.1f))
                << feature;
        }
    }
}

TEST(ScenePlan, AddedBytesAreThoseOfThePlanWithTheFeature) {
    const Scene scene = make_generated_scene("plain");
    for (const uint layout : {GBUFFER_PACKED, GBUFFER_FULL, GBUFFER_OCT_2X4}) {
        RenderSettings settings = settings_for(Shading::pbr);
        settings.gbuffer = layout;
        const ScenePlan plan = plan_of(scene, settings);
        for (const Switch& s : kSwitches) {
            settings.force_features = {s.feature};
            EXPECT_EQ(plan_of(scene, settings).gbuffer_bytes_per_pixel,
                      plan.gbuffer_bytes_per_pixel + added_bytes_per_pixel(plan, s.feature))
                << s.feature;
        }
    }
    EXPECT_EQ(plan_of(scene, settings_for(Shading::pbr)).gbuffer_bytes_per_pixel, 12);
}

// Features of the raster shaders: each material's variant has its own.
TEST(ScenePlan, ShaderVariantsHoldWhatTheirMaterialNeeds) {
    const auto features_of = [](const Material& material, bool tangents) {
        Scene scene;
        scene.textures.resize(1);
        scene.materials = {material};
        scene.meshes.resize(1);
        scene.meshes[0].material = 0;
        scene.meshes[0].positions.resize(1);
        if (tangents) scene.meshes[0].tangents.resize(1);
        return mesh_features(scene, scene.meshes[0], ~0u, 1);
    };
    const Material plain;
    EXPECT_EQ(features_of(plain, true), SurfaceFeatures{});
    Material m;
    m.normal_texture.texture = 0;
    EXPECT_EQ(features_of(m, true).texture_uses, 1u << USE_NORMAL);
    EXPECT_TRUE(features_of(m, true).tangents);
    EXPECT_EQ(features_of(m, false), SurfaceFeatures{}) << "a mesh without tangents";
    m = {};
    m.anisotropy_strength = 0.1f;
    EXPECT_TRUE(features_of(m, true).tangents);
    EXPECT_FALSE(features_of(m, false).tangents);
    m = {};
    m.alpha_mode = AlphaMode::mask;
    EXPECT_TRUE(features_of(m, false).masks);
    m = {};
    m.specular_color_texture.texture = 0;
    const SurfaceFeatures coloured = features_of(m, false);
    EXPECT_EQ(coloured.texture_uses, 1u << USE_SPECULAR_COLOR);
    EXPECT_TRUE(coloured.texcoord0 && !coloured.texcoord1 && !coloured.uv_transform);
}

TEST(ScenePlan, RefusesToForceWhatCostsNothingWhereItIsAbsent) {
    RenderSettings settings = settings_for(Shading::pbr);
    settings.force_features = {"normal-maps"};
    EXPECT_THROW(plan_of(make_generated_scene("plain"), settings), Error);
}

}  // namespace
}  // namespace kilolux
