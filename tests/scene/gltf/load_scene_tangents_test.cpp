// SPDX-License-Identifier: Apache-2.0
// Derived tangents against a second derivation of MikkTSpace from its description (Mikkelsen,
// "Simulation of Wrinkled Surfaces Revisited", 2008): slow, recursive, float64, without indices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "host/scene/gltf/load_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

struct Vertex {
    glm::vec3 position, normal;
    glm::vec2 uv;
    bool operator==(const Vertex&) const = default;
};

// Triangles of a mesh, by index.
struct Triangles {
    std::vector<Vertex> vertices;
    std::vector<std::uint16_t> indices;

    void add_quad(const std::array<Vertex, 4>& corners) {
        for (const int c : {0, 1, 2, 0, 2, 3}) {
            indices.push_back(static_cast<std::uint16_t>(vertices.size() + std::size_t(c)));
        }
        vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
};

Mesh loaded(const Triangles& triangles) {
    std::vector<float> positions, normals, uvs;
    for (const Vertex& v : triangles.vertices) {
        positions.insert(positions.end(), {v.position.x, v.position.y, v.position.z});
        normals.insert(normals.end(), {v.normal.x, v.normal.y, v.normal.z});
        uvs.insert(uvs.end(), {v.uv.x, v.uv.y});
    }
    GltfBuilder file = quad_with_normal_map();
    file.primitive()["attributes"] = {{"POSITION", file.add_floats("VEC3", positions)},
                                      {"NORMAL", file.add_floats("VEC3", normals)},
                                      {"TEXCOORD_0", file.add_floats("VEC2", uvs)}};
    file.primitive()["indices"] = file.add_indices(triangles.indices);
    const Scene scene = load(file);
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(scene.meshes.at(0).indices.size(), triangles.indices.size());
    return scene.meshes.at(0);
}

class SlowMikkTSpace {
 public:
    explicit SlowMikkTSpace(const Triangles& triangles) {
        for (const std::uint16_t i : triangles.indices) corners_.push_back(triangles.vertices[i]);
        const std::size_t count = corners_.size() / 3;
        for (std::size_t t = 0; t < count; ++t) faces_.push_back(face(t));
        for (std::size_t t = 0; t < count; ++t) {
            for (std::size_t k = 0; k < 3; ++k) find_neighbour(t, k);
        }
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            const Face& f = faces_[c / 3];
            if (f.is_point_or_line || f.says_nothing || group_[c] >= 0) continue;
            flood(c, c, groups_++, f.sign);
        }
    }

    /// Whether a corner's triangle has a tangent of its own.
    bool is_known(std::size_t c) const {
        return !faces_[c / 3].is_point_or_line && !faces_[c / 3].says_nothing;
    }

