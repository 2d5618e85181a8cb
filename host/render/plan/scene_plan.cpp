// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/scene_plan.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "host/base/error.h"
#include "host/render/plan/settings_check.h"
#include "host/scene/lights/light_generator.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_region.h"
#include "host/scene/lights/light_tree.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

// Materials that some instance shows at some time, each once.
std::vector<Material> materials_in_use(const Scene& scene) {
    std::vector<bool> used(scene.materials.size() + 1, false);
    std::vector<Material> materials;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const std::size_t row = material_row(scene, mesh);
        if (used[row]) continue;
        used[row] = true;
        for (const Material* material : looks_of(scene, mesh)) materials.push_back(*material);
    }
    return materials;
}

float largest_emission(const Material& m) {
    const float emissive = std::max({m.emissive.x, m.emissive.y, m.emissive.z});
    const float unlit = m.unlit ? std::max({m.base_color.x, m.base_color.y, m.base_color.z}) : 0.0f;
    return std::max(emissive, unlit);
}

bool has_coat(const Material& m) { return !m.unlit && m.clearcoat > 0.0f; }

bool has_normal_map(const Material& m) {
    return m.normal_texture.present() || m.clearcoat_normal_texture.present();
}

bool is_forced(const RenderSettings& settings, std::string_view name) {
    return std::ranges::count(settings.force_features, name) > 0;
}

using F = SceneFeatures;

// A feature that some materials need.
struct MaterialFeature {
    bool F::*member;
    bool (*needs)(const Material& m);
    int model = SHADING_LAMBERT;  // the first one that reads it
};

constexpr MaterialFeature kMaterialFeatures[] = {
    {&F::metallic, [](const Material& m) { return !m.unlit && m.metallic > 0.0f; },
     SHADING_BLINN_PHONG},
    {&F::emissive, [](const Material& m) { return largest_emission(m) > 0.0f; }},
    {&F::occlusion, [](const Material& m) { return m.occlusion_texture.present(); }},
    {&F::specular, [](const Material& m) { return !m.unlit && has_own_reflectance(m); },
     SHADING_BLINN_PHONG},
    {&F::clearcoat, has_coat, SHADING_PBR},
    {&F::coat_normals, [](const Material& m) { return has_coat(m) && has_normal_map(m); },
     SHADING_PBR},
    {&F::sheen, [](const Material& m) { return !m.unlit && m.sheen_color != glm::vec3(0.0f); },
     SHADING_PBR},
    {&F::anisotropy, [](const Material& m) { return !m.unlit && m.anisotropy_strength > 0.0f; },
     SHADING_PBR},
    {&F::transmission, [](const Material& m) { return m.transmission > 0.0f; }},
    {&F::unlit_materials, [](const Material& m) { return m.unlit; }},
    {&F::normal_maps, has_normal_map},
    {&F::alpha_mask, [](const Material& m) { return m.alpha_mode == AlphaMode::mask; }},
    {&F::alpha_blend, [](const Material& m) { return is_blended(m); }},
};

SceneFeatures features_of(const Scene& scene, const std::vector<Material>& materials) {
    SceneFeatures out;
    out.light_d_min = light_d_min(scene);
    out.light_profiles = !scene.aimed_profiles.empty();
    for (const SceneLight& light : scene.lights) add_features(out, light);
    for (const MaterialFeature& feature : kMaterialFeatures) {
        out.*feature.member = std::ranges::any_of(materials, feature.needs);
    }
    return out;
}

int shading_of(const RenderSettings& settings, const std::vector<Material>& materials) {
    if (is_forced(settings, "pbr")) return SHADING_PBR;
    if (is_forced(settings, "blinn-phong")) return SHADING_BLINN_PHONG;
    if (settings.shading != Shading::automatic) return model_of(settings.shading);
    // glTF's BRDF reflects at every roughness; only where nothing is lit, no model differs.
    return std::ranges::all_of(materials, &Material::unlit) ? SHADING_LAMBERT : SHADING_PBR;
}

// The features that the pictures need of those that the scene has, and the forced ones.
SceneFeatures needed(SceneFeatures out, int shading, const RenderSettings& settings) {
    const bool glossy = shading != SHADING_LAMBERT;
    out.gloss = glossy || settings.want.whole_surfaces();
    for (const MaterialFeature& feature : kMaterialFeatures) {
        out.*feature.member &= shading >= feature.model;
    }
    out.unlit = glossy && out.unlit_materials;
    out.occlusion &= settings.ambient > 0.0f;
    for (const SceneFeature& feature : scene_feature_table()) {
        if (is_forced(settings, feature.name)) out.*feature.member = true;
    }
    out.unlit |= is_forced(settings, "unlit");
    out.material = out.metallic || out.emissive;
    return out;
}

// What a scene with a light tree cannot have.
void check_light_tree(const SceneFeatures& features) {
    if (features.light_groups > 0) {
        throw UsageError(
            "light groups: a node of the light tree has lights of several groups; take --tails "
            "bounded or exact");
    }
    if (features.alpha_blend) {
        throw UsageError(
            "tails tree: not for scenes with surfaces that blend or transmit; take --tails "
            "exact");
    }
}

