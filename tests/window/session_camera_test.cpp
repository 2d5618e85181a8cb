// SPDX-License-Identifier: Apache-2.0
// The camera of the window, moved by keys and mouse as a user does. Under Xvfb.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "host/picture/views.h"
#include "present/cli/names.h"
#include "present/window/script/script.h"
#include "present/window/script/script_player.h"
#include "tests/support/paths.h"
#include "tests/window/expected_picture.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

// The camera that the README's keys promise, by formulas instead of CameraRig: an eye, a direction
// by its angles, and the distance to the point that it orbits about.
struct Flight {
    explicit Flight(const Camera& start, const Box& box)
        : radius(0.5 * glm::length(box.size())), middle(box.center()), first(start) {
        reset();
    }
    void reset() {
        const glm::dvec3 ahead = -first.world_from_view[2];
        eye = first.position;
        yaw = std::atan2(ahead.x, -ahead.z);
        pitch = std::asin(ahead.y);
        distance = glm::length(middle - eye);
    }
    glm::dvec3 ahead() const {
        return {std::cos(pitch) * std::sin(yaw), std::sin(pitch), -std::cos(pitch) * std::cos(yaw)};
    }
    // 0.12 scene radii a second.
    void fly(double seconds) { eye += 0.12 * radius * seconds * ahead(); }
    // 2.2 radians for the window's height at 45 degrees.
    void look(double right, double down) {
        const double per_pixel = 2.2 * first.y_fov / glm::radians(45.0) / 420.0;
        yaw += per_pixel * right;
        pitch -= per_pixel * down;
    }
    void orbit(double right, double clicks) {
        const glm::dvec3 focal = eye + distance * ahead();
        yaw += 4.4 / 420.0 * right;
        distance *= std::pow(0.88, clicks);
        eye = focal - distance * ahead();
    }
    void frame() {
        distance = radius / std::sin(0.5 * first.y_fov);
        eye = middle - distance * ahead();
    }
    Camera camera() const {
        return place_camera({eye, eye + distance * ahead(), {0, 1, 0}}, first.y_fov, radius);
    }

    double radius;  // of the scene [m]
    glm::dvec3 middle;
    Camera first;
    glm::dvec3 eye{};
    double yaw = 0.0, pitch = 0.0;  // [rad]
    double distance = 0.0;          // [m]
};

TEST(Window, MovesTheCameraByKeysAndMouse) {
    const TemporaryFolder folder;
    Script script(folder);
    script.shot("start").line("key W 0.4").shot("forward");
    script.line("drag 450 250 530 280").shot("looked");
    script.line("key R 0").shot("reset");
    script.line("key O 0").line("drag 450 250 520 250").shot("orbited");
    script.line("wheel 4").shot("zoomed");
    script.line("key F 0").shot("framed");
    play(script);
    ExpectedPicture expected;
    Flight flight(expected.camera(), expected.box());
    const auto expect = [&](const char* name, const Camera& camera) {
        expect_same_picture(folder / (std::string(name) + ".png"), expected.of(camera));
    };
    expect("start", expected.camera());
    // The key is down for 12 frames after the one that presses it.
    flight.fly(13.0 / 30.0);
    expect("forward", flight.camera());
    flight.look(80.0, 30.0);
    expect("looked", flight.camera());
    flight.reset();
    expect("reset", expected.camera());
    flight.orbit(70.0, 0.0);
    expect("orbited", flight.camera());
    flight.orbit(0.0, 4.0);
    expect("zoomed", flight.camera());
    flight.frame();
    expect("framed", flight.camera());
}

}  // namespace
}  // namespace kilolux
