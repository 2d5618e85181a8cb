// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/tangent_groups.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "host/base/hash.h"

namespace kilolux {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

std::uint32_t corner_after(std::uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

std::uint32_t corner_before(std::uint32_t corner) {
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

bool is_degenerate(const Mesh& mesh, const std::uint32_t* corner) {
    const auto& p = mesh.positions;
    return p[corner[0]] == p[corner[1]] || p[corner[1]] == p[corner[2]] ||
           p[corner[2]] == p[corner[0]];
}

// By vertex, the first one of equal position, normal and texture coordinates.
std::vector<std::uint32_t> first_of_equal(const Mesh& mesh, std::span<const glm::vec2> texcoords) {
    const auto key_of = [&](std::size_t v) {
        // -0 becomes 0; bits are compared, so that NaN equals itself.
        const glm::vec3 p = mesh.positions[v] + 0.0f;
        const glm::vec3 n = mesh.normals[v] + 0.0f;
        const glm::vec2 uv = texcoords[v] + 0.0f;
        return std::bit_cast<std::array<std::uint32_t, 8>>(
            std::array{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y});
    };
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * mesh.positions.size()), kNone);
    std::vector<std::uint32_t> first(mesh.positions.size());
    for (std::uint32_t v = 0; v < first.size(); ++v) {
        const auto key = key_of(v);
        std::size_t slot = hash64(std::as_bytes(std::span(key))) % slots.size();
        while (slots[slot] != kNone && key_of(slots[slot]) != key) {
            slot = (slot + 1) % slots.size();
        }
        if (slots[slot] == kNone) slots[slot] = v;
        first[v] = slots[slot];
    }
    return first;
}

// An edge is named by the corner where it begins; it ends at corner_after().
class TangentGrouping {
 public:
    TangentGrouping(const Mesh& rest, std::span<const glm::vec2> texcoords,
                    std::vector<std::uint32_t>& elements, std::vector<std::uint32_t>& indices)
        : rest_(rest), texcoords_(texcoords), elements_(elements), indices_(indices) {
        const std::vector<std::uint32_t> first = first_of_equal(rest, texcoords);
        for (const std::uint32_t v : rest.indices) points_.push_back(first[v]);
        for (std::size_t c = 0; c < points_.size(); c += 3) {
            turns_.push_back(uv_frame(rest, texcoords, &rest.indices[c]).turn);
        }
    }

    std::vector<std::uint32_t> run() {
        pair_edges();
        groups_.assign(elements_.size(), kNone);
        latest_.resize(elements_.size());
        std::iota(latest_.begin(), latest_.end(), 0u);
        is_grouped_.assign(points_.size(), false);
        // Turns that are unknown now become those of groups on the way.
        const std::vector<UvTurn> turns = turns_;
        for (std::uint32_t c = 0; c < points_.size(); ++c) {
            if (turns[c / 3] != UvTurn::unknown && !is_grouped_[c]) start_group(c);
        }
        join_the_rest();
        return std::move(groups_);
    }

 private:
    // The edges by the lesser of their two points, then by the greater one, then by triangle.
    std::vector<std::uint32_t> sorted_edges() const {
        std::vector<std::uint32_t> ends(rest_.positions.size() + 1, 0);
        const auto near = [&](std::uint32_t e) {
            return std::min(points_[e], points_[corner_after(e)]);
        };
        const auto far = [&](std::uint32_t e) {
            return std::max(points_[e], points_[corner_after(e)]);
        };
        std::vector<std::uint32_t> used;
        for (std::uint32_t e = 0; e < points_.size(); ++e) {
            if (!is_degenerate(rest_, &rest_.indices[e - e % 3])) used.push_back(e);
        }
        for (const std::uint32_t e : used) ++ends[near(e) + 1];
        std::partial_sum(ends.begin(), ends.end(), ends.begin());
        std::vector<std::uint32_t> begins = ends;
        std::vector<std::uint32_t> sorted(used.size());
        for (const std::uint32_t e : used) sorted[begins[near(e)]++] = e;
        for (std::size_t p = 0; p + 1 < ends.size(); ++p) {
            std::sort(sorted.begin() + ends[p], sorted.begin() + ends[p + 1],
                      [&](std::uint32_t a, std::uint32_t b) {
                          return std::pair(far(a), a) < std::pair(far(b), b);
                      });
        }
        return sorted;
    }

    // Where more than two triangles share an edge, the first ones of opposite directions are pairs.
    void pair_edges() {
        opposite_.assign(points_.size(), kNone);
        const std::vector<std::uint32_t> edges = sorted_edges();
        const auto is_forward = [&](std::uint32_t e) {
            return points_[e] < points_[corner_after(e)];
        };
        const auto ends_of = [&](std::uint32_t e) {
            return std::minmax({points_[e], points_[corner_after(e)]});
        };
        for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
            while (end < edges.size() && ends_of(edges[end]) == ends_of(edges[begin])) ++end;
            std::size_t back = begin;
            for (std::size_t i = begin; i < end; ++i) {
                if (!is_forward(edges[i])) continue;
                while (back < end && is_forward(edges[back])) ++back;
                if (back == end) break;
                opposite_[edges[i]] = edges[back];
                opposite_[edges[back++]] = edges[i];
            }
        }
    }

    // The corner at the same point in the triangle behind the edge that begins or ends there.
    std::uint32_t behind_next(std::uint32_t corner) const {
        const std::uint32_t edge = opposite_[corner];
        return edge == kNone ? kNone : corner_after(edge);
    }
    std::uint32_t behind_last(std::uint32_t corner) const {
        return opposite_[corner_before(corner)];
    }

