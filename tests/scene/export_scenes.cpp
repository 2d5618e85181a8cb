// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/export_scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <tuple>

#include "host/scene/lights/light_kinds.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

Image checker(const std::string& name, std::uint8_t alpha) {
    Image image{name, 3, 2, {}};
    for (std::uint8_t i = 0; i < 6; ++i) {
        image.rgba.insert(image.rgba.end(), {static_cast<std::uint8_t>(40 * i), 200,
                                             static_cast<std::uint8_t>(255 - i), alpha});
    }
    return image;
}

Material everything_material() {
    Material m;
    m.name = "everything \"quoted\" \xc3\xa4";
    m.base_color = {0.1f, 0.2f, 0.3f, 0.7f};
    m.base_color_texture = {0, 0, glm::mat3(1.0f)};
    m.metallic = 0.4f;
    m.roughness = 0.6f;
    m.metallic_roughness_texture = {1, 1, glm::mat3(1.0f)};
    m.normal_texture = {1, 0, glm::mat3(1.0f)};
    m.normal_scale = 0.8f;
    m.occlusion_texture = {1, 0, glm::mat3(1.0f)};
    m.occlusion_strength = 0.9f;
    m.emissive = {7.3f, 0.1f, 0.0f};
    m.emissive_texture = {0, 0, glm::mat3(1.0f)};
    m.emissive_texture.uv_from_texcoord[0].x = 2.5f;
    m.emissive_texture.uv_from_texcoord[2] = {0.25f, -0.5f, 1.0f};
    m.alpha_mode = AlphaMode::mask;
    m.alpha_cutoff = 0.3f;
    m.double_sided = true;
    m.ior = 1.33f;
    m.specular = 0.5f;
    m.specular_color = {1.0f, 0.9f, 0.2f};
    m.specular_texture = {1, 1, glm::mat3(1.0f)};
    m.specular_color_texture = {0, 0, glm::mat3(1.0f)};
    m.clearcoat = 0.8f;
    m.clearcoat_texture = {1, 0, glm::mat3(1.0f)};
    m.clearcoat_roughness = 0.1f;
    m.clearcoat_roughness_texture = {1, 1, glm::mat3(1.0f)};
    m.clearcoat_normal_texture = {2, 0, glm::mat3(1.0f)};
    m.clearcoat_normal_scale = 0.7f;
    m.sheen_color = {0.3f, 0.2f, 0.9f};
    m.sheen_color_texture = {0, 1, glm::mat3(1.0f)};
    m.sheen_roughness = 0.6f;
    m.sheen_roughness_texture = {1, 0, glm::mat3(1.0f)};
    m.anisotropy_strength = 0.4f;
    m.anisotropy_rotation = -2.5f;
    m.anisotropy_texture = {0, 0, glm::mat3(1.0f)};
    m.transmission = 0.4f;
    m.transmission_texture = {0, 1, glm::mat3(1.0f)};
    m.thickness = 0.01f;
    m.thickness_texture = {1, 0, glm::mat3(1.0f)};
    m.attenuation_distance = 0.7f;
    m.attenuation_color = {0.1f, 0.9f, 0.4f};
    return m;
}

Material unlit_material() {
    Material m;
    m.unlit = true;
    m.alpha_mode = AlphaMode::blend;
    return m;
}

Mesh triangle(int material) {
    Mesh mesh;
    mesh.name = "triangle";
    mesh.positions = {{0.1f, 0.0f, 0.0f}, {1.0f, 0.3f, 0.0f}, {0.0f, 1.0f, 1e-7f}};
    mesh.normals = {{0, 0, 1}, {0, 0.6f, 0.8f}, {0, 0, 1}};
    mesh.indices = {2, 0, 1};
    mesh.material = material;
    return mesh;
}

Mesh full_triangle() {
    Mesh mesh = triangle(0);
    // The loader's order of vertices; it would renumber others.
    mesh.indices = {0, 1, 2};
    mesh.tangents = {{1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 0, 1}};
    mesh.texcoords[0] = {{0, 0}, {1, 0}, {0, 3.5f}};
    mesh.texcoords[1] = {{0.5f, 0}, {1, -1}, {0, 1}};
    mesh.colors = {{1, 0, 0, 1}, {0.3f, 0.5f, 0.1f, 1}, {0, 0, 1, 0.5f}};
    return mesh;
}

