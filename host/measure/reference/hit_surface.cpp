// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/hit_surface.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/scene/material_table.h"

namespace kilolux {
namespace {

const Instance& instance_of(const SurfaceHit& hit) {
    return hit.scene.instances[hit.triangle.instance];
}

// -1 for a mirroring transform.
double orientation(const SurfaceHit& hit) {
    return glm::determinant(glm::dmat3(instance_of(hit).world_from_object)) < 0.0 ? -1.0 : 1.0;
}

glm::dvec3 corner_normal(const BvhTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    return glm::cross(b - a, c - a);
}

// A vertex attribute at the hit, mapped at the corners; `weights` may also be their derivatives.
template <class Result, class Attribute, class Map = std::identity>
Result interpolated(const SurfaceHit& hit, const std::vector<Attribute>& values,
                    const std::array<double, 3>& weights, const Map& map = {}) {
    const Mesh& mesh = mesh_of(hit);
    const std::size_t first = 3 * static_cast<std::size_t>(hit.triangle.triangle);
    Result sum(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        sum += weights[i] * Result(map(values[mesh.indices[first + i]]));
    }
    return sum;
}

// Change of the barycentric weights when the hit point moves by `step` in the triangle's plane.
std::array<double, 3> weight_change(const BvhTriangle& triangle, const glm::dvec3& step) {
    const auto& [a, b, c] = triangle.corners;
    const glm::dvec3 n = corner_normal(triangle);
    const double n2 = glm::dot(n, n);
    const double of_b = glm::dot(glm::cross(c - a, n), step) / n2;
    const double of_c = glm::dot(glm::cross(n, b - a), step) / n2;
    return {-of_b - of_c, of_b, of_c};
}

// Step of the hit point when the ray's origin and direction change (Igehy 1999, equations 10..12).
glm::dvec3 transferred(const SurfaceHit& hit, const glm::dvec3& origin_step,
                       const glm::dvec3& direction_step) {
    const glm::dvec3 n = corner_normal(hit.triangle);
    const glm::dvec3 step = origin_step + hit.hit.t * direction_step;
    return step - hit.ray.direction * (glm::dot(n, step) / glm::dot(n, hit.ray.direction));
}

std::array<TextureFootprint, 2> footprints(const SurfaceHit& hit) {
    const auto dx =
        weight_change(hit.triangle, transferred(hit, hit.ray.origin_dx, hit.ray.direction_dx));
    const auto dy =
        weight_change(hit.triangle, transferred(hit, hit.ray.origin_dy, hit.ray.direction_dy));
    std::array<TextureFootprint, 2> out;
    for (std::size_t set = 0; set < 2; ++set) {
        const auto& texcoords = mesh_of(hit).texcoords[set];
        if (texcoords.empty()) continue;
        out[set] = {.uv = interpolated<glm::dvec2>(hit, texcoords, hit.hit.weights),
                    .uv_dx = interpolated<glm::dvec2>(hit, texcoords, dx),
                    .uv_dy = interpolated<glm::dvec2>(hit, texcoords, dy)};
    }
    return out;
}

using Footprints = std::array<TextureFootprint, 2>;

glm::dvec4 texel(const SurfaceHit& hit, int use, const Footprints& uv) {
    const MaterialMap& map = kMaterialMaps[static_cast<std::size_t>(use)];
    return hit.textures.sample(material_of(hit).*map.member,
                               map.srgb ? TextureEncoding::srgb : TextureEncoding::linear, uv);
}

glm::dvec4 base_color(const SurfaceHit& hit, const Footprints& uv) {
    const Material& material = material_of(hit);
    glm::dvec4 color = glm::dvec4(material.base_color) * texel(hit, USE_BASE_COLOR, uv);
    const auto& colors = mesh_of(hit).colors;
    if (!colors.empty()) color *= interpolated<glm::dvec4>(hit, colors, hit.hit.weights);
    return color;
}

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
}

// Weighted sum of the corners' `values`, each transformed to world space and normalised. The sum is
// not normalised: normal maps use the basis as interpolated (MikkTSpace).
template <class Attribute>
glm::dvec3 interpolated_direction(const SurfaceHit& hit, const std::vector<Attribute>& values,
                                  const glm::dmat3& world_from_object) {
    return interpolated<glm::dvec3>(hit, values, hit.hit.weights, [&](const Attribute& object) {
        return unit_or_zero(world_from_object * glm::dvec3(object));
    });
}

// The cofactor matrix is the inverse transpose without the division by the determinant, so it also
// exists for transforms that flatten a mesh.
glm::dvec3 smooth_normal(const SurfaceHit& hit) {
    const auto& normals = mesh_of(hit).normals;
    if (normals.empty()) return unit_or_zero(corner_normal(hit.triangle) * orientation(hit));
    const glm::dmat3 m(instance_of(hit).world_from_object);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    return interpolated_direction(hit, normals, cofactors * orientation(hit));
}

// The basis of tangent space, as interpolated, unnormalised; zero columns without tangents.
glm::dmat3 tangent_space(const SurfaceHit& hit) {
    const glm::dvec3 normal = smooth_normal(hit);
    const auto& tangents = mesh_of(hit).tangents;
    if (tangents.empty()) return {glm::dvec3(0.0), glm::dvec3(0.0), normal};
    const glm::dmat3 world_from_object(instance_of(hit).world_from_object);
    const glm::dvec3 tangent = interpolated_direction(hit, tangents, world_from_object);
    const double w = interpolated<glm::dvec4>(hit, tangents, hit.hit.weights).w;
    return {tangent, glm::cross(normal, tangent) * (w * orientation(hit)), normal};
}

// The normal on the side that is seen, by the map of a use, whose x and y are scaled.
glm::dvec3 mapped_normal(const SurfaceHit& hit, const Footprints& uv, int use, double scale) {
    const double side = front_facing(hit) ? 1.0 : -1.0;
    const MaterialMap& of_use = kMaterialMaps[static_cast<std::size_t>(use)];
    if (!(material_of(hit).*of_use.member).present() || mesh_of(hit).tangents.empty()) {
        return unit_or_zero(smooth_normal(hit)) * side;
    }
    const glm::dvec3 map = 2.0 * glm::dvec3(texel(hit, use, uv)) - 1.0;
    const glm::dvec3 scaled(map.x * scale, map.y * scale, map.z);
    return unit_or_zero(tangent_space(hit) * scaled) * side;
}

// The direction of KHR_materials_anisotropy in the plane of the normal that is seen.
void set_anisotropy(const SurfaceHit& hit, const Footprints& uv, SurfaceSample& out) {
    const Material& m = material_of(hit);
    glm::dvec3 map(1.0, 0.0, 1.0);
    if (m.anisotropy_texture.present()) {
        const glm::dvec4 of_texture = texel(hit, USE_ANISOTROPY, uv);
        map = {2.0 * of_texture.x - 1.0, 2.0 * of_texture.y - 1.0, of_texture.z};
    }
    const double c = std::cos(double{m.anisotropy_rotation});
    const double s = std::sin(double{m.anisotropy_rotation});
    const glm::dvec3 turned(c * map.x - s * map.y, s * map.x + c * map.y, 0.0);
    const glm::dvec3 line = tangent_space(hit) * turned;
    out.tangent = unit_or_zero(line - glm::dot(line, out.normal) * out.normal);
    if (out.tangent != glm::dvec3(0.0)) out.anisotropy = m.anisotropy_strength * map.z;
}

void set_coat(const SurfaceHit& hit, const Footprints& uv, SurfaceSample& out) {
    const Material& m = material_of(hit);
    out.coat = m.clearcoat * texel(hit, USE_CLEARCOAT, uv).x;
    out.coat_roughness = m.clearcoat_roughness * texel(hit, USE_CLEARCOAT_ROUGHNESS, uv).y;
    out.coat_normal = mapped_normal(hit, uv, USE_CLEARCOAT_NORMAL, m.clearcoat_normal_scale);
}

void set_sheen(const SurfaceHit& hit, const Footprints& uv, SurfaceSample& out) {
    const Material& m = material_of(hit);
    out.sheen = glm::dvec3(m.sheen_color) * glm::dvec3(texel(hit, USE_SHEEN_COLOR, uv));
    out.sheen_roughness = m.sheen_roughness * texel(hit, USE_SHEEN_ROUGHNESS, uv).w;
}

// The path's length is the thickness, in the instance's root mean square scale.
void set_transmission(const SurfaceHit& hit, const Footprints& uv, SurfaceSample& out) {
    const Material& m = material_of(hit);
    out.transmission = m.transmission * texel(hit, USE_TRANSMISSION, uv).x;
    const glm::dmat3 turn(instance_of(hit).world_from_object);
    const double squares =
        glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) + glm::dot(turn[2], turn[2]);
    const double length = m.thickness * texel(hit, USE_THICKNESS, uv).y * std::sqrt(squares / 3.0);
    const glm::dvec3 color = glm::max(glm::dvec3(m.attenuation_color), 1e-30);
    out.tint =
        glm::pow(color, glm::dvec3(length / std::max(double{m.attenuation_distance}, 1e-30)));
}

