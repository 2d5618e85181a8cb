// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "host/scene/lights/photometry/photometric_web.h"

namespace kilolux {

/// An RGBA image of 8 or of 16 bits a channel, row 0 on top: one of its arrays is empty. The slot
/// that uses it decides whether 8 bits are sRGB; 16 bits are linear.
struct Image {
    std::string name;
    int width = 0;                   // [pixel], > 0
    int height = 0;                  // [pixel], > 0
    std::vector<std::uint8_t> rgba;  // 4 * width * height
    std::vector<std::uint16_t> rgba16{};
    std::size_t bytes() const { return rgba.size() + sizeof(std::uint16_t) * rgba16.size(); }
};

enum class Wrap { repeat, clamp, mirror };
enum class Filter { nearest, linear };

struct Sampler {
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    Filter magnify = Filter::linear;
    Filter minify = Filter::linear;
    bool mipmaps = true;
    Filter between_mipmaps = Filter::linear;
};

struct Texture {
    int image = -1;  // index into Scene::images
    Sampler sampler;
};

/// A material's use of a texture.
struct TextureUse {
    int texture = -1;                  // index into Scene::textures, -1 for none
    int uv_set = 0;                    // 0 or 1
    glm::mat3 uv_from_texcoord{1.0f};  // KHR_texture_transform
    bool present() const { return texture >= 0; }
    bool operator==(const TextureUse&) const = default;
};

enum class AlphaMode { opaque, mask, blend };

/// glTF 2.0 metallic-roughness material; factors multiply textures. Colours are linear Rec. 709.
struct Material {
    std::string name;
    glm::vec4 base_color{1.0f};
    TextureUse base_color_texture;  // sRGB
    float metallic = 1.0f;
    float roughness = 1.0f;                 // perceptual
    TextureUse metallic_roughness_texture;  // linear; G roughness, B metallic
    TextureUse normal_texture;              // linear
    float normal_scale = 1.0f;
    TextureUse occlusion_texture;  // linear; R
    float occlusion_strength = 1.0f;
    glm::vec3 emissive{0.0f};  // with KHR_materials_emissive_strength multiplied in; may exceed 1
    TextureUse emissive_texture;  // sRGB
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;           // KHR_materials_unlit
    float ior = 1.5f;             // KHR_materials_ior
    float specular = 1.0f;        // KHR_materials_specular
    TextureUse specular_texture;  // linear; A
    glm::vec3 specular_color{1.0f};
    TextureUse specular_color_texture;       // sRGB
    float clearcoat = 0.0f;                  // KHR_materials_clearcoat
    TextureUse clearcoat_texture;            // linear; R
    float clearcoat_roughness = 0.0f;        // perceptual
    TextureUse clearcoat_roughness_texture;  // linear; G
    TextureUse clearcoat_normal_texture;     // linear
    float clearcoat_normal_scale = 1.0f;
    glm::vec3 sheen_color{0.0f};         // KHR_materials_sheen
    TextureUse sheen_color_texture;      // sRGB
    float sheen_roughness = 0.0f;        // perceptual
    TextureUse sheen_roughness_texture;  // linear; A
    float anisotropy_strength = 0.0f;    // KHR_materials_anisotropy
    float anisotropy_rotation = 0.0f;    // [rad], from the tangent to the bitangent
    TextureUse anisotropy_texture;       // linear; RG direction, B strength
    float transmission = 0.0f;           // KHR_materials_transmission
    TextureUse transmission_texture;     // linear; R
    float thickness = 0.0f;              // KHR_materials_volume [m], object space
    TextureUse thickness_texture;        // linear; G
    float attenuation_distance = std::numeric_limits<float>::infinity();  // [m]
    glm::vec3 attenuation_color{1.0f};  // what is left of white light after that distance
    bool operator==(const Material&) const = default;
};

/// Reflectance head on of the material's dielectric part, before the colour's and weight's textures
/// and before it is limited to 1: ((ior - 1) / (ior + 1))^2 * specular_color, 0.04 for the default
/// material (KHR_materials_specular).
glm::vec3 dielectric_reflectance(const Material& material);

/// Whether the dielectric part reflects otherwise than glTF's default one, which needs no storing.
bool has_own_reflectance(const Material& material);

/// A mesh's material where its file names none: glTF's default one, material_of() of it.
constexpr int kDefaultMaterial = -1;

/// A triangle list. Optional arrays are empty or as long as `positions`.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;  // [m], object space
    std::vector<glm::vec3> normals;    // unit; the loader derives flat ones when the file has none
    std::vector<glm::vec4> tangents;   // xyz unit, w handedness +-1; present where needs_tangents()
    std::array<std::vector<glm::vec2>, 2> texcoords;
    std::vector<glm::vec4> colors;       // linear, multiplies base_color
    std::vector<std::uint32_t> indices;  // 3 per triangle, each < positions.size()
    int material = kDefaultMaterial;     // index into Scene::materials
    std::uint32_t revision = 0;          // grows whenever the vertices change
};