int bytes_per_pixel(const GBufferNeeds& needs) {
    return static_cast<int>(make_gbuffer_layout(needs, 16, 1).bytes_per_pixel);
}

}  // namespace

ScenePlan ScenePlan::of_layers() const {
    ScenePlan out = *this;
    out.kernels.transmission = out.gbuffer.transmission = transmission;
    out.gbuffer_bytes_per_pixel = bytes_per_pixel(out.gbuffer);
    return out;
}

const std::vector<std::string>& forceable_features() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> out;
        for (const SceneFeature& feature : scene_feature_table()) {
            if (feature.forceable) out.emplace_back(feature.name);
        }
        out.insert(out.end(), {"blinn-phong", "pbr"});
        return out;
    }();
    return names;
}

ScenePlan make_scene_plan(const Scene& scene, const RenderSettings& settings,
                          std::uint64_t light_count) {
    check_settings(settings);
    const std::vector<Material> materials = materials_in_use(scene);
    const int shading = shading_of(settings, materials);
    SceneFeatures features = features_of(scene, materials);
    features.point_lights = light_count > 0;
    features.area_lights = has_area_lights(scene.lights, settings.lights);
    if (features.area_lights) check_area_lights(shading, settings.shadows);
    features.illuminance = settings.shading == Shading::illuminance;
    features.light_groups = static_cast<int>(settings.light_groups.size());
    features.wide_light_index = light_count > 65536;
    features.shadows = settings.shadows != Shadows::off && triangle_count(scene) > 0;
    if (settings.tails == Tails::stochastic && std::ranges::any_of(scene.lights, lacks_range)) {
        features.random_ranges = static_cast<float>(std::numbers::pi * settings.range_budget);
    }
    const auto in_tree =
        settings.tails == Tails::tree
            ? static_cast<std::uint64_t>(std::ranges::count_if(scene.lights, is_for_tree))
            : 0;
    if (in_tree > 0) {
        check_light_tree(features);
        features.wide_light_index = light_count + 2 * in_tree > 65536;
    }
    features = needed(features, shading, settings);
    ScenePlan plan;
    const bool tints = features.alpha_blend && features.shadows && !settings.opaque_shadows &&
                       settings.shadows == Shadows::exact;
    plan.transmission = features.transmission;
    features.transmission &= tints;  // shading reads the materials of glass
    static_cast<SceneFeatures&>(plan.kernels) = features;
    plan.kernels.shading = shading;
    plan.kernels.gbuffer = settings.gbuffer;
    plan.kernels.light_index_bits = features.wide_light_index ? 32 : 16;
    plan.kernels.fast_relaxed_math = settings.kernels.math == MathMode::fast_relaxed;
    plan.kernels.native_math = settings.kernels.math == MathMode::native;
    plan.kernels.sampled_shadows = features.shadows && settings.shadows == Shadows::sampled;
    plan.kernels.tinted_shadows = tints;
    plan.kernels.light_tree = in_tree > 0;
    plan.kernels.tree_share = in_tree > 0 ? settings.tree_share : 0.0f;
    plan.kernels.half_light_colors = settings.kernels.light_colors == LightColors::half;
    float emission = 0.0f;
    for (const Material& m : materials) emission = std::max(emission, largest_emission(m));
    static_cast<SceneFeatures&>(plan.gbuffer) = features;
    plan.gbuffer.layout = settings.gbuffer;
    plan.gbuffer.emissive_scale = emission > 0.0f ? emission : 1.0f;
    plan.gbuffer_bytes_per_pixel = bytes_per_pixel(plan.gbuffer);
    features.transmission = plan.transmission;
    plan.features.emplace_back(features.illuminance ? "illuminance" : kShadingNames[shading]);
    for (const SceneFeature& feature : scene_feature_table()) {
        if (feature.name.empty()) continue;
        (features.*feature.member ? plan.features : plan.left_out).emplace_back(feature.name);
    }
    return plan;
}

KernelFeatures illuminance_features(KernelFeatures kernels) {
    for (const MaterialFeature& feature : kMaterialFeatures) {
        kernels.*feature.member &= feature.model <= SHADING_LAMBERT;
    }
    kernels.unlit = false;
    kernels.shading = SHADING_LAMBERT;
    kernels.illuminance = true;
    kernels.light_groups = 0;
    return kernels;
}

int added_bytes_per_pixel(const ScenePlan& plan, std::string_view feature) {
    GBufferNeeds needs = plan.gbuffer;
    for (const SceneFeature& row : scene_feature_table()) {
        if (row.name == feature) needs.*row.member = true;
    }
    needs.material = needs.metallic || needs.emissive;
    return bytes_per_pixel(needs) - plan.gbuffer_bytes_per_pixel;
}

}  // namespace kilolux
