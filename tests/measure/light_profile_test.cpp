// SPDX-License-Identifier: Apache-2.0
// The kernels' photometric webs against the file's own angles and values in double.
#include <gtest/gtest.h>
#include <glm/glm.hpp>
#include <random>

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "host/picture/web_in_view.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "tests/support/ies_text.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kHeaders[] = {"kernels/device/lanes.h",
                                         "kernels/shared/light_profile.h"};
constexpr std::string_view kProbe = R"(
kernel void probe(global const float* in, uint count, global const AimedProfile* lights, uint light,
                  global const float* tables, global float* out) {
    uint i = get_global_id(0) * VW;
    LightProfiles profiles = {lights, tables};
    FV3 v = fv3(lane_load(in + i), lane_load(in + count + i), lane_load(in + 2 * count + i));
    lane_store(profile_share(profiles, light, v), out + i);
}
)";
constexpr std::size_t kCount = 4096;

// Directions from the light, of lengths from 1e-6 to 1e6.
std::vector<glm::dvec3> directions() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<glm::dvec3> out;
    while (out.size() < kCount) {
        const glm::dvec3 d(unit(random), unit(random), unit(random));
        if (glm::length(d) < 1.0 && glm::length(d) > 0.1) {
            out.push_back(glm::dvec3(glm::vec3(d * std::pow(10.0, 6.0 * unit(random)))));
        }
    }
    return out;
}

std::vector<float> shares_on_device(const std::vector<glm::dvec3>& from_light,
                                    const std::vector<AimedProfile>& lights, uint light,
                                    const std::vector<float>& tables, int lanes) {
    const Gpu gpu = test_gpu(lanes);
    std::vector<float> in;
    for (const int axis : {0, 1, 2}) {
        for (const glm::dvec3& d : from_light) in.push_back(static_cast<float>(-d[axis]));
    }
    return run_probe<float>(gpu, {kHeaders, kProbe}, kCount / lanes_of(gpu), kCount, in,
                            static_cast<uint>(kCount), lights, light, tables);
}

PhotometricWeb web_of(const IesText& ies) { return read_photometric_web(ies_text(ies), ""); }

std::vector<PhotometricWeb> test_webs() {
    IesText downward{.vertical = angle_steps(0, 90, 18), .horizontal = {0, 22.5, 90}};
    downward.candela = [](double v, double h) { return 90.5 - v + 20.0 * std::sin(h * v); };
    IesText upward{.vertical = {90, 120, 180}, .horizontal = angle_steps(90, 270, 6)};
    upward.candela = [](double v, double h) { return v + std::abs(h - 180.0); };
    IesText axial{.vertical = {0, 1, 2.5, 10, 90, 180}};
    axial.candela = [](double v, double) { return v == 2.5 ? 1000.0 : 10.0; };
    return {web_of(uneven_ies()), web_of(downward), web_of(upward), web_of(axial)};
}

// Whether the direction is at 90 degrees, where a web may end.
bool is_at_edge(const WebInView& view, const glm::dvec3& d) {
    const double vertical = glm::degrees(std::acos(glm::dot(glm::normalize(d), view.down)));
    const std::vector<double>& angles = view.web->vertical;
    return std::abs(vertical - 90.0) < 1e-3 && angles.front() + angles.back() != 180.0;
}