/// A mesh put into the world. Transforms stay double until they meet the camera.
struct Instance {
    int mesh = -1;
    glm::dmat4 world_from_object{1.0};
    bool operator==(const Instance&) const = default;
};

enum class LightType : std::uint8_t { point, spot, directional, rectangle, disk, sphere, triangle };

struct SceneLight {
    glm::dvec3 position{0.0};        // [m], world
    glm::dvec3 direction{0, 0, -1};  // unit, the way the light travels; not of points, spheres
    glm::dvec3 side{1, 0, 0};        // unit, perpendicular to direction: the rotation about it
    // Linear Rec. 709; directional [lx], else [cd], of flat lights straight ahead.
    glm::vec3 intensity{1.0f};
    float range = 0.0f;                // [m]; 0: not given, see light_ranges.h
    float inner_cone = 0.0f;           // half angle [rad]
    float outer_cone = 0.7853981634f;  // half angle [rad]
    float width = 0.0f;                // [m], along `side`: of a disk, which may be an ellipse, too
    float height = 0.0f;               // [m], across it
    float skew = 0.0f;                 // [m], of a triangle's second edge along `side`
    float radius = 0.0f;               // [m], of a sphere
    int profile = -1;                  // index into Scene::aimed_profiles; -1: none
    int node = -1;                     // of its file, index into Scene::light_nodes; -1: none
    LightType type = LightType::point;
    bool two_sided = false;       // rectangle, disk, triangle
    bool has_own_range = true;    // false: fill_missing_ranges() set it, see light_ranges.h
    bool follows_camera = false;  // position and direction are in the camera's space
    bool is_sized_point = false;  // a sphere that set_point_size() made of a point
    bool of_surface = false;      // made of an emissive surface: see glowing_surfaces.h
    bool operator==(const SceneLight&) const = default;
};

/// A light's photometric web: its vertical angle 0 is along the light's direction, whatever its
/// type, its vertical angle 90 and horizontal angle 0 along the side, and its peak has the light's
/// intensity.
struct SceneProfile {
    std::size_t web = 0;    // index into Scene::webs
    bool mirrored = false;  // horizontal angles turn the other way
    bool operator==(const SceneProfile&) const = default;
};

/// What a file says of a node that has a light.
struct LightNode {
    std::string name;
    std::string group;  // the text extras.group of the node, else of its light
};

/// A camera of the scene: at world_from_camera's origin, looking down its -Z.
struct SceneCamera {
    std::string name;
    glm::dmat4 world_from_camera{1.0};
    bool orthographic = false;
    double y_fov = 0.785398163397448;                        // vertical [rad], perspective
    double y_extent = 1.0;                                   // half the height [m], orthographic
    double aspect = 0.0;                                     // width / height; 0: the image's
    double z_near = 0.1;                                     // [m]
    double z_far = std::numeric_limits<double>::infinity();  // [m]
    bool operator==(const SceneCamera&) const = default;
};

