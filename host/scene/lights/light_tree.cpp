// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "host/base/system/parallel.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_ranges.h"

namespace kilolux {
namespace {

using Members = std::span<std::uint32_t>;

// Below this many lights a subtree is not worth a task.
constexpr std::size_t kTaskLights = 4096;
// More than the rounding of a node's radius and moments to float32.
constexpr double kRoundUp = 1.0 + 1e-6;

// Sums over a node's lights.
struct Sums {
    glm::dvec3 intensity{0.0};
    glm::dvec3 weighted{0.0};  // of places, by the sum of the three colours
    double weight = 0.0;
    glm::dvec3 low{std::numeric_limits<double>::max()};
    glm::dvec3 high{std::numeric_limits<double>::lowest()};
};

class Builder {
 public:
    Builder(std::span<const SceneLight> lights, LightTree& out) : lights_(lights), out_(out) {}

    void build(Members members, std::size_t place) {
        const Sums sums = sums_of(members);
        fill(members, sums, place);
        if (members.size() == 1) return;
        const Members left = members.first(members.size() / 2);
        const Members right = members.subspan(members.size() / 2);
        split(members, left.size(), sums);
        const auto build_left = [&] { build(left, place + 1); };
        const auto build_right = [&] { build(right, place + 2 * left.size()); };
        if (members.size() > kTaskLights) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
    }

 private:
    Sums sums_of(Members members) const {
        Sums out;
        for (const std::uint32_t i : members) {
            const SceneLight& light = lights_[i];
            const glm::dvec3 intensity(light.intensity);
            const double weight = intensity.x + intensity.y + intensity.z;
            out.intensity += intensity;
            out.weighted += weight * light.position;
            out.weight += weight;
            out.low = glm::min(out.low, light.position);
            out.high = glm::max(out.high, light.position);
        }
        return out;
    }

    void split(Members members, std::size_t middle, const Sums& sums) const {
        const glm::dvec3 size = sums.high - sums.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            const double x = lights_[a].position[axis], y = lights_[b].position[axis];
            return x != y ? x < y : a < b;
        };
        std::ranges::nth_element(members, members.begin() + static_cast<std::ptrdiff_t>(middle),
                                 before);
    }

    void fill(Members members, const Sums& sums, std::size_t place) const {
        SceneLight& light = out_.lights[place];
        TreeNode& node = out_.nodes[place];
        light.range = kUnlimitedRange;
        light.intensity = glm::vec3(sums.intensity);
        node.next = static_cast<std::uint32_t>(place + 2 * members.size() - 1);
        if (members.size() == 1) {
            light.position = lights_[members.front()].position;
            return;
        }
        light.position = glm::clamp(sums.weighted / sums.weight, sums.low, sums.high);
        fill_moments(members, sums, light.position, node);
    }

    void fill_moments(Members members, const Sums& sums, const glm::dvec3& center,
                      TreeNode& node) const {
        double radius2 = 0.0;
        glm::dvec3 second(0.0);
        glm::dvec3 first[3] = {};
        for (const std::uint32_t i : members) {
            const glm::dvec3 off = lights_[i].position - center;
            const double d2 = glm::dot(off, off);
            const glm::dvec3 intensity(lights_[i].intensity);
            radius2 = std::max(radius2, d2);
            second += intensity * d2;
            for (int c = 0; c < 3; ++c) first[c] += intensity[c] * off;
        }
        double spread2 = 0.0, offset = 0.0;
        for (int c = 0; c < 3; ++c) {
            if (!(sums.intensity[c] > 0.0)) continue;
            spread2 = std::max(spread2, second[c] / sums.intensity[c]);
            offset = std::max(offset, glm::length(first[c]) / sums.intensity[c]);
        }
        node.radius = static_cast<float>(std::sqrt(radius2) * kRoundUp);
        node.spread = static_cast<float>(std::sqrt(spread2) * kRoundUp);
        node.offset = static_cast<float>(offset * kRoundUp);
    }

    std::span<const SceneLight> lights_;
    LightTree& out_;
};

}  // namespace

bool is_for_tree(const SceneLight& light) {
    return kind_of(light).is_summed && lacks_range(light) && light.profile < 0 &&
           !light.follows_camera;
}

LightTree make_light_tree(std::span<const SceneLight> lights) {
    LightTree out;
    if (lights.empty()) return out;
    out.lights.resize(2 * lights.size() - 1);
    out.nodes.resize(2 * lights.size() - 1);
    std::vector<std::uint32_t> members(lights.size());
    std::iota(members.begin(), members.end(), 0u);
    Builder(lights, out).build(members, 0);
    return out;
}

}  // namespace kilolux
