// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace kilolux {
namespace {

constexpr double kMinArea2 = 1e-9;  // twice a triangle's area [m^2]; less is a sliver

// Outward unit normals at both ends of a segment of a profile; soft corners share theirs.
struct SegmentNormals {
    glm::dvec2 begin;
    glm::dvec2 end;
};

std::vector<SegmentNormals> segment_normals(const Profile& profile) {
    const std::vector<glm::dvec2>& p = profile.points;
    std::vector<glm::dvec2> flat;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        const glm::dvec2 d = p[i + 1] - p[i];
        flat.push_back(glm::normalize(glm::dvec2(d.y, -d.x)));
    }
    const double soft = std::cos(profile.crease_rad);
    const auto joined = [&](std::size_t i, std::size_t j) {
        return glm::dot(flat[i], flat[j]) > soft ? glm::normalize(flat[i] + flat[j]) : flat[i];
    };
    std::vector<SegmentNormals> normals;
    const bool closed = glm::distance(p.front(), p.back()) < 1e-9;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const std::size_t last = flat.size() - 1;
        const std::size_t before = i > 0 ? i - 1 : (closed ? last : i);
        const std::size_t after = i < last ? i + 1 : (closed ? 0 : i);
        normals.push_back({joined(i, before), joined(i, after)});
    }
    return normals;
}

glm::vec3 perpendicular_to(const glm::vec3& n) {
    const glm::vec3 axis = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(n, axis));
}

// Unit tangents by the directions in which u grows, with glTF's handedness: cross(normal, tangent)
// * w points where v shrinks, which is up in the image. Simpler than the loader's
// derive_tangents(): no vertex here is shared by mirrored triangles.
std::vector<glm::vec4> tangents_of(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    std::vector<glm::vec3> along_u(count, glm::vec3(0.0f));
    std::vector<glm::vec3> along_v(count, glm::vec3(0.0f));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t* v = &mesh.indices[i];
        const glm::vec3 e1 = mesh.positions[v[1]] - mesh.positions[v[0]];
        const glm::vec3 e2 = mesh.positions[v[2]] - mesh.positions[v[0]];
        const glm::vec2 d1 = mesh.texcoords[0][v[1]] - mesh.texcoords[0][v[0]];
        const glm::vec2 d2 = mesh.texcoords[0][v[2]] - mesh.texcoords[0][v[0]];
        const float sign = d1.x * d2.y - d2.x * d1.y < 0.0f ? -1.0f : 1.0f;
        for (int k = 0; k < 3; ++k) {
            along_u[v[k]] += sign * (e1 * d2.y - e2 * d1.y);
            along_v[v[k]] += sign * (e2 * d1.x - e1 * d2.x);
        }
    }
    std::vector<glm::vec4> tangents;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3& n = mesh.normals[i];
        const glm::vec3 flat = along_u[i] - n * glm::dot(n, along_u[i]);
        const bool degenerate = !(glm::dot(flat, flat) > 1e-20f);
        const glm::vec3 t = degenerate ? perpendicular_to(n) : glm::normalize(flat);
        const float w = glm::dot(glm::cross(n, t), along_v[i]) > 0.0f ? -1.0f : 1.0f;
        tangents.emplace_back(t, w);
    }
    return tangents;
}

}  // namespace

