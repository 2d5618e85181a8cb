// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/shadow_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "host/base/error.h"
#include "host/scene/rows/material_row.h"
#include "host/surfaces/shadow_hierarchy.h"

namespace kilolux {
namespace {

constexpr std::string_view kShadowOwner = "shadows";

// Negative where it mirrors.
float scale_of(const Instance& instance) {
    const glm::dmat3 m(instance.world_from_object);
    const double squares = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
    return static_cast<float>(std::copysign(std::sqrt(squares / 3.0), glm::determinant(m)));
}

// Vertex colours and texture coordinates of a masked triangle.
MaskedCaster masked_caster(const Scene& scene, const Mesh& mesh, std::size_t triangle,
                           uint number) {
    const Material& material = material_of(scene, mesh);
    const auto& set = mesh.texcoords.at(texture_use(material, USE_BASE_COLOR).uv_set == 1 ? 1 : 0);
    MaskedCaster out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t vertex = mesh.indices[3 * triangle + i];
        out.u[i] = set.empty() ? 0.0f : set[vertex].x;
        out.v[i] = set.empty() ? 0.0f : set[vertex].y;
        out.alpha[i] = mesh.colors.empty() ? 1.0f : mesh.colors[vertex].w;
    }
    out.triangle = number;
    out.material = static_cast<uint>(material_row(scene, mesh));
    return out;
}

TintCaster tint_caster(const Mesh& mesh, std::size_t triangle) {
    TintCaster out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t vertex = mesh.indices[3 * triangle + i];
        const auto [a, b] = mesh.texcoords;
        if (!a.empty()) std::tie(out.u0[i], out.v0[i]) = std::pair(a[vertex].x, a[vertex].y);
        if (!b.empty()) std::tie(out.u1[i], out.v1[i]) = std::pair(b[vertex].x, b[vertex].y);
        const glm::vec4 color = mesh.colors.empty() ? glm::vec4(1.0f) : mesh.colors[vertex];
        out.red[i] = color.x;
        out.green[i] = color.y;
        out.blue[i] = color.z;
        out.alpha[i] = color.w;
    }
    return out;
}

// All casters on their way to the device.
struct Casters {
    std::vector<float> triangles;  // also those that cast no shadows, which rays end at
    std::vector<CasterBox> boxes, tint_boxes;
    std::vector<MaskedCaster> masked;
    std::vector<TintCaster> tinting;
    float extent = 0.0f;
};

// The box of a triangle, wider by SHADOW_PAD; false where it is not finite.
bool padded_box(const float* corners, CasterBox& box) {
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax({corners[axis], corners[3 + axis], corners[6 + axis]});
        box.low[axis] = low;
        box.high[axis] = high;
        largest = std::max({largest, std::abs(low), std::abs(high)});
        if (!std::isfinite(corners[axis] + corners[3 + axis] + corners[6 + axis])) return false;
    }
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] -= largest * SHADOW_PAD;
        box.high[axis] += largest * SHADOW_PAD;
    }
    return true;
}

void add_triangle(const float* corners, uint child, bool tints, Casters& out) {
    CasterBox box;
    box.child = SHADOW_LEAF | child;
    if (!padded_box(corners, box)) return;
    for (int i = 0; i < 3; ++i) {
        const float* p = corners + std::size_t{3} * static_cast<std::size_t>(i);
        out.extent = std::max(out.extent, std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]));
    }
    (tints ? out.tint_boxes : out.boxes).push_back(box);
}

void add_instance(const Scene& scene, const Instance& instance, const glm::dvec3& anchor,
                  Casters& out) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const bool tints = is_blended(scene, mesh);
    const bool masked = material_of(scene, mesh).alpha_mode == AlphaMode::mask;
    const float scale = scale_of(instance);
    glm::dmat4 shadow_from_object = instance.world_from_object;
    shadow_from_object[3] -= glm::dvec4(anchor, 0.0);
    std::vector<glm::vec3> positions;
    positions.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) {
        positions.emplace_back(glm::dvec3(shadow_from_object * glm::dvec4(glm::dvec3(p), 1.0)));
    }
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) {
        const auto number = static_cast<uint>(out.triangles.size() / 9);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const glm::vec3& p = positions[mesh.indices[3 * i + corner]];
            out.triangles.insert(out.triangles.end(), {p.x, p.y, p.z});
        }
        uint child = number;
        if (tints) {
            child = static_cast<uint>(out.tinting.size());
            out.tinting.push_back(tint_caster(mesh, i));
            out.tinting.back().triangle = number;
            out.tinting.back().material = static_cast<uint>(material_row(scene, mesh));
            out.tinting.back().scale = scale;
        } else if (masked) {
            child = SHADOW_MASKED | static_cast<uint>(out.masked.size());
            out.masked.push_back(masked_caster(scene, mesh, i, number));
        }
        add_triangle(&out.triangles[std::size_t{9} * number], child, tints, out);
    }
}