void set_reflectance(const SurfaceHit& hit, const Footprints& uv, SurfaceSample& out) {
    const Material& m = material_of(hit);
    const double root = (double{m.ior} - 1.0) / (double{m.ior} + 1.0);
    const glm::dvec4 color = texel(hit, USE_SPECULAR_COLOR, uv);
    out.specular_f90 = double{m.specular} * texel(hit, USE_SPECULAR, uv).w;
    const glm::dvec3 f0 = root * root * glm::dvec3(m.specular_color) * glm::dvec3(color);
    out.specular = glm::min(f0, glm::dvec3(1.0)) * out.specular_f90;
}

void apply_unlit(SurfaceSample& surface) {
    surface.kind = SurfaceKind::unlit;
    surface.emissive = surface.albedo;
    surface.albedo = glm::dvec3(0.0);
    surface.coat = 0.0;
    surface.sheen = glm::dvec3(0.0);
    surface.transmission = 0.0;
}

}  // namespace

const Mesh& mesh_of(const SurfaceHit& hit) {
    return hit.scene.meshes[static_cast<std::size_t>(instance_of(hit).mesh)];
}

const Material& material_of(const SurfaceHit& hit) {
    static const Material kDefault;
    const int index = mesh_of(hit).material;
    return index < 0 ? kDefault : hit.scene.materials[static_cast<std::size_t>(index)];
}

