// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// A point of a surface under construction; uv in metres along the surface.
struct SurfacePoint {
    glm::dvec3 position{0.0};  // [m]
    glm::dvec3 normal{0.0};    // outwards; any length but 0
    glm::dvec2 uv{0.0};        // [m]
};

using Point2 = glm::dvec2;  // of a profile [m]

/// A polyline to sweep: outside is to the right of its direction, so a profile that goes up has its
/// outside at larger x. Corners sharper than `crease_rad` stay sharp.
struct Profile {
    std::vector<Point2> points;
    double crease_rad = 0.6;
};

/// Where a swept profile is: point (x, y) of it goes to origin + x * axis_x + y * axis_y.
struct SweepFrame {
    glm::dvec3 origin{0.0};
    glm::dvec3 axis_x{1, 0, 0};  // longer than 1 at a mitre
    glm::dvec3 axis_y{0, 1, 0};
    glm::dvec3 normal_x{1, 0, 0};  // unit: the direction of the normal's x
    double along = 0.0;            // [m] on the path: u
};

/// Collects triangles. Every face is wound counter-clockwise about its vertices' normals, and
/// triangles without area are left out, so a shape only needs correct normals.
class MeshBuilder {
 public:
    /// A surface of (columns + 1) x (rows + 1) points; `at` gets u, v in [0, 1].
    void patch(int columns, int rows, const std::function<SurfacePoint(double u, double v)>& at);

    /// As patch(), of positions only: the normal is that of the surface, on the side from which u
    /// grows to the right and v upwards, or on the other when `flipped`; uv = (u, -v) * `size_m`.
    void smooth_patch(int columns, int rows,
                      const std::function<glm::dvec3(double u, double v)>& at, glm::dvec2 size_m,
                      bool flipped = false);

    /// Four corners in order round the quad; flat normal towards `facing`; uv from the two longest
    /// axes.
    void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
              const glm::dvec3& facing);

    /// A rectangle at height y from (x, z) = `low` to `high`; `up` is 1 for a floor, -1 for a
    /// ceiling.
    void level(const glm::dvec2& low, const glm::dvec2& high, double y, double up = 1.0);

    /// A rectangle in the plane of constant z from (x, y) = `low` to `high`, seen from `facing` *
    /// z.
    void wall(const glm::dvec2& low, const glm::dvec2& high, double z, double facing);

    /// An axis-aligned box of six faces.
    void box(const glm::dvec3& low, const glm::dvec3& high);

    /// A profile carried along frames (at least two); smooth along the path.
    void sweep(const Profile& profile, std::span<const SweepFrame> frames);

    /// A profile of (radius, height) turned about the y axis through `center`.
    void lathe(const Profile& profile, int segments, const glm::dvec3& center = glm::dvec3(0.0));

    /// A round tube of `radius` along a path, without caps.
    void tube(std::span<const glm::dvec3> path, double radius, int sides);

    /// Everything of `other`, transformed.
    void append(const MeshBuilder& other, const glm::dmat4& to_here = glm::dmat4(1.0));

    /// The same shape, `by` away.
    MeshBuilder moved(const glm::dvec3& by) const;

    /// The mesh for a material; uv = metres * `uv_per_metre`, tangents only when the material has a
    /// normal map.
    Mesh build(std::string name, int material, double uv_per_metre, bool with_tangents) const;

 private:
    std::uint32_t add(const SurfacePoint& point);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    std::vector<SurfacePoint> points_;
    std::vector<std::uint32_t> indices_;
};

/// A translation by `offset` after a rotation of `quarters` * 90 degrees about +y, exact.
glm::dmat4 placed(const glm::dvec3& offset, int quarters = 0);

/// Appends a mesh; returns its index.
int add_mesh(Scene& scene, Mesh mesh);

/// Appends an instance of a mesh.
void place(Scene& scene, int mesh, const glm::dmat4& world_from_object = glm::dmat4(1.0));

/// The two frames of a straight edge from `a` to `b`: profile x goes along `out`, which is
/// horizontal, y up. At a mitred end the profile also runs along the edge by `mitre` * x: 1 where
/// the edge grows with x (an outer corner), -1 where it shrinks.
std::vector<SweepFrame> straight_frames(const glm::dvec3& a, const glm::dvec3& b,
                                        const glm::dvec3& out, double mitre = 0.0);

/// `n` + 1 frames round the y axis through `center`, from `start_rad` on over `angle_rad`; profile
/// x is the radius. `around` [m] is the length in u.
std::vector<SweepFrame> round_frames(const glm::dvec3& center, int n, double start_rad,
                                     double angle_rad, double around);

}  // namespace kilolux