// The middle of the casters' box.
glm::dvec3 anchor_of(const Scene& scene) {
    const Box box = bounds(scene);
    return box.empty() ? glm::dvec3(0.0) : 0.5 * (box.min + box.max);
}

float4 row(const glm::dvec3& axis, double offset) {
    return {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z),
            static_cast<float>(offset)};
}

}  // namespace

std::uint64_t shadow_scene_bytes(const Scene& scene) {
    // A node has four children or more, so there is at most a node for three triangles.
    constexpr std::uint64_t kTriangle = 9 * sizeof(float) + sizeof(ShadowNode) / 3;
    std::uint64_t bytes = triangle_count(scene) * kTriangle;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const std::uint64_t count = mesh.indices.size() / 3;
        if (is_blended(scene, mesh)) {
            bytes += count * sizeof(TintCaster);
        } else if (material_of(scene, mesh).alpha_mode == AlphaMode::mask) {
            bytes += count * sizeof(MaskedCaster);
        }
    }
    return bytes;
}

ShadowScene::ShadowScene(const Gpu& gpu, const Scene& scene)
    : gpu_(gpu),
      scene_(scene),
      nodes_(gpu, kShadowOwner),
      triangles_(gpu, kShadowOwner),
      masked_(gpu, kShadowOwner),
      tinting_(gpu, kShadowOwner) {
    build();
}

void ShadowScene::build() {
    revision_ = scene_.revisions.surfaces();
    ++built_;
    const std::uint64_t count = triangle_count(scene_);
    if (count > SHADOW_NUMBER) {
        throw Error(fmt::format("shadows: scene '{}' has {} triangles; at most {} can cast shadows",
                                scene_.name, count, SHADOW_NUMBER));
    }
    anchor_ = anchor_of(scene_);
    Casters all;
    all.triangles.reserve(9 * count);
    all.boxes.reserve(count);
    for (const Instance& instance : scene_.instances) add_instance(scene_, instance, anchor_, all);
    extent_ = all.extent;
    std::vector<ShadowNode> nodes = build_shadow_hierarchy(all.boxes);
    levels_ = level_count(nodes);
    tint_root_ = 0;
    if (!all.tint_boxes.empty()) {
        tint_root_ = static_cast<uint>(nodes.size());
        const std::vector<ShadowNode> tinting = build_shadow_hierarchy(all.tint_boxes);
        nodes.insert(nodes.end(), tinting.begin(), tinting.end());
    }
    upload<ShadowNode>(gpu_, nodes_.reserve(nodes.size()), nodes);
    upload<float>(gpu_, triangles_.reserve(all.triangles.size()), all.triangles);
    if (!all.masked.empty()) {
        upload<MaskedCaster>(gpu_, masked_.reserve(all.masked.size()), all.masked);
    }
    if (!all.tinting.empty()) {
        upload<TintCaster>(gpu_, tinting_.reserve(all.tinting.size()), all.tinting);
    }
}

ShadowCasters ShadowScene::casters() {
    if (revision_ != scene_.revisions.surfaces()) build();
    ShadowCasters out;
    out.nodes = nodes_.get();
    out.triangles = triangles_.get();
    out.masked = masked_.get();
    out.tinting = tinting_.get();
    return out;
}

ShadowView ShadowScene::view(const Camera& camera) const {
    const glm::dmat3 world_from_view(camera.world_from_view);
    const glm::dmat3 rows = glm::transpose(world_from_view);
    const glm::dvec3 offset = camera.position - anchor_;
    ShadowView out{};
    for (int i = 0; i < 3; ++i) out.shadow_from_view[i] = row(rows[i], offset[i]);
    out.extent = extent_;
    out.levels = levels_;
    out.tint_root = tint_root_;
    return out;
}

}  // namespace kilolux