bool front_facing(const SurfaceHit& hit) {
    return glm::dot(corner_normal(hit.triangle), hit.ray.direction) * orientation(hit) < 0.0;
}

glm::dvec4 base_color_at(const SurfaceHit& hit) { return base_color(hit, footprints(hit)); }

double coverage_at(const SurfaceHit& hit) {
    const Material& material = material_of(hit);
    if (material.alpha_mode == AlphaMode::opaque) return 1.0;
    const double alpha = base_color_at(hit).w;
    if (material.alpha_mode == AlphaMode::blend) return std::clamp(alpha, 0.0, 1.0);
    return alpha >= double{material.alpha_cutoff} ? 1.0 : 0.0;
}

SurfaceSample surface_at(const SurfaceHit& hit) {
    const Material& material = material_of(hit);
    const Footprints uv = footprints(hit);
    SurfaceSample out;
    out.kind = SurfaceKind::lit;
    out.albedo = glm::dvec3(base_color(hit, uv));
    out.normal = mapped_normal(hit, uv, USE_NORMAL, material.normal_scale);
    const glm::dvec4 metallic_roughness = texel(hit, USE_METALLIC_ROUGHNESS, uv);
    out.roughness = material.roughness * metallic_roughness.y;
    out.metallic = material.metallic * metallic_roughness.z;
    const double occlusion = texel(hit, USE_OCCLUSION, uv).x;
    out.occlusion = 1.0 + material.occlusion_strength * (occlusion - 1.0);
    out.emissive = glm::dvec3(material.emissive) * glm::dvec3(texel(hit, USE_EMISSIVE, uv));
    set_reflectance(hit, uv, out);
    set_coat(hit, uv, out);
    set_sheen(hit, uv, out);
    set_anisotropy(hit, uv, out);
    set_transmission(hit, uv, out);
    out.blended = is_blended(hit.scene, mesh_of(hit));
    out.coverage = coverage_at(hit);
    if (material.unlit) apply_unlit(out);
    return out;
}

}  // namespace kilolux