void add_lights(Scene& scene) {
    SceneLight point;
    point.position = {1.0 / 3.0, 1e6 + 0.1, -2.0};
    point.intensity = {12.5f, 3.3f, 0.7f};
    point.range = 4.7f;
    SceneLight endless = point;
    endless.range = 0.0f;
    SceneLight spot = point;
    spot.type = LightType::spot;
    spot.direction = glm::normalize(glm::dvec3(0.3, -1.0, 0.2));
    spot.side = glm::normalize(glm::cross(spot.direction, glm::dvec3(0.5, 0.1, 0.3)));
    spot.inner_cone = 0.2f;
    spot.outer_cone = 0.7f;
    SceneLight down = spot;
    down.direction = {0, -1, 0};
    down.side = {0.6, 0, 0.8};
    SceneLight sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(glm::dvec3(-0.5, -0.8, 0.1));
    sun.side = glm::normalize(glm::cross(sun.direction, glm::dvec3(0.0, 0.6, 0.8)));
    sun.intensity = {1000.0f, 990.0f, 900.0f};
    SceneLight dark = point;
    dark.intensity = glm::vec3(0.0f);
    SceneLight panel = spot;
    panel.type = LightType::rectangle;
    panel.width = 1.3f;
    panel.height = 0.7f;
    SceneLight ellipse = panel;
    ellipse.type = LightType::disk;
    ellipse.range = 0.0f;
    ellipse.two_sided = true;
    SceneLight ball = point;
    ball.type = LightType::sphere;
    ball.radius = 0.11f;
    scene.lights = {point, endless, spot, down, sun, dark, panel, ellipse, ball};
}

void add_cameras(Scene& scene) {
    SceneCamera perspective;
    perspective.name = "front";
    perspective.world_from_camera = glm::translate(glm::dmat4(1.0), {0.1, 0.2, 5.0});
    perspective.y_fov = 0.9;
    perspective.aspect = 16.0 / 9.0;
    perspective.z_near = 0.01;
    perspective.z_far = 1234.5;
    SceneCamera parallel;
    parallel.world_from_camera = glm::rotate(glm::dmat4(1.0), 0.3, {0, 1, 0});
    parallel.orthographic = true;
    parallel.y_extent = 2.0;
    parallel.aspect = 1.5;
    parallel.z_near = 0.0;
    parallel.z_far = 10.0;
    scene.cameras = {perspective, parallel};
}

void add_instances(Scene& scene) {
    const glm::dmat4 turned =
        glm::rotate(glm::translate(glm::dmat4(1.0), {5.1, 1e7 / 3.0, 0.0}), 1.1, {0.6, 0.8, 0});
    scene.instances.push_back({0, glm::dmat4(1.0)});
    scene.instances.push_back({1, turned});
    scene.instances.push_back({1, glm::scale(turned, {1.0, -2.0, 0.5})});
}

// Compares corners, since loading leaves out vertices that no triangle uses.
template <typename T>
bool same_corners(const Mesh& m, const std::vector<T>& a, const Mesh& n, const std::vector<T>& b) {
    if (a.empty() != b.empty() || m.indices.size() != n.indices.size()) return false;
    for (std::size_t i = 0; !a.empty() && i < m.indices.size(); ++i) {
        if (std::memcmp(&a.at(m.indices[i]), &b.at(n.indices[i]), sizeof(T)) != 0) return false;
    }
    return true;
}

bool same_sampler(const Sampler& s, const Sampler& t) {
    const bool between = !s.mipmaps || s.between_mipmaps == t.between_mipmaps;
    return s.wrap_s == t.wrap_s && s.wrap_t == t.wrap_t && between && s.magnify == t.magnify &&
           s.minify == t.minify && s.mipmaps == t.mipmaps;
}

// Compares the contents of textures, since loading numbers them in the order of their use.
struct Materials {
    const Scene& a;
    const Scene& b;

    bool same_use(const TextureUse& u, const TextureUse& v) const {
        if (u.present() != v.present()) return false;
        if (!u.present()) return true;
        const Texture& s = a.textures.at(static_cast<std::size_t>(u.texture));
        const Texture& t = b.textures.at(static_cast<std::size_t>(v.texture));
        const Image& i = a.images.at(static_cast<std::size_t>(s.image));
        const Image& j = b.images.at(static_cast<std::size_t>(t.image));
        return u.uv_set == v.uv_set && u.uv_from_texcoord == v.uv_from_texcoord &&
               same_sampler(s.sampler, t.sampler) && i.width == j.width && i.height == j.height &&
               i.rgba == j.rgba && i.rgba16 == j.rgba16;
    }

