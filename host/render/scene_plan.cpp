// SPDX-License-Identifier: Apache-2.0
#include "host/render/scene_plan.h"

#include <algorithm>

#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

// Materials that some instance shows; the default one where a mesh has none.
std::vector<Material> materials_in_use(const Scene& scene) {
    std::vector<bool> used(scene.materials.size() + 1, false);
    for (const Instance& instance : scene.instances) {
        const int material = scene.meshes[static_cast<std::size_t>(instance.mesh)].material;
        used[material < 0 ? scene.materials.size() : static_cast<std::size_t>(material)] = true;
    }
    std::vector<Material> materials;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (used[i]) materials.push_back(scene.materials[i]);
    }
    if (used.back()) materials.emplace_back();
    return materials;
}

float largest_emission(const Material& m) {
    const float emissive = std::max({m.emissive.x, m.emissive.y, m.emissive.z});
    const float unlit = m.unlit ? std::max({m.base_color.x, m.base_color.y, m.base_color.z}) : 0.0f;
    return std::max(emissive, unlit);
}

bool is_metallic(const Material& m) { return !m.unlit && m.metallic > 0.0f; }

bool has_gloss(const Material& m) {
    return !m.unlit && (m.metallic > 0.0f || m.roughness < 1.0f || m.metallic_roughness_texture.present());
}

int shading_of(Shading choice, const std::vector<Material>& materials) {
    switch (choice) {
        case Shading::lambert:
            return SHADING_LAMBERT;
        case Shading::blinn_phong:
            return SHADING_BLINN_PHONG;
        case Shading::pbr:
            return SHADING_PBR;
        case Shading::automatic:
            break;
    }
    return std::any_of(materials.begin(), materials.end(), has_gloss) ? SHADING_PBR : SHADING_LAMBERT;
}

const char* shading_name(int shading) {
    constexpr const char* kNames[] = {"lambert", "blinn-phong", "pbr"};
    return kNames[shading];
}

struct Feature {
    const char* name;
    bool needed;
};

}  // namespace

ScenePlan make_scene_plan(const Scene& scene, const RenderSettings& settings, std::uint64_t light_count) {
    const std::vector<Material> materials = materials_in_use(scene);
    const auto any_material = [&](auto&& test) { return std::any_of(materials.begin(), materials.end(), test); };
    const auto any_light = [&](LightType type) {
        return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const SceneLight& l) { return l.type == type; });
    };
    ScenePlan plan;
    plan.kernels.shading = shading_of(settings.shading, materials);
    const bool glossy = plan.kernels.shading != SHADING_LAMBERT;
    float emission = 0.0f;
    for (const Material& m : materials) emission = std::max(emission, largest_emission(m));
    plan.gbuffer.layout = settings.gbuffer;
    plan.kernels.metallic = glossy && any_material(is_metallic);
    plan.gbuffer.material = plan.kernels.metallic || emission > 0.0f;
    plan.gbuffer.emissive_scale = emission > 0.0f ? emission : 1.0f;
    plan.gbuffer.occlusion = settings.ambient > 0.0f && any_material([](const Material& m) { return m.occlusion_texture.present(); });
    plan.kernels.gbuffer = settings.gbuffer;
    plan.kernels.material = plan.gbuffer.material;
    plan.kernels.occlusion = plan.gbuffer.occlusion;
    plan.kernels.spot_lights = any_light(LightType::spot);
    plan.kernels.directional_lights = any_light(LightType::directional);
    plan.kernels.light_index_bits = light_count <= 65536 ? 16 : 32;
    plan.gbuffer_bytes_per_pixel = static_cast<int>(make_gbuffer_layout(plan.gbuffer, 16, 1).bytes_per_pixel);
    plan.features.push_back(shading_name(plan.kernels.shading));
    const Feature features[] = {
        {"point-lights", light_count > 0},
        {"spot-lights", plan.kernels.spot_lights},
        {"directional-lights", plan.kernels.directional_lights},
        {"metallic", plan.kernels.metallic},
        {"emissive", emission > 0.0f},
        {"occlusion", plan.gbuffer.occlusion},
        {"normal-maps", any_material([](const Material& m) { return m.normal_texture.present(); })},
        {"alpha-mask", any_material([](const Material& m) { return m.alpha_mode == AlphaMode::mask; })},
        {"alpha-blend", any_material([](const Material& m) { return m.alpha_mode == AlphaMode::blend; })},
        {"wide-light-index", plan.kernels.light_index_bits == 32},
    };
    for (const Feature& feature : features) (feature.needed ? plan.features : plan.left_out).emplace_back(feature.name);
    return plan;
}

}  // namespace kilolux
