// SPDX-License-Identifier: Apache-2.0
// Groups of objects are objects, though surfaces are all around a gap between them.
#include <gtest/gtest.h>

#include "tests/scene/enclosure_cases.h"

namespace kilolux {
namespace {

// Surfaces of revolution that repeat by `step`.
void row(MeshBuilder& b, const std::vector<Point2>& profile, int count, const glm::dvec3& step) {
    for (int i = 0; i < count; ++i) b.lathe({profile}, 32, static_cast<double>(i) * step);
}

// Vessels within one another: the surfaces between them face each other.
std::vector<Case> stacked_vessels() {
    const std::vector<Point2> bowl = {{0, 0}, {3, 0}, {7, 4}, {6.6, 4}, {2.8, 0.4}, {0, 0.4}};
    const std::vector<Point2> cup = {{0, 0}, {3, 0}, {4, 10}, {3.9, 10}, {2.9, 0.1}, {0, 0.1}};
    const std::vector<Point2> plate = {{0, 0}, {8, 0}, {12, 1}, {12, 1.3}, {8, 0.4}, {0, 0.4}};
    std::vector<Case> out;
    const auto add = [&](const char* name, const Build& build) {
        out.push_back({name, built(build)});
    };
    add("two cups in each other", [&](MeshBuilder& b) { row(b, cup, 2, {0, 1, 0}); });
    add("three cups in each other", [&](MeshBuilder& b) { row(b, cup, 3, {0, 1, 0}); });
    add("eight cups in each other", [&](MeshBuilder& b) { row(b, cup, 8, {0, 0.5, 0}); });
    add("four bowls", [&](MeshBuilder& b) { row(b, bowl, 4, {0, 0.8, 0}); });
    add("six bowls", [&](MeshBuilder& b) { row(b, bowl, 6, {0, 0.8, 0}); });
    add("pile of plates", [&](MeshBuilder& b) { row(b, plate, 8, {0, 0.6, 0}); });
    add("pots of five sizes", [](MeshBuilder& b) {
        for (double r = 4.0; r <= 8.0; ++r) {
            const double wall = r - 0.2, rim = 1.5 * r;
            b.lathe({{{0, 0}, {r, 0}, {r, rim}, {wall, rim}, {wall, 0.2}, {0, 0.2}}}, 32);
        }
    });
    add("closed dolls of five sizes", [](MeshBuilder& b) {
        for (double r = 4.0; r <= 8.0; ++r) {
            ball(b, {0, 0, 0}, r);
            b.lathe({{{0, r - 0.3}, {r - 0.3, 0}, {0, 0.3 - r}}}, 16);
        }
    });
    add("rings around each other", [](MeshBuilder& b) {
        for (double r = 3.0; r <= 8.0; ++r) {
            b.lathe({{{r, 0}, {r, 10}, {r - 0.3, 10}, {r - 0.3, 0}, {r, 0}}}, 32);
        }
    });
    add("bundle of pipes", [](MeshBuilder& b) {
        each_place({5, 1, 5}, [&](const glm::dvec3& at) {
            b.lathe({{{1, 0}, {1, 20}, {0.9, 20}, {0.9, 0}, {1, 0}}}, 16, 2.05 * at);
        });
    });
    add("nine pipes", [](MeshBuilder& b) {
        each_place({3, 1, 3}, [&](const glm::dvec3& at) {
            b.lathe({{{1, 0}, {1, 20}, {0.9, 20}, {0.9, 0}, {1, 0}}}, 16, 2.05 * at);
        });
    });
    add("sixteen cups", [&](MeshBuilder& b) {
        each_place({4, 1, 4}, [&](const glm::dvec3& at) { b.lathe({cup}, 16, 9.0 * at); });
    });
    return out;
}

// Boxes `size` large on a grid of `step`.
Build boxes(const glm::ivec3& count, const glm::dvec3& size, const glm::dvec3& step) {
    return [=](MeshBuilder& b) {
        each_place(count, [&](const glm::dvec3& at) { block(b, step * at, size); });
    };
}

std::vector<Case> stacks_and_racks() {
    std::vector<Case> out;
    const auto add = [&](const char* name, const Build& build) {
        out.push_back({name, built(build)});
    };
    add("64 boxes with gaps", boxes({4, 4, 4}, {0.9, 0.8, 0.9}, glm::dvec3(1)));
    add("216 boxes with gaps", boxes({6, 6, 6}, glm::dvec3(0.9), glm::dvec3(1)));
    add("1,000 boxes", boxes({10, 10, 10}, glm::dvec3(1.5), glm::dvec3(2)));
    add("pallet of bricks", boxes({4, 8, 8}, {0.24, 0.065, 0.115}, {0.25, 0.07, 0.12}));
    add("plates in a rack", boxes({10, 1, 1}, {0.4, 24, 24}, {2.2, 1, 1}));
    add("shelf of books", boxes({18, 5, 1}, {0.04, 0.27, 0.24}, {0.05, 0.4, 1}));
    add("pile of 64 balls", [](MeshBuilder& b) {
        each_place({4, 4, 4}, [&](const glm::dvec3& at) { ball(b, 2.05 * at, 1.0); });
    });
    add("pile of 216 balls", [](MeshBuilder& b) {
        each_place({6, 6, 6}, [&](const glm::dvec3& at) { ball(b, 2.05 * at, 1.0); });
    });
    add("cabinet with drawers", [](MeshBuilder& b) {
        crate(b, {0, 0.5, 0}, {1, 1, 1}, 0.04, 32);
        for (int i = 0; i < 4; ++i) {
            crate(b, {0, 0.15 + 0.235 * i, 0.05}, {0.9, 0.21, 0.88}, 0.02, 8);
        }
    });
    add("stack of containers", [](MeshBuilder& b) {
        each_place({3, 3, 1}, [&](const glm::dvec3& at) {
            crate(b, at * glm::dvec3(2.5, 2.6, 1), {2.4, 2.5, 12}, 0.1, 32);
        });
    });
    return out;
}

std::vector<Case> buildings_and_towns() {
    std::vector<Case> out;
    const auto add = [&](const char* name, const Build& build) {
        out.push_back({name, built(build)});
    };
    const auto floors = [](MeshBuilder& b, int count, const glm::dvec3& size) {
        for (int i = 0; i < count; ++i) block(b, {0, 3.0 * i + 0.15, 0}, size);
        const double height = 3.0 * count - 3.0;
        each_place({4, 1, 4}, [&](const glm::dvec3& at) {
            const glm::dvec3 place = (at / 3.0 - 0.5) * 0.9 * size;
            block(b, {place.x, 0.5 * height, place.z}, {0.6, height, 0.6});
        });
    };
    add("open concrete frame", [&](MeshBuilder& b) { floors(b, 8, {20, 0.3, 16}); });
    add("parking deck", [&](MeshBuilder& b) {
        floors(b, 6, {40, 0.3, 60});
        each_place({4, 5, 9}, [&](const glm::dvec3& at) {
            block(b, {10.0 * at.x - 15, 3.0 * at.y + 1.1, 6.5 * at.z - 26}, {2, 1.5, 4});
        });
    });
    const auto town = [](MeshBuilder& b, double street, double height) {
        block(b, {0, -0.1, 0}, {100, 0.2, 100});
        each_place({10, 1, 10}, [&](const glm::dvec3& at) {
            const double h = height * (0.5 + std::fmod(7 * at.x + 3 * at.z, 13) / 13);
            const double side = 10.0 - street;
            block(b, {10 * at.x - 45, 0.5 * h, 10 * at.z - 45}, {side, h, side});
        });
    };
    add("town with lanes", [&](MeshBuilder& b) { town(b, 2, 20); });
    add("town of towers", [&](MeshBuilder& b) { town(b, 3, 40); });
    add("town with streets", [&](MeshBuilder& b) { town(b, 4, 20); });
    add("forest on thin ground", [](MeshBuilder& b) {
        terrain(b, [](double, double) { return 0.0; });
        each_place({10, 1, 10}, [&](const glm::dvec3& at) {
            b.lathe({{{1, 0}, {0, 5}}}, 8, 2.0 * at - glm::dvec3(9, -0.5, 9));
        });
    });
    add("house of flats", [](MeshBuilder& b) {
        boxes({1, 5, 1}, {20, 0.3, 16}, {1, 3, 1})(b);
        boxes({5, 1, 1}, {0.2, 12.3, 16}, {5, 1, 1})(b);
    });
    add("hangar of thick walls with aeroplanes", [](MeshBuilder& b) {
        crate(b, {0, 6, 0}, {40, 14, 60}, 1, 32);
        each_place({3, 1, 3}, [&](const glm::dvec3& at) {
            block(b, {10 * at.x - 10, 1.5, 15 * at.z - 18}, {6, 3, 10});
        });
    });
    return out;
}

TEST(Enclosure, StackedVesselsAreObjects) { expect_interior(stacked_vessels(), false); }
TEST(Enclosure, StacksAndRacksAreObjects) { expect_interior(stacks_and_racks(), false); }
TEST(Enclosure, BuildingsAndTownsAreObjects) { expect_interior(buildings_and_towns(), false); }

}  // namespace
}  // namespace kilolux
