// SPDX-License-Identifier: Apache-2.0
#include "host/scene/look_around.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

constexpr int kCells = LookAround::kCells;
constexpr std::size_t kTrianglesAtOnce = 8192;
constexpr double kMostlyShare = 0.5;

// The axes of a cube's face: two across it, one through it. The first four faces are level, their
// rows from below upwards.
struct Face {
    glm::dvec3 right, up, out;
};
const Face kFaces[6] = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
                        {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};

double centre_of(int cell) { return (2.0 * cell + 1.0) / kCells - 1.0; }

// Cells [first, last] that the interval of u in [-1, 1] can touch.
struct Cells {
    int first, last;
};
Cells cells_between(double lo, double hi) {
    const auto cell = [](double u) {
        return static_cast<int>(std::floor((std::clamp(u, -2.0, 2.0) + 1.0) * 0.5 * kCells));
    };
    return {std::max(cell(lo) - 1, 0), std::min(cell(hi) + 1, kCells - 1)};
}

// Of three values, or all of [-1, 1] where the triangle reaches behind the eye.
Cells cells_of(const double (&across)[3], const double (&depth)[3]) {
    if (std::min({depth[0], depth[1], depth[2]}) <= 0.0) return {0, kCells - 1};
    const double u[3] = {across[0] / depth[0], across[1] / depth[1], across[2] / depth[2]};
    return cells_between(std::min({u[0], u[1], u[2]}), std::max({u[0], u[1], u[2]}));
}

bool all_beyond(const double (&across)[3], const double (&depth)[3], double sign) {
    return sign * across[0] > depth[0] && sign * across[1] > depth[1] &&
           sign * across[2] > depth[2];
}

bool is_seen_through(const Scene& scene, const Mesh& mesh) {
    return mesh.material >= 0 &&
           scene.materials[static_cast<std::size_t>(mesh.material)].alpha_mode == AlphaMode::blend;
}

}  // namespace

// Each ray against the triangle: Moeller and Trumbore 1997, with the eye at the origin.
void LookAround::add_to_face(Hits& hits, int face, const glm::dvec3 (&corners)[3]) {
    const Face& axes = kFaces[face];
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = glm::dot(corners[i], axes.right);
        y[i] = glm::dot(corners[i], axes.up);
        z[i] = glm::dot(corners[i], axes.out);
    }
    if (std::max({z[0], z[1], z[2]}) <= 0.0 || all_beyond(x, z, 1.0) || all_beyond(x, z, -1.0) ||
        all_beyond(y, z, 1.0) || all_beyond(y, z, -1.0)) {
        return;
    }
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double plane = glm::dot(normal, corners[0]);
    const Cells columns = cells_of(x, z);
    const Cells rows = cells_of(y, z);
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int column = columns.first; column <= columns.last; ++column) {
            const glm::dvec3 ray =
                axes.out + centre_of(column) * axes.right + centre_of(row) * axes.up;
            const double along = glm::dot(normal, ray);
            const double t = plane / along;
            if (!(t > 0.0) || !std::isfinite(t)) continue;
            const glm::dvec3 p = t * ray;
            bool inside = true;
            for (int i = 0; i < 3 && inside; ++i) {
                const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
                inside = glm::dot(glm::cross(edge, p - corners[i]), normal) >= 0.0;
            }
            if (!inside) continue;
            Hit& hit = hits[static_cast<std::size_t>((face * kCells + row) * kCells + column)];
            hit = std::min(
                hit, Hit{static_cast<float>(t * glm::length(ray)), along < 0.0 ? 1.0f : -1.0f});
        }
    }
}

LookAround::LookAround(const Scene& scene, const glm::dvec3& eye)
    : hits_(std::size_t{6} * kCells * kCells) {
    tbb::enumerable_thread_specific<Hits> found(hits_);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (is_seen_through(scene, mesh)) continue;
        const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0.0;
        const auto corner = [&](std::size_t index) {
            const glm::dvec4 p(mesh.positions[mesh.indices[index]], 1.0);
            return glm::dvec3(instance.world_from_object * p) - eye;
        };
        const auto look = [&](const tbb::blocked_range<std::size_t>& range) {
            Hits& hits = found.local();
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const glm::dvec3 corners[3] = {corner(3 * i), corner(3 * i + (mirrored ? 2 : 1)),
                                               corner(3 * i + (mirrored ? 1 : 2))};
                for (int face = 0; face < 6; ++face) add_to_face(hits, face, corners);
            }
        };
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, mesh.indices.size() / 3, kTrianglesAtOnce), look);
    }
    for (const Hits& hits : found) {
        std::transform(hits_.begin(), hits_.end(), hits.begin(), hits_.begin(),
                       [](const Hit& a, const Hit& b) { return std::min(a, b); });
    }
}

double LookAround::share(float side) const {
    const auto count = std::count_if(hits_.begin(), hits_.end(),
                                     [side](const Hit& hit) { return hit.side == side; });
    return static_cast<double>(count) / static_cast<double>(hits_.size());
}

std::vector<LookAround::Level> LookAround::level() const {
    std::vector<Level> out;
    for (int face = 0; face < 4; ++face) {
        for (int column = 0; column < kCells; ++column) {
            const glm::dvec3 ray = kFaces[face].out + centre_of(column) * kFaces[face].right;
            const auto distance = [&](int row) {
                return hits_[static_cast<std::size_t>((face * kCells + row) * kCells + column)]
                    .distance;
            };
            out.push_back(
                {glm::normalize(ray), std::min(distance(kCells / 2 - 1), distance(kCells / 2))});
        }
    }
    return out;
}

double LookAround::below() const {
    const auto cell = [&](int row, int column) {
        return hits_[static_cast<std::size_t>((5 * kCells + row) * kCells + column)].distance;
    };
    constexpr int kMiddle = kCells / 2;
    return std::min(std::min(cell(kMiddle - 1, kMiddle - 1), cell(kMiddle - 1, kMiddle)),
                    std::min(cell(kMiddle, kMiddle - 1), cell(kMiddle, kMiddle)));
}

SceneKind scene_kind(const Scene& scene, const Box& box) {
    if (box.empty()) return SceneKind::open;
    const LookAround around(scene, box.center());
    if (around.fronts() >= kMostlyShare) return SceneKind::interior;
    return around.backs() >= kMostlyShare ? SceneKind::closed : SceneKind::open;
}

}  // namespace kilolux
