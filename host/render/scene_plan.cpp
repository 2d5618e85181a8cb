// SPDX-License-Identifier: Apache-2.0
#include "host/render/scene_plan.h"

#include <algorithm>

#include "host/base/error.h"
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

bool reflects_otherwise(const Material& m) { return !m.unlit && has_own_reflectance(m); }

bool has_gloss(const Material& m) {
    return !m.unlit &&
           (m.metallic > 0.0f || m.roughness < 1.0f || m.metallic_roughness_texture.present());
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
    return std::any_of(materials.begin(), materials.end(), has_gloss) ? SHADING_PBR
                                                                      : SHADING_LAMBERT;
}

const char* shading_name(int shading) {
    constexpr const char* kNames[] = {"lambert", "blinn-phong", "pbr"};
    return kNames[shading];
}

struct Feature {
    const char* name;
    bool needed;
};

void check_forced(const std::vector<std::string>& names) {
    const std::vector<std::string>& known = forceable_features();
    for (const std::string& name : names) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string list;
        for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
        throw Error("scene plan: '" + name + "' cannot be forced; these can: " + list);
    }
}

}  // namespace

const std::vector<std::string>& forceable_features() {
    static const std::vector<std::string> names = {
        "spot-lights", "directional-lights", "metallic",    "emissive", "occlusion", "specular",
        "unlit",       "wide-light-index",   "blinn-phong", "pbr"};
    return names;
}

ScenePlan make_scene_plan(const Scene& scene, const RenderSettings& settings,
                          std::uint64_t light_count) {
    const std::vector<Material> materials = materials_in_use(scene);
    const auto any_material = [&](auto&& test) {
        return std::any_of(materials.begin(), materials.end(), test);
    };
    const auto any_light = [&](LightType type) {
        return std::any_of(scene.lights.begin(), scene.lights.end(),
                           [&](const SceneLight& l) { return l.type == type; });
    };
    check_forced(settings.force_features);
    const auto forced = [&](std::string_view name) {
        return std::find(settings.force_features.begin(), settings.force_features.end(), name) !=
               settings.force_features.end();
    };
    ScenePlan plan;
    plan.kernels.shading = shading_of(settings.shading, materials);
    if (forced("blinn-phong")) plan.kernels.shading = SHADING_BLINN_PHONG;
    if (forced("pbr")) plan.kernels.shading = SHADING_PBR;
    const bool glossy = plan.kernels.shading != SHADING_LAMBERT;
    float emission = 0.0f;
    for (const Material& m : materials) emission = std::max(emission, largest_emission(m));
    plan.gbuffer.layout = settings.gbuffer;
    plan.kernels.metallic = (glossy && any_material(is_metallic)) || forced("metallic");
    const bool emissive = emission > 0.0f || forced("emissive");
    plan.gbuffer.material = plan.kernels.metallic || emissive;
    plan.gbuffer.emissive_scale = emission > 0.0f ? emission : 1.0f;
    plan.gbuffer.occlusion = (settings.ambient > 0.0f && any_material([](const Material& m) {
                                  return m.occlusion_texture.present();
                              })) ||
                             forced("occlusion");
    plan.kernels.specular = (glossy && any_material(reflects_otherwise)) || forced("specular");
    plan.kernels.unlit =
        (glossy && any_material([](const Material& m) { return m.unlit; })) || forced("unlit");
    plan.gbuffer.specular = plan.kernels.specular;
    plan.gbuffer.unlit = plan.kernels.unlit;
    plan.kernels.gbuffer = settings.gbuffer;
    plan.kernels.material = plan.gbuffer.material;
    plan.kernels.occlusion = plan.gbuffer.occlusion;
    plan.kernels.spot_lights = any_light(LightType::spot) || forced("spot-lights");
    plan.kernels.directional_lights =
        any_light(LightType::directional) || forced("directional-lights");
    plan.kernels.light_index_bits = light_count <= 65536 && !forced("wide-light-index") ? 16 : 32;
    plan.kernels.fast_relaxed_math = settings.kernels.math == MathMode::fast_relaxed;
    plan.kernels.native_math = settings.kernels.math == MathMode::native;
    plan.kernels.half_light_colors = settings.kernels.light_colors == LightColors::half;
    plan.gbuffer_bytes_per_pixel =
        static_cast<int>(make_gbuffer_layout(plan.gbuffer, 16, 1).bytes_per_pixel);
    plan.features.push_back(shading_name(plan.kernels.shading));
    const Feature features[] = {
        {"point-lights", light_count > 0},
        {"spot-lights", plan.kernels.spot_lights},
        {"directional-lights", plan.kernels.directional_lights},
        {"metallic", plan.kernels.metallic},
        {"emissive", emissive},
        {"occlusion", plan.gbuffer.occlusion},
        {"specular", plan.kernels.specular},
        {"unlit", any_material([](const Material& m) { return m.unlit; }) || plan.kernels.unlit},
        {"normal-maps", any_material([](const Material& m) { return m.normal_texture.present(); })},
        {"alpha-mask",
         any_material([](const Material& m) { return m.alpha_mode == AlphaMode::mask; })},
        {"alpha-blend",
         any_material([](const Material& m) { return m.alpha_mode == AlphaMode::blend; })},
        {"wide-light-index", plan.kernels.light_index_bits == 32},
    };
    for (const Feature& feature : features)
        (feature.needed ? plan.features : plan.left_out).emplace_back(feature.name);
    return plan;
}

int added_bytes_per_pixel(const ScenePlan& plan, std::string_view feature) {
    GBufferNeeds needs = plan.gbuffer;
    if (feature == "metallic" || feature == "emissive") needs.material = true;
    if (feature == "occlusion") needs.occlusion = true;
    if (feature == "specular") needs.specular = true;
    return static_cast<int>(make_gbuffer_layout(needs, 16, 1).bytes_per_pixel) -
           plan.gbuffer_bytes_per_pixel;
}

}  // namespace kilolux
