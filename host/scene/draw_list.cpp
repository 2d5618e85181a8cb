// SPDX-License-Identifier: Apache-2.0
#include "host/scene/draw_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "host/base/error.h"
#include "host/base/point_pair.h"
#include "host/base/system/parallel.h"

namespace kilolux {
namespace {

// A thread finds out whether so many are seen in some 10 us.
constexpr std::size_t kInstancesAtOnce = 32;

constexpr double kUnit = 1e-6;  // deviation from unit length that counts as rounding

float4 to_row(const glm::dvec4& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(v.w)};
}

// Whether the matrix is a rotation, mirrored or not.
bool is_rotation(const glm::dmat3& m) {
    const glm::dmat3 product = glm::transpose(m) * m - glm::dmat3(1.0);
    for (int i = 0; i < 9; ++i) {
        if (!(std::abs(product[i / 3][i % 3]) < kUnit)) return false;
    }
    return true;
}

// The cofactor matrix is the inverse transpose times the determinant, and exists for singular
// matrices, too. It is scaled so that a rotation stays one; the length of a transformed normal does
// not matter.
glm::dmat3 normal_matrix(const glm::dmat3& m, double determinant) {
    glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) largest = std::max(largest, glm::length(cofactor[i]));
    if (!(largest > 0.0)) return glm::dmat3(0.0);
    return cofactor * ((determinant < 0.0 ? -1.0 : 1.0) / largest);
}

// The camera in object space; zero where the inverse of the transform would lose its precision.
glm::dvec3 eye_of(const glm::dmat4& view_from_object) {
    constexpr double kWorstCondition = 64.0;
    const glm::dmat3 linear(view_from_object);
    const glm::dvec3 offset(view_from_object[3]);
    const glm::dvec3 eye = -(glm::inverse(linear) * offset);
    double longest = 0.0;
    for (int i = 0; i < 3; ++i) longest = std::max(longest, glm::length(linear[i]));
    const bool precise = longest * glm::length(eye) <= kWorstCondition * glm::length(offset);
    return precise ? eye : glm::dvec3(0.0);
}

// `m`: view_from_object.
InstanceRow row_of(const glm::dmat4& m, double determinant) {
    InstanceRow out{};
    const glm::dvec3 eye = eye_of(m);
    const glm::vec3 high(eye);
    const glm::vec3 low(lost_by_rounding(eye.x), lost_by_rounding(eye.y), lost_by_rounding(eye.z));
    const glm::dvec3 rest = glm::dvec3(m[3]) + glm::dmat3(m) * (glm::dvec3(high) + glm::dvec3(low));
    const glm::dmat3 linear = glm::transpose(glm::dmat3(m));
    const glm::dmat3 normal = normal_matrix(glm::dmat3(m), determinant);
    const glm::dmat3 normal_rows = glm::transpose(normal);
    for (int i = 0; i < 3; ++i) {
        out.view_from_object[i] = to_row(glm::dvec4(linear[i], rest[i]));
        out.normal_from_object[i] =
            to_row(glm::dvec4(normal_rows[i], i == 0 && determinant < 0.0 ? -1.0 : 1.0));
    }
    out.eye_high = {high.x, high.y, high.z, 0.0f};
    out.eye_low = {low.x, low.y, low.z, 0.0f};
    out.is_similarity = is_rotation(normal) ? 1u : 0u;
    return out;
}

std::size_t triangles_of(const Scene& scene, int mesh) {
    return scene.meshes[static_cast<std::size_t>(mesh)].indices.size() / 3;
}

// Numbers casters, the triangles of all instances, along the instances: before draws are sorted.
void number_casters(std::vector<Draw>& draws, const Scene& scene) {
    std::size_t first = 0, next = 0;  // the next instance, and its first triangle
    for (Draw& draw : draws) {
        while (next < static_cast<std::size_t>(draw.instance)) {
            first += triangles_of(scene, scene.instances[next++].mesh);
        }
        draw.row.first_caster = static_cast<uint>(first);
    }
}

// Ids ascend along the draws.
void number_triangles(std::vector<Draw>& draws, const Scene& scene) {
    std::uint64_t first = 0;
    for (Draw& draw : draws) {
        draw.row.first_triangle = static_cast<uint>(first);
        draw.row.mesh = static_cast<uint>(draw.mesh);
        first += triangles_of(scene, draw.mesh);
        if (first >= std::numeric_limits<uint>::max()) {
            throw Error("scene '" + scene.name +
                        "': more than 4294967294 triangles are in view, which ids cannot name");
        }
    }
}

// The transform to a system in the camera's place, with the world's axes.
glm::dmat4 from_camera(const Camera& camera, glm::dmat4 world_from_object) {
    world_from_object[3] -= glm::dvec4(camera.position, 0.0);
    return world_from_object;
}

glm::dmat4 view_axes(const Camera& camera) {
    return glm::dmat4(glm::transpose(camera.world_from_view));
}

using Corners = std::array<glm::dvec4, 8>;

Corners corners_of(const Box& box, const glm::dmat4& view_from_box) {
    Corners corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = view_from_box * glm::dvec4(box.corner(i), 1.0);
    }
    return corners;
}

Corners clipped(Corners corners, const glm::dmat4& clip_from_view) {
    for (glm::dvec4& corner : corners) corner = clip_from_view * corner;
    return corners;
}