// The error is that of the angle, 4e-7 radians, times the web's steepest slope of its peak.
TEST(LightProfile, SharesAreThoseOfTheFile) {
    Scene scene;
    scene.webs = test_webs();
    const std::vector<PhotometricWeb>& webs = scene.webs;
    const std::vector<float> starts = profile_starts(webs);
    std::vector<float> tables;
    std::vector<AimedProfile> lights;
    const glm::dvec3 down = glm::normalize(glm::dvec3(0.3, -0.8, 0.2));
    const glm::dvec3 side = glm::normalize(glm::cross(down, glm::dvec3(0.1, 0.3, 0.9)));
    for (std::size_t i = 0; i < webs.size(); ++i) {
        tables.insert(tables.end(), webs[i].table.begin(), webs[i].table.end());
        const auto f = [](double v) { return static_cast<float>(v); };
        lights.push_back({{f(down.x), f(down.y), f(down.z), starts[i]},
                          {f(side.x), f(side.y), f(side.z), i % 2 == 0 ? 1.0f : -1.0f}});
    }
    const std::vector<WebInView> views = webs_in_view(lights, scene);
    const std::vector<glm::dvec3> from_light = directions();
    for (std::size_t i = 0; i < webs.size(); ++i) {
        const auto light = static_cast<uint>(i);
        const auto found = shares_on_device(from_light, lights, light, tables, 1);
        double largest = 0.0;
        for (std::size_t k = 0; k < kCount; ++k) {
            if (is_at_edge(views[i], from_light[k])) continue;
            const double exact = share_towards(views[i], from_light[k]);
            ASSERT_GE(found[k], 0.0f);
            ASSERT_LE(found[k], 1.0f);
            largest = std::max(largest, std::abs(double{found[k]} - exact));
        }
        // A step of the axial web rises by all of its peak in 1.5 degrees: 38 a radian.
        EXPECT_LE(largest, i == 3 ? 3e-5 : 3e-6) << i;
        RecordProperty("largest_error_" + std::to_string(i), std::to_string(largest));
        for (const int lanes : {4, 8}) {
            EXPECT_EQ(shares_on_device(from_light, lights, light, tables, lanes), found) << lanes;
        }
    }
}

TEST(LightProfile, ALightWithoutOneIsEvenAndItsOwnPlaceHasAShare) {
    const std::vector<PhotometricWeb> webs = test_webs();
    const std::vector<AimedProfile> lights = {{{0, 0, 0, -1}, {0, 0, 0, 1}},
                                              {{0, -1, 0, 0}, {1, 0, 0, 1}}};
    const std::vector<glm::dvec3> nowhere(kCount, glm::dvec3(0.0));
    EXPECT_EQ(shares_on_device(directions(), lights, 0, webs[0].table, 4),
              std::vector<float>(kCount, 1.0f));
    for (const float share : shares_on_device(nowhere, lights, 1, webs[0].table, 4)) {
        ASSERT_TRUE(share >= 0.0f && share <= 1.0f) << share;
    }
}

// Angles that rounding puts before the table's first row have that row's share.
TEST(LightProfile, ReadsNothingBeforeItsTable) {
    IesText upward{.vertical = {90, 180}, .horizontal = angle_steps(0, 360, 24)};
    upward.candela = [](double v, double) { return v == 90.0 ? 30.0 : 100.0; };
    std::vector<float> tables(64, 1e30f);
    const std::vector<float> table = web_of(upward).table;
    tables.insert(tables.end(), table.begin(), table.end());
    std::vector<glm::dvec3> level;
    for (std::size_t k = 0; k < kCount; ++k) {
        const double tilt = 2e-9 * (static_cast<double>(k) - kCount / 2.0);
        const double around = 0.1 * static_cast<double>(k);
        level.emplace_back(std::cos(around), tilt, std::sin(around));
    }
    const std::vector<AimedProfile> lights = {{{0, -1, 0, 64}, {1, 0, 0, 1}}};
    std::size_t seen = 0;
    for (const float share : shares_on_device(level, lights, 0, tables, 1)) {
        if (share == 0.0f) continue;  // clearly below
        ASSERT_NEAR(share, 0.3f, 1e-5f);
        ++seen;
    }
    EXPECT_GT(seen, kCount / 2);
}

// C++'s half_turn_angle() on many directions: what light_profile.h states.
TEST(LightProfile, AnglesAreWithinTheirBound) {
    double largest = 0.0;
    for (int i = 0; i <= 400000; ++i) {
        const double angle = 3.141592653589793 * i / 400000;
        const auto x = static_cast<float>(3.0 * std::cos(angle));
        const auto y = static_cast<float>(std::max(3.0 * std::sin(angle), 0.0));
        largest =
            std::max(largest, std::abs(half_turn_angle(x, y) - std::atan2(double{y}, double{x})));
    }
    EXPECT_LE(largest, 4e-7);
    EXPECT_EQ(half_turn_angle(0.0f, 0.0f), 0.0f);
}

}  // namespace
}  // namespace kilolux
