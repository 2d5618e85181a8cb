// SPDX-License-Identifier: Apache-2.0
// The light tree's nodes against their lights, summed anew.
#include "host/scene/lights/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "host/scene/lights/light_ranges.h"

namespace kilolux {
namespace {

std::vector<SceneLight> scattered_lights(int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-10.0, 10.0);
    std::uniform_real_distribution<float> shade(0.0f, 5.0f);
    std::vector<SceneLight> lights(static_cast<std::size_t>(count));
    for (SceneLight& light : lights) {
        light.position = {place(random), 3.0 * place(random), 1e6 + place(random)};
        light.intensity = {shade(random), shade(random), 1.0f};
    }
    return lights;
}

// Checks the subtree at `node`; returns its single lights.
std::vector<SceneLight> check_subtree(const LightTree& tree, std::size_t node) {
    const TreeNode& n = tree.nodes[node];
    const SceneLight& sum = tree.lights[node];
    EXPECT_EQ(sum.range, kUnlimitedRange);
    if (n.next == node + 1) {
        EXPECT_EQ(n.radius, 0.0f);
        return {sum};
    }
    std::vector<SceneLight> below = check_subtree(tree, node + 1);
    const auto right = check_subtree(tree, tree.nodes[node + 1].next);
    EXPECT_EQ(tree.nodes[tree.nodes[node + 1].next].next, n.next);
    EXPECT_LE(below.size() - right.size() + 1, 2u);  // halves
    below.insert(below.end(), right.begin(), right.end());
    for (int c = 0; c < 3; ++c) {
        double intensity = 0.0, second = 0.0;
        glm::dvec3 first(0.0);
        for (const SceneLight& light : below) {
            const glm::dvec3 off = light.position - sum.position;
            EXPECT_LE(glm::length(off), n.radius);
            intensity += light.intensity[c];
            first += double{light.intensity[c]} * off;
            second += light.intensity[c] * glm::dot(off, off);
        }
        EXPECT_NEAR(sum.intensity[c], intensity, 1e-6 * intensity);
        EXPECT_LE(glm::length(first) / intensity, n.offset);
        EXPECT_LE(std::sqrt(second / intensity), n.spread);
        EXPECT_LE(n.offset, n.spread * 1.00001f);
    }
    return below;
}

TEST(LightTree, HoldsEachLightOnceUnderNodesThatSumIt) {
    for (const int count : {1, 2, 3, 100, 257}) {
        std::vector<SceneLight> lights = scattered_lights(count);
        const LightTree tree = make_light_tree(lights);
        ASSERT_EQ(tree.nodes.size(), 2 * lights.size() - 1);
        ASSERT_EQ(tree.nodes[0].next, tree.nodes.size());
        std::vector<SceneLight> found = check_subtree(tree, 0);
        const auto by_place = [](const SceneLight& a, const SceneLight& b) {
            return a.position.x < b.position.x;
        };
        std::ranges::sort(found, by_place);
        std::ranges::sort(lights, by_place);
        ASSERT_EQ(found.size(), lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            EXPECT_EQ(found[i].position, lights[i].position);
            EXPECT_EQ(found[i].intensity, lights[i].intensity);
        }
    }
}

TEST(LightTree, SumsLightsAtOnePlaceExactly) {
    std::vector<SceneLight> lights(5, scattered_lights(1).front());
    const LightTree tree = make_light_tree(lights);
    EXPECT_EQ(tree.nodes[0].radius, 0.0f);
    EXPECT_EQ(tree.nodes[0].spread, 0.0f);
    EXPECT_EQ(tree.lights[0].position, lights[0].position);
    EXPECT_EQ(tree.lights[0].intensity, 5.0f * lights[0].intensity);
}

TEST(LightTree, IsForPointsWithoutAnEnd) {
    SceneLight light = scattered_lights(1).front();
    EXPECT_TRUE(is_for_tree(light));
    const auto refused = [&](auto&& change) {
        SceneLight other = light;
        change(other);
        return !is_for_tree(other);
    };
    EXPECT_TRUE(refused([](SceneLight& l) { l.range = 3.0f; }));
    EXPECT_TRUE(refused([](SceneLight& l) { l.type = LightType::spot; }));
    EXPECT_TRUE(refused([](SceneLight& l) { l.type = LightType::directional; }));
    EXPECT_TRUE(refused([](SceneLight& l) { l.profile = 0; }));
    EXPECT_TRUE(refused([](SceneLight& l) { l.follows_camera = true; }));
    EXPECT_TRUE(refused([](SceneLight& l) { l.intensity.x = NAN; }));
    EXPECT_TRUE(make_light_tree({}).nodes.empty());
}

}  // namespace
}  // namespace kilolux