std::uint32_t MeshBuilder::add(const SurfacePoint& point) {
    points_.push_back({point.position, glm::normalize(point.normal), point.uv});
    return static_cast<std::uint32_t>(points_.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::dvec3& p = points_[a].position;
    const glm::dvec3 n = glm::cross(points_[b].position - p, points_[c].position - p);
    if (glm::length(n) < kMinArea2) return;
    const glm::dvec3 wanted = points_[a].normal + points_[b].normal + points_[c].normal;
    if (glm::dot(n, wanted) < 0.0) std::swap(b, c);
    indices_.insert(indices_.end(), {a, b, c});
}

void MeshBuilder::patch(int columns, int rows,
                        const std::function<SurfacePoint(double, double)>& at) {
    const auto first = static_cast<std::uint32_t>(points_.size());
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            add(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
        }
    }
    const auto index = [&](int i, int j) {
        return first + static_cast<std::uint32_t>(j * (columns + 1) + i);
    };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            triangle(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            triangle(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    }
}

void MeshBuilder::smooth_patch(int columns, int rows,
                               const std::function<glm::dvec3(double, double)>& at,
                               glm::dvec2 size_m, bool flipped) {
    patch(columns, rows, [&](double u, double v) {
        constexpr double kStep = 1e-4;
        const glm::dvec3 along_u = at(u + kStep, v) - at(u - kStep, v);
        const glm::dvec3 along_v = at(u, v + kStep) - at(u, v - kStep);
        const glm::dvec3 n = glm::cross(along_u, along_v);
        const glm::dvec2 uv(flipped ? -u : u, -v);
        return SurfacePoint{at(u, v), flipped ? -n : n, uv * size_m};
    });
}

void MeshBuilder::quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d, const glm::dvec3& facing) {
    const glm::dvec3 cross = glm::cross(b - a, d - a);
    const glm::dvec3 n = glm::normalize(glm::dot(cross, facing) < 0.0 ? -cross : cross);
    // v grows downwards on walls, as rows of an image do; on floors u is x and v is z.
    const auto uv = [&](const glm::dvec3& p) {
        const glm::dvec3 s = glm::abs(n);
        if (s.y >= s.x && s.y >= s.z) return glm::dvec2(p.x, p.z);
        return s.x > s.z ? glm::dvec2(n.x > 0 ? -p.z : p.z, -p.y)
                         : glm::dvec2(n.z > 0 ? p.x : -p.x, -p.y);
    };
    const std::uint32_t first = add({a, n, uv(a)});
    add({b, n, uv(b)});
    add({c, n, uv(c)});
    add({d, n, uv(d)});
    triangle(first, first + 1, first + 2);
    triangle(first, first + 2, first + 3);
}

void MeshBuilder::level(const glm::dvec2& low, const glm::dvec2& high, double y, double up) {
    quad({low.x, y, low.y}, {high.x, y, low.y}, {high.x, y, high.y}, {low.x, y, high.y},
         {0, up, 0});
}

void MeshBuilder::wall(const glm::dvec2& low, const glm::dvec2& high, double z, double facing) {
    quad({low.x, low.y, z}, {high.x, low.y, z}, {high.x, high.y, z}, {low.x, high.y, z},
         {0, 0, facing});
}

void MeshBuilder::box(const glm::dvec3& low, const glm::dvec3& high) {
    for (int axis = 0; axis < 3; ++axis) {
        const int s = (axis + 1) % 3;
        const int t = (axis + 2) % 3;
        for (const glm::dvec3& end : {low, high}) {
            glm::dvec3 a = end, b = end, c = end, d = end, facing(0.0);
            a[s] = low[s], a[t] = low[t];
            b[s] = high[s], b[t] = low[t];
            c[s] = high[s], c[t] = high[t];
            d[s] = low[s], d[t] = high[t];
            facing[axis] = end[axis] - 0.5 * (low[axis] + high[axis]);
            quad(a, b, c, d, facing);
        }
    }
}

void MeshBuilder::sweep(const Profile& profile, std::span<const SweepFrame> frames) {
    const std::vector<SegmentNormals> normals = segment_normals(profile);
    const int columns = static_cast<int>(frames.size()) - 1;
    double across = 0.0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const glm::dvec2 ends[2] = {profile.points[i], profile.points[i + 1]};
        const double length = glm::distance(ends[0], ends[1]);
        patch(columns, 1, [&](double u, double v) {
            const SweepFrame& f = frames[static_cast<std::size_t>(std::lround(u * columns))];
            const glm::dvec2 p = v < 0.5 ? ends[0] : ends[1];
            const glm::dvec2 n = v < 0.5 ? normals[i].begin : normals[i].end;
            return SurfacePoint{f.origin + p.x * f.axis_x + p.y * f.axis_y,
                                n.x * f.normal_x + n.y * f.axis_y,
                                {f.along, -(across + v * length)}};
        });
        across += length;
    }
}

void MeshBuilder::lathe(const Profile& profile, int segments, const glm::dvec3& center) {
    double widest = 0.0;
    for (const glm::dvec2& p : profile.points) widest = std::max(widest, p.x);
    // Whole metres around: a texture whose size divides a metre has no seam.
    const double around = std::max(1.0, std::round(2.0 * std::numbers::pi * widest));
    sweep(profile, round_frames(center, segments, 0.0, 2.0 * std::numbers::pi, around));
}