    std::string texture_difference(const Material& m, const Material& n) const {
        if (!same_use(m.base_color_texture, n.base_color_texture)) return "base colour texture";
        if (!same_use(m.metallic_roughness_texture, n.metallic_roughness_texture))
            return "metallic-roughness texture";
        if (!same_use(m.normal_texture, n.normal_texture)) return "normal map";
        if (!same_use(m.occlusion_texture, n.occlusion_texture)) return "occlusion texture";
        if (!same_use(m.emissive_texture, n.emissive_texture)) return "emissive texture";
        if (!same_use(m.specular_texture, n.specular_texture)) return "specular texture";
        if (!same_use(m.specular_color_texture, n.specular_color_texture))
            return "specular colour texture";
        if (!same_use(m.clearcoat_texture, n.clearcoat_texture)) return "coat's texture";
        if (!same_use(m.clearcoat_roughness_texture, n.clearcoat_roughness_texture))
            return "coat's roughness texture";
        if (!same_use(m.clearcoat_normal_texture, n.clearcoat_normal_texture))
            return "coat's normal map";
        if (!same_use(m.sheen_color_texture, n.sheen_color_texture)) return "sheen's texture";
        if (!same_use(m.sheen_roughness_texture, n.sheen_roughness_texture))
            return "sheen's roughness texture";
        if (!same_use(m.anisotropy_texture, n.anisotropy_texture)) return "anisotropy's texture";
        if (!same_use(m.transmission_texture, n.transmission_texture))
            return "transmission's texture";
        if (!same_use(m.thickness_texture, n.thickness_texture)) return "thickness texture";
        return "";
    }
};

std::string factor_difference(const Material& a, const Material& b) {
    if (a.name != b.name) return "name";
    if (a.base_color != b.base_color) return "base colour";
    if (a.metallic != b.metallic || a.roughness != b.roughness) return "metallic-roughness";
    if (a.normal_texture.present() && a.normal_scale != b.normal_scale) return "normal scale";
    if (a.occlusion_texture.present() && a.occlusion_strength != b.occlusion_strength)
        return "occlusion strength";
    if (a.emissive != b.emissive) return "emission";
    if (a.alpha_mode != b.alpha_mode) return "alpha mode";
    if (a.alpha_mode == AlphaMode::mask && a.alpha_cutoff != b.alpha_cutoff) return "alpha cutoff";
    if (a.double_sided != b.double_sided || a.unlit != b.unlit) return "sides or unlit";
    if (a.unlit) return "";
    if (a.ior != b.ior || a.specular != b.specular || a.specular_color != b.specular_color)
        return "ior or specular";
    if (a.clearcoat != b.clearcoat || a.clearcoat_roughness != b.clearcoat_roughness)
        return "clear coat";
    if (a.clearcoat_normal_texture.present() &&
        a.clearcoat_normal_scale != b.clearcoat_normal_scale)
        return "coat's normal scale";
    if (a.sheen_color != b.sheen_color || a.sheen_roughness != b.sheen_roughness) return "sheen";
    if (a.anisotropy_strength != b.anisotropy_strength ||
        a.anisotropy_rotation != b.anisotropy_rotation)
        return "anisotropy";
    if (a.transmission != b.transmission) return "transmission";
    if (a.thickness != b.thickness || a.attenuation_distance != b.attenuation_distance ||
        a.attenuation_color != b.attenuation_color)
        return "volume";
    return "";
}

std::string mesh_difference(const Mesh& a, const Mesh& b) {
    if (a.name != b.name || a.material != b.material) return "name or material";
    if (!same_corners(a, a.positions, b, b.positions)) return "positions";
    if (!same_corners(a, a.normals, b, b.normals)) return "normals";
    if (!same_corners(a, a.tangents, b, b.tangents)) return "tangents";
    if (!same_corners(a, a.texcoords[0], b, b.texcoords[0])) return "texcoords[0]";
    if (!same_corners(a, a.texcoords[1], b, b.texcoords[1])) return "texcoords[1]";
    if (!same_corners(a, a.colors, b, b.colors)) return "colors";
    return "";
}