    // The name of a group that begins with a corner: the vertex that the corner will have.
    std::uint32_t new_group(std::uint32_t corner) const {
        const std::uint32_t v = rest_.indices[corner];
        return groups_[v] == kNone ? v : static_cast<std::uint32_t>(elements_.size());
    }

    void start_group(std::uint32_t corner) {
        const std::uint32_t group = new_group(corner);
        const UvTurn turn = turns_[corner / 3];
        join(corner, group);
        for (std::uint32_t c = behind_next(corner); accepts(c, turn); c = behind_next(c)) {
            join(c, group);
        }
        for (std::uint32_t c = behind_last(corner); accepts(c, turn); c = behind_last(c)) {
            join(c, group);
        }
    }

    // The first group that reaches a triangle of unknown turn decides its turn.
    bool accepts(std::uint32_t corner, UvTurn turn) {
        if (corner == kNone || is_grouped_[corner]) return false;
        UvTurn& own = turns_[corner / 3];
        if (own == UvTurn::unknown) own = turn;
        return own == turn;
    }

    void join(std::uint32_t corner, std::uint32_t group) {
        std::uint32_t& vertex = latest_[rest_.indices[corner]];
        if (groups_[vertex] == kNone) groups_[vertex] = group;
        if (groups_[vertex] != group) {
            elements_.push_back(std::uint32_t{elements_[vertex]});
            groups_.push_back(group);
            vertex = static_cast<std::uint32_t>(groups_.size() - 1);
        }
        indices_[corner] = vertex;
        is_grouped_[corner] = true;
    }

    // The first group of each turn at a point takes the corners there that no group reached, such
    // as those of triangles that have no area until they are morphed.
    void join_the_rest() {
        std::vector<std::array<std::uint32_t, 2>> at_point(rest_.positions.size(), {kNone, kNone});
        for (std::size_t c = 0; c < points_.size(); ++c) {
            if (!is_grouped_[c]) continue;
            auto& [preserving, mirrored] = at_point[points_[c]];
            std::uint32_t& group = turns_[c / 3] == UvTurn::preserving ? preserving : mirrored;
            if (group == kNone) group = groups_[indices_[c]];
        }
        for (std::uint32_t c = 0; c < points_.size(); ++c) {
            if (is_grouped_[c]) continue;
            auto& [preserving, mirrored] = at_point[points_[c]];
            const UvTurn turn = uv_turn(texcoords_, &rest_.indices[c - c % 3]);
            if (turn == UvTurn::unknown && groups_[rest_.indices[c]] != kNone) continue;
            const bool is_preserving =
                turn == UvTurn::preserving || (turn == UvTurn::unknown && preserving != kNone);
            std::uint32_t& group = is_preserving ? preserving : mirrored;
            if (group == kNone) group = new_group(c);
            join(c, group);
        }
    }

    const Mesh& rest_;
    std::span<const glm::vec2> texcoords_;
    std::vector<std::uint32_t>& elements_;
    std::vector<std::uint32_t>& indices_;
    std::vector<std::uint32_t> points_;    // by corner, the first equal vertex
    std::vector<std::uint32_t> opposite_;  // by edge, the paired one
    std::vector<UvTurn> turns_;            // by triangle
    std::vector<std::uint32_t> groups_;    // by vertex
    std::vector<std::uint32_t> latest_;    // by vertex of `rest`, its last copy
    std::vector<bool> is_grouped_;         // by corner
};

}  // namespace

UvTurn uv_turn(std::span<const glm::vec2> texcoords, const std::uint32_t* corner) {
    const glm::dvec2 d1 = glm::dvec2(texcoords[corner[1]]) - glm::dvec2(texcoords[corner[0]]);
    const glm::dvec2 d2 = glm::dvec2(texcoords[corner[2]]) - glm::dvec2(texcoords[corner[0]]);
    const double area = d1.x * d2.y - d1.y * d2.x;
    if (area == 0.0 || !std::isfinite(area)) return UvTurn::unknown;
    return area > 0.0 ? UvTurn::preserving : UvTurn::mirrored;
}

UvFrame uv_frame(const Mesh& mesh, std::span<const glm::vec2> texcoords,
                 const std::uint32_t* corner) {
    const glm::dvec3 p0(mesh.positions[corner[0]]);
    const glm::dvec3 e1 = glm::dvec3(mesh.positions[corner[1]]) - p0;
    const glm::dvec3 e2 = glm::dvec3(mesh.positions[corner[2]]) - p0;
    const glm::dvec2 d1 = glm::dvec2(texcoords[corner[1]]) - glm::dvec2(texcoords[corner[0]]);
    const glm::dvec2 d2 = glm::dvec2(texcoords[corner[2]]) - glm::dvec2(texcoords[corner[0]]);
    const UvTurn turn = uv_turn(texcoords, corner);
    if (turn == UvTurn::unknown || is_degenerate(mesh, corner)) return {};
    const double sign = turn == UvTurn::preserving ? 1.0 : -1.0;
    const UvFrame frame{turn, sign * (e1 * d2.y - e2 * d1.y), sign * (e2 * d1.x - e1 * d2.x)};
    const bool has_lengths = glm::length(frame.along_u) > 0.0 && glm::length(frame.along_v) > 0.0;
    return has_lengths ? frame : UvFrame{};
}

std::vector<std::uint32_t> split_tangent_groups(const Mesh& rest,
                                                std::span<const glm::vec2> texcoords,
                                                std::vector<std::uint32_t>& elements,
                                                std::vector<std::uint32_t>& indices) {
    return TangentGrouping(rest, texcoords, elements, indices).run();
}

}  // namespace kilolux