void MeshBuilder::tube(std::span<const glm::dvec3> path, double radius, int sides) {
    const int rows = static_cast<int>(path.size()) - 1;
    double along = 0.0;
    glm::dvec3 side = glm::dvec3(perpendicular_to(glm::vec3(glm::normalize(path[1] - path[0]))));
    std::vector<SweepFrame> frames;
    for (int i = 0; i <= rows; ++i) {
        const auto at = [&](int k) {
            return path[static_cast<std::size_t>(std::clamp(k, 0, rows))];
        };
        const glm::dvec3 forward = glm::normalize(at(i + 1) - at(i - 1));
        side = glm::normalize(side - forward * glm::dot(side, forward));
        frames.push_back({at(i), side, glm::cross(forward, side), side, along});
        along += glm::distance(at(i), at(i + 1));
    }
    Profile ring{{}, 3.0};
    for (int i = 0; i <= sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        ring.points.push_back(i == sides ? ring.points.front()
                                         : radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    sweep(ring, frames);
}

void MeshBuilder::append(const MeshBuilder& other, const glm::dmat4& to_here) {
    const auto first = static_cast<std::uint32_t>(points_.size());
    const glm::dmat3 turn(to_here);
    const glm::dmat3 normal_turn = glm::transpose(glm::inverse(turn));
    for (const SurfacePoint& p : other.points_) {
        add({glm::dvec3(to_here * glm::dvec4(p.position, 1.0)), normal_turn * p.normal, p.uv});
    }
    for (std::size_t i = 0; i < other.indices_.size(); i += 3) {
        triangle(first + other.indices_[i], first + other.indices_[i + 1],
                 first + other.indices_[i + 2]);
    }
}

MeshBuilder MeshBuilder::moved(const glm::dvec3& by) const {
    MeshBuilder out;
    out.append(*this, placed(by));
    return out;
}

Mesh MeshBuilder::build(std::string name, int material, double uv_per_metre,
                        bool with_tangents) const {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.material = material;
    mesh.indices = indices_;
    for (const SurfacePoint& p : points_) {
        mesh.positions.emplace_back(p.position);
        mesh.normals.push_back(glm::normalize(glm::vec3(p.normal)));
        mesh.texcoords[0].emplace_back(p.uv * uv_per_metre);
    }
    if (with_tangents) mesh.tangents = tangents_of(mesh);
    return mesh;
}

glm::dmat4 placed(const glm::dvec3& offset, int quarters) {
    static constexpr std::array<glm::dvec2, 4> kTurns = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const glm::dvec2 turn = kTurns[static_cast<std::size_t>(((quarters % 4) + 4) % 4)];
    glm::dmat4 m(1.0);
    m[0] = {turn.x, 0, -turn.y, 0};
    m[2] = {turn.y, 0, turn.x, 0};
    m[3] = glm::dvec4(offset, 1.0);
    return m;
}

int add_mesh(Scene& scene, Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size()) - 1;
}

void place(Scene& scene, int mesh, const glm::dmat4& world_from_object) {
    scene.instances.push_back({mesh, world_from_object});
}

std::vector<SweepFrame> straight_frames(const glm::dvec3& a, const glm::dvec3& b,
                                        const glm::dvec3& out, double mitre) {
    const glm::dvec3 along = glm::normalize(b - a);
    const glm::dvec3 up(0, 1, 0);
    return {{a, out - mitre * along, up, out, 0.0},
            {b, out + mitre * along, up, out, glm::distance(a, b)}};
}

std::vector<SweepFrame> round_frames(const glm::dvec3& center, int n, double start_rad,
                                     double angle_rad, double around) {
    std::vector<SweepFrame> frames;
    for (int i = 0; i <= n; ++i) {
        const double share = static_cast<double>(i) / n;
        const double angle = start_rad + share * angle_rad;
        const glm::dvec3 out(std::cos(angle), 0.0, -std::sin(angle));
        frames.push_back({center, out, {0, 1, 0}, out, share * around});
    }
    return frames;
}

}  // namespace kilolux