bool same_light(const SceneLight& a, const SceneLight& b) {
    if (a.type != b.type || a.position != b.position || a.intensity != b.intensity) return false;
    if (a.type != LightType::directional && a.range != b.range) return false;
    // Normalising a unit vector again may change its rounding in double.
    const bool aimed = kind_of(a).is_aimed || a.profile >= 0;
    if (aimed && glm::distance(a.direction, b.direction) > 1e-15) return false;
    if (aimed && glm::distance(a.side, b.side) > 1e-15) return false;
    if (a.profile != b.profile) return false;
    if (kind_of(a).is_flat &&
        std::tie(a.width, a.height, a.two_sided) != std::tie(b.width, b.height, b.two_sided)) {
        return false;
    }
    if (kind_of(a).has_radius && a.radius != b.radius) return false;
    return a.type != LightType::spot ||
           (a.inner_cone == b.inner_cone && a.outer_cone == b.outer_cone);
}

bool same_web(const PhotometricWeb& a, const PhotometricWeb& b) {
    return a.name == b.name && a.text == b.text && a.table == b.table;
}

bool same_profile(const SceneProfile& a, const SceneProfile& b) {
    return a.web == b.web && a.mirrored == b.mirrored;
}

bool same_camera(const SceneCamera& a, const SceneCamera& b) {
    // glTF's parallel cameras have a width: without an aspect it is the height.
    const bool same_aspect = a.aspect == b.aspect || (a.orthographic && a.aspect == 0.0);
    return a.name == b.name && a.world_from_camera == b.world_from_camera &&
           a.orthographic == b.orthographic && same_aspect && a.z_near == b.z_near &&
           a.z_far == b.z_far && (a.orthographic ? a.y_extent == b.y_extent : a.y_fov == b.y_fov);
}

bool same_instance(const Instance& a, const Instance& b) {
    return a.mesh == b.mesh && a.world_from_object == b.world_from_object;
}

// "meshes[3] indices": where the lists differ first.
template <typename T, typename Difference>
std::string list_difference(const char* name, const std::vector<T>& a, const std::vector<T>& b,
                            Difference difference) {
    if (a.size() != b.size()) {
        return std::string(name) + ": " + std::to_string(a.size()) + " against " +
               std::to_string(b.size());
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::string what = difference(a[i], b[i]);
        if (!what.empty()) return std::string(name) + "[" + std::to_string(i) + "] " + what;
    }
    return "";
}

}  // namespace

Scene scene_of_everything() {
    Scene scene;
    scene.name = "everything";
    scene.images = {checker("opaque", 255),
                    checker("see-through", 100),
                    {"slopes", 2, 1, {}, {32776, 32760, 65535, 257, 1, 2, 3, 40000}}};
    Sampler plain;
    plain.wrap_s = Wrap::mirror;
    plain.wrap_t = Wrap::clamp;
    plain.magnify = Filter::nearest;
    plain.mipmaps = false;
    scene.textures = {{1, {}}, {0, plain}, {2, {}}};
    scene.materials = {everything_material(), unlit_material(), Material{}};
    scene.meshes = {full_triangle(), triangle(-1), triangle(1), triangle(2)};
    for (std::size_t m = 1; m < scene.meshes.size(); ++m) scene.meshes[m].indices = {0, 1, 2};
    add_instances(scene);
    scene.instances.push_back({2, glm::dmat4(1.0)});
    scene.instances.push_back({3, glm::dmat4(1.0)});
    add_lights(scene);
    add_cameras(scene);
    return scene;
}

void write_export(const ExportedScene& exported, const std::filesystem::path& folder) {
    for (const ExportedFile& file : exported.files) write_file(folder / file.name, file.bytes);
}

std::string scene_difference(const Scene& a, const Scene& b) {
    const Materials materials{a, b};
    const auto material = [&](const Material& m, const Material& n) {
        const std::string factor = factor_difference(m, n);
        return factor.empty() ? materials.texture_difference(m, n) : factor;
    };
    const auto unless = [](auto same) {
        return [same](const auto& m, const auto& n) {
            return std::string(same(m, n) ? "" : "differs");
        };
    };
    for (const std::string& difference :
         {list_difference("materials", a.materials, b.materials, material),
          list_difference("meshes", a.meshes, b.meshes, mesh_difference),
          list_difference("instances", a.instances, b.instances, unless(same_instance)),
          list_difference("lights", a.lights, b.lights, unless(same_light)),
          list_difference("webs", a.webs, b.webs, unless(same_web)),
          list_difference("profiles", a.aimed_profiles, b.aimed_profiles, unless(same_profile)),
          list_difference("cameras", a.cameras, b.cameras, unless(same_camera))}) {
        if (!difference.empty()) return difference;
    }
    return "";
}

}  // namespace kilolux
