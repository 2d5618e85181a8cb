// SPDX-License-Identifier: Apache-2.0
#include "host/scene/generated/benchmark/street.h"

#include <cmath>
#include <numbers>

#include "host/scene/generated/benchmark/parts.h"
#include "host/scene/generated/small.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kStreetSeed = 3;
constexpr double kStreetLength = 160.0;  // [m], towards -Z
constexpr double kFacade = 8.0;          // [m] from the middle
constexpr double kKerb = 5.0;            // [m]
constexpr double kHouse = 10.0;          // [m] along the street
constexpr double kPostEvery = 8.0;       // [m]
constexpr double kPostHeight = 6.0;      // [m]
constexpr glm::vec3 kSodium(1.0f, 0.65f, 0.3f);

// A kind of spot.
struct SpotLamp {
    glm::vec3 intensity;  // [cd]
    float range;          // [m]
    float outer;          // [degree], half of the cone
};

void add_spot(Scene& scene, const SpotLamp& lamp, const glm::dvec3& at, const glm::dvec3& towards) {
    SceneLight& light = scene.lights.emplace_back();
    light.type = LightType::spot;
    light.position = at;
    light.direction = glm::normalize(towards);
    light.intensity = lamp.intensity;
    light.range = lamp.range;
    light.outer_cone = glm::radians(lamp.outer);
    light.inner_cone = 0.6f * light.outer_cone;
}

void add_ground(Scene& scene) {
    MeshBuilder road, pavement;
    road.level({-kKerb, -kStreetLength}, {kKerb, 10.0}, 0.0);
    for (const double side : {-1.0, 1.0}) {
        pavement.box({std::min(side * kKerb, side * kFacade), 0.0, -kStreetLength},
                     {std::max(side * kKerb, side * kFacade), 0.15, 10.0});
    }
    place(scene, add_bare(scene, "road", road, add_matte(scene, "asphalt", glm::vec3(0.12f))));
    place(scene, add_bare(scene, "pavement", pavement, add_matte(scene, "slabs", glm::vec3(0.3f))));
}

// Houses, each with a row of spots that graze its facade from below.
void add_houses(Scene& scene) {
    const int plaster[] = {add_matte(scene, "ochre", {0.6f, 0.48f, 0.3f}),
                           add_matte(scene, "brick", {0.42f, 0.2f, 0.15f}),
                           add_matte(scene, "chalk", {0.7f, 0.7f, 0.66f})};
    std::uint64_t house = 0;
    for (double z = 0.0; z < kStreetLength; z += kHouse) {
        for (const double side : {-1.0, 1.0}) {
            const auto random = [&](std::uint64_t k) {
                return benchmark_random(kStreetSeed, house, k);
            };
            const double height = 8.0 + 10.0 * random(0);
            MeshBuilder walls;
            const double a = side * kFacade, b = side * (kFacade + 8.0);
            walls.box({std::min(a, b), 0.0, -z - kHouse + 0.4}, {std::max(a, b), height, -z});
            place(scene, add_bare(scene, "house", walls, plaster[house % 3]));
            const double hue = random(1);
            const glm::vec3 color(1.0f, static_cast<float>(0.35 + 0.6 * hue),
                                  static_cast<float>(0.9 * hue));
            const SpotLamp lamp{30.0f * color, 11.0f, 40.0f};
            for (int k = 0; k < 6; ++k) {
                add_spot(scene, lamp, {side * (kFacade - 0.5), 0.4, -z - 1.0 - 1.5 * k},
                         {side * 0.2, 1.0, 0.0});
            }
            ++house;
        }
    }
}

// Posts that light the road and the pavement.
void add_posts(Scene& scene) {
    MeshBuilder post;
    const glm::dvec3 path[] = {{0.0, 0.0, 0.0}, {0.0, kPostHeight, 0.0}};
    post.tube(path, 0.08, 8);
    const int mesh = add_bare(scene, "post", post, add_matte(scene, "paint", glm::vec3(0.08f)));
    const SpotLamp road{220.0f * kSodium, 15.0f, 65.0f}, pavement{35.0f * kSodium, 8.0f, 50.0f};
    for (double z = 4.0; z < kStreetLength; z += kPostEvery) {
        for (const double side : {-1.0, 1.0}) {
            const double x = side * (kKerb + 0.4);
            place(scene, mesh, placed({x, 0.15, -z}));
            add_spot(scene, road, {x - side * 1.2, kPostHeight, -z}, {-side * 0.25, -1.0, 0.0});
            add_spot(scene, pavement, {x + side * 0.3, 4.0, -z}, {side * 0.1, -1.0, 0.0});
        }
    }
}

}  // namespace

Scene make_street() {
    Scene scene;
    scene.name = "street";
    add_ground(scene);
    add_houses(scene);
    add_posts(scene);
    scene.cameras = {camera_from_to("along", {1.6, 1.7, 6.0}, {-0.4, 2.6, -40.0}, 50.0),
                     camera_from_to("above", {-2.0, 13.0, 9.0}, {1.5, 0.0, -26.0}, 55.0)};
    return scene;
}

}  // namespace kilolux