    /// The group's mean in xyz, shorter than 1 where its directions differ, and glTF's sign.
    glm::dvec4 tangent(std::size_t corner) const {
        const glm::dvec3 n(corners_[corner].normal);
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            if (group_[c] != group_[corner] || !is_known(c)) continue;
            const glm::dvec3 here = position(c);
            const std::size_t first = c - c % 3;
            const glm::dvec3 a = flat(position(first + (c + 1) % 3) - here, n);
            const glm::dvec3 b = flat(position(first + (c + 2) % 3) - here, n);
            const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
            sum += angle * flat(faces_[c / 3].along_u, n);
            weights += angle;
        }
        // v grows downwards in glTF.
        return {weights > 0.0 ? sum / weights : sum, -faces_[corner / 3].sign};
    }

 private:
    struct Face {
        bool is_point_or_line = false, says_nothing = false;
        double sign = 0.0;  // of the area in texture space
        glm::dvec3 along_u{0.0};
        std::array<std::ptrdiff_t, 3> neighbours{-1, -1, -1};
    };

    glm::dvec3 position(std::size_t c) const { return glm::dvec3(corners_[c].position); }

    static glm::dvec3 flat(const glm::dvec3& v, const glm::dvec3& n) {
        const glm::dvec3 out = v - glm::dot(v, n) * n;
        return glm::length(out) > 1e-9 ? glm::normalize(out) : glm::dvec3(0.0);
    }

    // Solves edge = du * along_u + dv * along_v for two edges by Cramer's rule.
    Face face(std::size_t t) const {
        const Vertex *a = &corners_[3 * t], *b = a + 1, *c = a + 2;
        Face out;
        out.is_point_or_line =
            a->position == b->position || b->position == c->position || a->position == c->position;
        const glm::dmat2 edges(glm::dvec2(b->uv) - glm::dvec2(a->uv),
                               glm::dvec2(c->uv) - glm::dvec2(a->uv));
        const double area = glm::determinant(edges);
        out.sign = area > 0.0 ? 1.0 : -1.0;
        out.says_nothing = area == 0.0;
        if (area == 0.0) return out;
        const glm::dmat2 inverse = glm::inverse(edges);
        const glm::dvec3 ab = position(3 * t + 1) - position(3 * t);
        const glm::dvec3 ac = position(3 * t + 2) - position(3 * t);
        out.along_u = ab * inverse[0][0] + ac * inverse[0][1];
        const glm::dvec3 along_v = ab * inverse[1][0] + ac * inverse[1][1];
        out.says_nothing = glm::length(out.along_u) < 1e-9 || glm::length(along_v) < 1e-9;
        return out;
    }

    void find_neighbour(std::size_t t, std::size_t k) {
        Face& own = faces_[t];
        if (own.neighbours[k] >= 0 || own.is_point_or_line) return;
        for (std::size_t o = t + 1; o < faces_.size(); ++o) {
            for (std::size_t e = 0; e < 3; ++e) {
                Face& other = faces_[o];
                if (other.neighbours[e] >= 0 || other.is_point_or_line) continue;
                if (corners_[3 * t + k] != corners_[3 * o + (e + 1) % 3]) continue;
                if (corners_[3 * t + (k + 1) % 3] != corners_[3 * o + e]) continue;
                own.neighbours[k] = std::ptrdiff_t(o);
                other.neighbours[e] = std::ptrdiff_t(t);
                return;
            }
        }
    }

    void flood(std::size_t start, std::size_t c, int group, double sign) {
        Face& f = faces_[c / 3];
        if (group_[c] >= 0) return;
        if (f.says_nothing) {
            const std::size_t first = c - c % 3;
            const bool is_free =
                group_[first] < 0 && group_[first + 1] < 0 && group_[first + 2] < 0;
            if (is_free) f.sign = sign;
        }
        if (f.sign != sign) return;
        group_[c] = group;
        for (const std::size_t edge : {c % 3, (c + 2) % 3}) {
            if (f.neighbours[edge] < 0) continue;
            const std::size_t next = 3 * std::size_t(f.neighbours[edge]);
            for (std::size_t k = next; k < next + 3; ++k) {
                if (corners_[k] == corners_[start]) flood(start, k, group, sign);
            }
        }
    }

    std::vector<Vertex> corners_;
    std::vector<Face> faces_;
    std::vector<int> group_ = std::vector<int>(3 * 4096, -1);
    int groups_ = 0;
};

// The number of corners whose tangents were compared.
std::size_t compare(const Triangles& triangles) {
    const SlowMikkTSpace expected(triangles);
    const Mesh mesh = loaded(triangles);
    std::size_t compared = 0;
    for (std::size_t c = 0; c < mesh.indices.size(); ++c) {
        const glm::vec4 tangent = mesh.tangents.at(mesh.indices[c]);
        const glm::dvec4 mean = expected.tangent(c);
        // Where directions cancel, rounding decides.
        if (!expected.is_known(c) || glm::length(glm::dvec3(mean)) < 1e-6) continue;
        expect_near(glm::vec3(tangent), glm::vec3(glm::normalize(glm::dvec3(mean))));
        EXPECT_EQ(double(tangent.w), mean.w) << "corner " << c;
        ++compared;
    }
    return compared;
}