// Whether all corners, in clip space, lie outside one plane of the frustum, by more than what
// float32 vertices and the rasteriser's snapping can move them. Without branches, which no
// processor foresees here.
bool outside(const Corners& corners) {
    constexpr double kSlack = 1e-4;
    unsigned planes = 0x3f;  // a bit for each that all corners so far are outside of
    for (const glm::dvec4& c : corners) {
        const double slack =
            -kSlack * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z) + std::abs(c.w));
        const std::array<double, 6> inside = {c.w - c.x, c.w + c.x, c.w - c.y,
                                              c.w + c.y, c.w - c.z, c.z};
        unsigned outside_of = 0;
        for (unsigned plane = 0; plane < 6; ++plane) {
            outside_of |= static_cast<unsigned>(inside[plane] < slack) << plane;
        }
        planes &= outside_of;
    }
    return planes != 0;
}

// Where the box of the corners, in clip space, may be seen.
ScreenBox screen_box(const Corners& corners, const glm::dvec2& size) {
    constexpr double kMargin = 2.0;  // [pixel] as in outside(), and more
    ScreenBox out;
    std::swap(out.least, out.most);
    for (const glm::dvec4& c : corners) {
        if (!(c.w > kUnit * (std::abs(c.x) + std::abs(c.y)))) return {};
        const glm::dvec2 pixel = (glm::dvec2(c.x, -c.y) / c.w * 0.5 + 0.5) * size;
        out.least = glm::min(out.least, pixel - kMargin);
        out.most = glm::max(out.most, pixel + kMargin);
    }
    return out;
}

Box box_of_vertices(const Mesh& mesh) {
    Box box;
    for (const glm::vec3& position : mesh.positions) box.add(position);
    return box;
}

// Sorts their places first: draws are large.
void sort_draws(std::vector<Draw>& draws, DrawOrder order) {
    if (order == DrawOrder::scene) return;
    std::vector<std::size_t> places(draws.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::ranges::stable_sort(places, [&](std::size_t a, std::size_t b) {
        const bool forwards = order == DrawOrder::front_to_back;
        return forwards ? draws[a].depth < draws[b].depth : draws[a].depth > draws[b].depth;
    });
    std::vector<Draw> sorted;
    sorted.reserve(draws.size());
    for (const std::size_t place : places) sorted.push_back(draws[place]);
    draws = std::move(sorted);
}

}  // namespace

// What visible() is asked for.
struct DrawList::DrawRequest {
    const Camera& camera;
    glm::dmat4 view_from_camera;  // turns the axes
    glm::dmat4 clip_from_view;
    glm::dvec2 size;  // of the picture [pixel]
    bool blended;
    DrawOrder order;
    const OpenTiles* open;
};

uint drawn_triangles(std::span<const Draw> draws, const Scene& scene) {
    if (draws.empty()) return 0;
    const Draw& last = draws.back();
    return last.row.first_triangle + static_cast<uint>(triangles_of(scene, last.mesh));
}

DrawList::DrawList(const Scene& scene) : scene_(scene) {
    for (const Mesh& mesh : scene.meshes) {
        MeshBox& out = boxes_.emplace_back();
        out.box = box_of_vertices(mesh);
        out.revision = mesh.revision;
        out.blended = is_blended(scene, mesh);
    }
}

void DrawList::refresh_boxes() const {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (boxes_[i].revision == scene_.meshes[i].revision) continue;
        boxes_[i].box = box_of_vertices(scene_.meshes[i]);
        boxes_[i].revision = scene_.meshes[i].revision;
    }
}

// The draw of an instance, if the camera may see it; its ids are numbered later.
std::optional<Draw> DrawList::draw_of(std::size_t number, const DrawRequest& request) const {
    const Instance& instance = scene_.instances[number];
    const MeshBox& mesh = boxes_[static_cast<std::size_t>(instance.mesh)];
    if (mesh.blended != request.blended || mesh.box.empty()) return {};
    const glm::dmat4 transform =
        request.view_from_camera * from_camera(request.camera, instance.world_from_object);
    const Corners corners = corners_of(mesh.box, transform);
    const Corners clip_corners = clipped(corners, request.clip_from_view);
    if (outside(clip_corners)) return {};
    // Opaque draws need it only to skip closed tiles.
    const ScreenBox screen = request.blended || request.open != nullptr
                                 ? screen_box(clip_corners, request.size)
                                 : ScreenBox();
    if (request.open != nullptr && !request.open->touches(screen.least, screen.most)) return {};
    double nearest = std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (const glm::dvec4& corner : corners) {
        nearest = std::min(nearest, -corner.z);
        sum -= corner.z;
    }
    if (request.order == DrawOrder::back_to_front) nearest = sum / 8.0;
    const double determinant = glm::determinant(glm::dmat3(transform));
    return Draw{static_cast<int>(number), instance.mesh, nearest,
                determinant < 0.0,        screen,        row_of(transform, determinant)};
}

std::vector<Draw> DrawList::visible(const Camera& camera, int width, int height, bool blended,
                                    DrawOrder order, const OpenTiles* open) const {
    refresh_boxes();
    const DrawRequest request{camera,
                              view_axes(camera),
                              clip_from_view(camera, width, height),
                              {width, height},
                              blended,
                              order,
                              open};
    const std::size_t count = scene_.instances.size();
    std::vector<std::vector<Draw>> parts((count + kInstancesAtOnce - 1) / kInstancesAtOnce);
    parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        const std::size_t begin = part * kInstancesAtOnce;
        for (std::size_t i = begin; i < std::min(begin + kInstancesAtOnce, count); ++i) {
            if (auto draw = draw_of(i, request)) parts[part].push_back(*draw);
        }
    });
    std::vector<Draw> draws;
    for (const std::vector<Draw>& part : parts) draws.insert(draws.end(), part.begin(), part.end());
    number_casters(draws, scene_);
    sort_draws(draws, order);
    number_triangles(draws, scene_);
    return draws;
}

glm::dmat4 view_from_object(const Camera& camera, const glm::dmat4& world_from_object) {
    return view_axes(camera) * from_camera(camera, world_from_object);
}

}  // namespace kilolux