/// Axis-aligned box in world space [m]; empty when min > max.
struct Box {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};
    bool empty() const { return !(min.x <= max.x); }
    glm::dvec3 center() const { return 0.5 * (min + max); }
    glm::dvec3 size() const { return max - min; }
    /// Corner 0 to 7: its bits 0, 1 and 2 choose `max` in x, y and z.
    glm::dvec3 corner(std::size_t i) const {
        return {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y,
                (i & 4) != 0 ? max.z : min.z};
    }
    void add(const glm::dvec3& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    bool operator==(const Box&) const = default;
};

/// An animation of the scene's file.
struct Clip {
    std::string name;
    double length = 0.0;       // [s], from 0 to its last key
    std::size_t channels = 0;  // that drive a node
    bool plays = false;
    std::string broken{};  // why it cannot play, if so: the error that it would end in
};

/// The surroundings of the middle of a scene's box: see enclosure.h.
enum class SceneKind {
    open,      // neither of the others: terrain, a tree, a crowd
    closed,    // the inside of an object
    interior,  // walls that face the middle
};

/// The parts of a scene that may change while it is rendered. Each number grows with every change
/// of its part.
struct SceneRevisions {
    std::uint32_t geometry = 0;   // vertices of some mesh, see Mesh::revision
    std::uint32_t placement = 0;  // instances
    std::uint32_t lights = 0;     // lights and their aimed profiles
    std::uint32_t cameras = 0;
    std::uint32_t materials = 0;
    bool operator==(const SceneRevisions&) const = default;

    /// The numbers that decide where surfaces are.
    std::array<std::uint32_t, 2> surfaces() const { return {geometry, placement}; }

    /// Those that decide how they look, too.
    std::array<std::uint32_t, 3> looks() const { return {geometry, placement, materials}; }
};

/// Everything that is drawn and lit. The builder checks indices: the renderer trusts
/// them.
struct Scene {
    std::string name;
    std::vector<Image> images;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    // Where the animation drives factors of materials: all with their least, then their greatest.
    std::vector<Material> extremes;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<SceneLight> lights;
    std::vector<PhotometricWeb> webs;          // of the lights with IES profiles
    std::vector<SceneProfile> aimed_profiles;  // one for each of these lights
    std::vector<LightNode> light_nodes;  // by the file's nodes; those without lights are empty
    std::vector<SceneCamera> cameras;
    std::vector<Clip> clips;            // of the file; only those that play move the scene
    std::vector<std::string> variants;  // of the file's materials (KHR_materials_variants)
    Box light_box;                      // where generated lights go; empty: see light_region()
    Box still_box;                      // its bounds at time 0; empty: those of now
    SceneKind kind = SceneKind::open;
    SceneRevisions revisions;
};

/// Box of all instances' triangles in world space, without specks and those that have no area.
Box bounds(const Scene& scene);

/// Vertex normals without a direction (zero, or not finite): they are drawn as +Z of the view.
std::size_t zero_normal_count(const Scene& scene);

/// The box that does not move with the scene's animation: it bounds generated lights, and a framing
/// camera shows it.
Box resting_bounds(const Scene& scene);

/// Triangles that one frame draws: those of every instance.
std::size_t triangle_count(const Scene& scene);

/// The material that a mesh shows.
const Material& material_of(const Scene& scene, const Mesh& mesh);

/// The material that a mesh shows, and where an animation drives materials its extremes.
std::vector<const Material*> looks_of(const Scene& scene, const Mesh& mesh);

/// Its place where rows of the default material follow those of Scene::materials.
std::size_t material_row(const Scene& scene, const Mesh& mesh);

/// Whether what is behind its surfaces is seen through them: alphaMode BLEND, or transmission.
bool is_blended(const Material& material);

/// Such surfaces are drawn as layers over the others; they hide no light, but tint exact shadows.
bool is_blended(const Scene& scene, const Mesh& mesh);

/// Whether any instance has such surfaces.
bool has_blended_surfaces(const Scene& scene);

}  // namespace kilolux