// A latitude-longitude sphere whose u goes east and whose v goes south.
Triangles sphere(int rings, int segments) {
    const auto vertex = [&](int ring, int segment) {
        const double v = double(ring) / rings, u = double(segment) / segments;
        const double polar = v * std::numbers::pi;
        const double around = 2.0 * std::numbers::pi * (segment % segments) / segments;
        const glm::vec3 n(std::sin(polar) * std::sin(around), std::cos(polar),
                          std::sin(polar) * std::cos(around));
        return Vertex{n, glm::normalize(n), {u, v}};
    };
    Triangles out;
    for (int r = 1; r + 1 < rings; ++r) {
        for (int s = 0; s < segments; ++s) {
            out.add_quad({vertex(r + 1, s), vertex(r + 1, s + 1), vertex(r, s + 1), vertex(r, s)});
        }
    }
    return out;
}

TEST(LoadSceneMikkTSpace, ASpheresTangentsPointEast) {
    const Triangles triangles = sphere(24, 48);
    const float half_a_segment = std::cos(std::numbers::pi_v<float> / 48);
    EXPECT_EQ(compare(triangles), triangles.indices.size());
    const Mesh mesh = loaded(triangles);
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v) {
        const glm::vec3 east = glm::normalize(glm::cross(glm::vec3(0, 1, 0), mesh.normals[v]));
        EXPECT_GT(glm::dot(glm::vec3(mesh.tangents[v]), east), half_a_segment) << v;
        EXPECT_EQ(mesh.tangents[v].w, 1.0f);
    }
}

// A cube with smooth normals and a seam of texture coordinates along every edge.
TEST(LoadSceneMikkTSpace, TheFacesOfACubeWithSeamsKeepTheirDirections) {
    Triangles triangles;
    std::vector<glm::vec3> along_u;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 n(0.0f), u(0.0f);
            n[axis] = side;
            u[(axis + 1) % 3] = 1.0f;
            const glm::vec3 up = glm::cross(n, u);
            const auto vertex = [&](float a, float b, glm::vec2 uv) {
                const glm::vec3 p = n + a * u + b * up;
                return Vertex{p, glm::normalize(p), uv};
            };
            triangles.add_quad({vertex(-1, -1, {0, 1}), vertex(1, -1, {1, 1}), vertex(1, 1, {1, 0}),
                                vertex(-1, 1, {0, 0})});
            along_u.push_back(u);
        }
    }
    EXPECT_EQ(compare(triangles), 36u);
    const Mesh mesh = loaded(triangles);
    ASSERT_EQ(mesh.tangents.size(), 24u);
    for (std::size_t v = 0; v < 24; ++v) {
        const glm::vec3 n = mesh.normals[v];
        const glm::vec3 u = along_u[v / 4];
        expect_near(glm::vec3(mesh.tangents[v]), glm::normalize(u - n * glm::dot(n, u)));
    }
}

// Vertices of few values, so that triangles without area, of mirrored, equal or no texture
// coordinates and edges of many triangles are frequent.
TEST(LoadSceneMikkTSpace, TrianglesAtRandomHaveTheTangentsOfASecondDerivation) {
    std::mt19937 random(7);
    const auto below = [&](int end) { return static_cast<int>(random() % unsigned(end)); };
    std::size_t compared = 0;
    for (int mesh = 0; mesh < 200; ++mesh) {
        Triangles triangles;
        const int range = 2 + mesh % 3;
        for (int v = 0; v < 30; ++v) {
            const glm::vec3 position(below(range), below(range), below(2));
            const glm::vec3 normal = below(4) == 0 ? glm::vec3(0.6f, 0, 0.8f) : glm::vec3(0, 0, 1);
            const glm::vec2 uv(position.x * 0.5f, below(4) == 0 ? 0.25f : position.y * 0.5f);
            triangles.vertices.push_back({position, normal, uv});
        }
        for (int t = 0; t < 60; ++t) {
            const int a = below(30), b = (a + 1 + below(14)) % 30, c = (b + 1 + below(14)) % 30;
            for (const int v : {a, b, c}) {
                triangles.indices.push_back(static_cast<std::uint16_t>(v));
            }
        }
        compared += compare(triangles);
        if (HasFailure()) return;
    }
    EXPECT_GT(compared, 4000u);
}

}  // namespace
}  // namespace kilolux
