// SPDX-License-Identifier: Apache-2.0
// Which scenes are interiors, seen from inside, and which are objects.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "host/scene/animated_scene.h"
#include "host/scene/enclosure.h"
#include "host/scene/generated/mesh_builder.h"
#include "host/scene/generated/scenes.h"
#include "tests/scene/enclosure_cases.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

// Walls that face inwards. Bits of `open` leave sides out: -x, +x, -y, +y, -z, +z.
Mesh room(const glm::dvec3& size, unsigned open = 0) {
    Mesh mesh = box_mesh(size, true);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if ((open >> (i / 6) & 1u) == 0) kept.push_back(mesh.indices[i]);
    }
    mesh.indices = std::move(kept);
    return mesh;
}

Scene furnished(const Mesh& walls, const Build& build) {
    Scene scene = built(build);
    scene.meshes.push_back(walls);
    scene.instances.push_back({1, glm::dmat4(1.0)});
    return scene;
}

void legs(MeshBuilder& b, const glm::dvec2& apart, double height) {
    for (const double x : {-0.5, 0.5}) {
        for (const double z : {-0.5, 0.5}) {
            block(b, {x * apart.x, 0.5 * height, z * apart.y}, {0.06, height, 0.06});
        }
    }
}

void houses(MeshBuilder& b, double street) {
    b.level({-8, -30}, {8, 30}, 0.0);
    for (const double x : {-0.5 * street - 3.0, 0.5 * street + 3.0}) {
        for (int i = -3; i < 3; ++i) block(b, {x, 4.0, 9.0 * i + 4.5}, {6.0, 8.0, 8.5});
    }
}

Scene inward_ball() {
    Scene scene = built([](MeshBuilder& b) { ball(b, {0, 0, 0}, 3.0); });
    std::vector<std::uint32_t>& indices = scene.meshes[0].indices;
    for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    return scene;
}

// Walls, floor and ceiling of sheets.
Scene corner_room() {
    const std::vector<glm::dvec2> corners = {{0, 0}, {6, 0}, {6, 3}, {3, 3}, {3, 6}, {0, 6}};
    return built([&](MeshBuilder& b) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::dvec2 from = corners[i], to = corners[(i + 1) % corners.size()];
            b.quad({from.x, 0, from.y}, {to.x, 0, to.y}, {to.x, 3, to.y}, {from.x, 3, from.y},
                   {from.y - to.y, 0, to.x - from.x});
        }
        for (const double up : {1.0, -1.0}) {
            b.level({0, 0}, {6, 3}, 1.5 - 1.5 * up, up);
            b.level({0, 3}, {3, 6}, 1.5 - 1.5 * up, up);
        }
    });
}

// Inner walls with doors.
Scene flat() {
    return furnished(room({12, 3, 8}), [](MeshBuilder& b) {
        for (const double x : {-4.5, 0.0, 4.5}) block(b, {x, 0, 0}, {3, 3, 0.1});
        for (const double x : {-2.0, 2.0}) {
            for (const double z : {-2.5, 2.5}) block(b, {x, 0, z}, {0.1, 3, 3});
        }
    });
}

std::vector<Case> vessels_and_tubes() {
    const auto turned = [](std::vector<Point2> points) {
        return built([&](MeshBuilder& b) { b.lathe({std::move(points)}, 32); });
    };
    std::vector<Case> out;
    out.push_back({"mug", turned({{0, 0}, {4, 0}, {4, 10}, {3.6, 10}, {3.6, 0.5}, {0, 0.5}})});
    out.push_back({"bowl", turned({{0, 0}, {3, 0}, {7, 4}, {6.6, 4}, {2.8, 0.4}, {0, 0.4}})});
    out.push_back(
        {"vase",
         turned({{0, 0}, {3, 0}, {5, 8}, {1, 14}, {0.8, 14}, {4.7, 8}, {2.8, 0.3}, {0, 0.3}})});
    out.push_back({"plate", turned({{0, 0}, {8, 0}, {12, 1}, {12, 1.3}, {8, 0.4}, {0, 0.4}})});
    out.push_back({"barrel", turned({{0, 0}, {3, 0}, {4, 5}, {3, 10}, {0, 10}})});
    out.push_back({"glass of one sheet", turned({{0, 0}, {3, 0}, {4, 10}})});
    out.push_back({"pipe", turned({{3, 0}, {3, 20}, {2.7, 20}, {2.7, 0}, {3, 0}})});
    out.push_back({"ring", turned({{9, 0}, {10, 0}, {10, 1}, {9, 1}, {9, 0}})});
    out.push_back({"tube without caps", built([](MeshBuilder& b) {
                       b.tube(std::vector<glm::dvec3>{{0, 0, 0}, {5, 0, 0}, {8, 4, 0}}, 1.0, 16);
                   })});
    return out;
}

std::vector<Case> furniture_and_vehicles() {
    std::vector<Case> out;
    const auto add = [&](const char* name, const Build& build) {
        out.push_back({name, built(build)});
    };
    add("table", [](MeshBuilder& b) {
        legs(b, {1.5, 0.7}, 0.7);
        block(b, {0, 0.72, 0}, {1.6, 0.04, 0.8});
    });
    add("chair", [](MeshBuilder& b) {
        legs(b, {0.4, 0.4}, 0.45);
        block(b, {0, 0.47, 0}, {0.45, 0.04, 0.45});
        block(b, {0, 0.7, -0.2}, {0.45, 0.5, 0.04});
    });
    add("shelf", [](MeshBuilder& b) {
        crate(b, {0, 1, 0}, {1, 2, 0.4}, 0.03, 32);
        for (int i = 1; i < 5; ++i) block(b, {0, 0.4 * i, 0}, {0.95, 0.03, 0.36});
    });
    add("crate", [](MeshBuilder& b) { crate(b, {0, 0, 0}, {1, 0.6, 0.8}, 0.03, 8); });
    add("closed cupboard", [](MeshBuilder& b) { crate(b, {0, 0, 0}, {1, 2, 0.6}, 0.03, 0); });
    add("sofa", [](MeshBuilder& b) {
        block(b, {0, 0.2, 0}, {2, 0.4, 0.9});
        block(b, {0, 0.6, -0.4}, {2, 0.8, 0.15});
        for (const double x : {-1.0, 1.0}) block(b, {x, 0.35, 0}, {0.2, 0.7, 0.9});
    });
    add("car", [](MeshBuilder& b) {
        crate(b, {0, 0.6, 0}, {1.8, 0.7, 4.2}, 0.05, 8);
        crate(b, {0, 1.3, 0.2}, {1.6, 0.1, 2.0}, 0.05, 4);
        legs(b, {1.5, 1.9}, 1.3);
        for (const double x : {-0.8, 0.8}) {
            for (const double z : {-1.4, 1.4}) block(b, {x, 0.3, z}, {0.2, 0.6, 0.6});
        }
    });
    add("boat", [](MeshBuilder& b) { crate(b, {0, 0, 0}, {2, 1, 6}, 0.05, 8); });
    add("bus", [](MeshBuilder& b) { crate(b, {0, 1.5, 0}, {2.5, 3, 10}, 0.05, 2); });
    return out;
}

std::vector<Case> groups_and_ground() {
    std::vector<Case> out;
    const auto add = [&](const char* name, const Build& build) {
        out.push_back({name, built(build)});
    };
    add("ring of balls", [](MeshBuilder& b) {
        for (int i = 0; i < 12; ++i) {
            const double a = 2.0 * std::numbers::pi * i / 12.0;
            ball(b, {3.0 * std::cos(a), 0, 3.0 * std::sin(a)}, 0.9);
        }
    });
    add("cubes in a grid", [](MeshBuilder& b) {
        for (int i = 0; i < 64; ++i) {
            block(b, 2.0 * glm::dvec3(i % 4, i / 4 % 4, i / 16), glm::dvec3(1.4));
        }
    });
    add("two boxes", [](MeshBuilder& b) {
        for (const double x : {-3.0, 3.0}) block(b, {x, 1, 0}, {4, 5, 6});
    });
    add("columns on a floor", [](MeshBuilder& b) {
        b.level({-10, -10}, {10, 10}, 0.0);
        for (int i = 0; i < 100; ++i) {
            block(b, {2.0 * (i % 10) - 9.0, 2, 2.0 * (i / 10) - 9.0}, {0.8, 4, 0.8});
        }
    });
    add("tree", [](MeshBuilder& b) {
        b.tube(std::vector<glm::dvec3>{{0, 0, 0}, {0, 3, 0}}, 0.2, 8);
        for (int i = 0; i < 6; ++i) ball(b, {std::cos(i), 3.5, std::sin(i)}, 0.8);
    });
    add("hills", [](MeshBuilder& b) {
        terrain(b, [](double x, double z) { return std::sin(0.7 * x) * std::cos(0.6 * z); });
    });
    add("valley",
        [](MeshBuilder& b) { terrain(b, [](double x, double) { return 0.08 * x * x; }); });
    add("crater", [](MeshBuilder& b) {
        terrain(b, [](double x, double z) { return 0.06 * (x * x + z * z); });
    });
    add("street of houses", [](MeshBuilder& b) { houses(b, 6.0); });
    add("alley of houses", [](MeshBuilder& b) { houses(b, 2.5); });
    add("terrace with parapet", [](MeshBuilder& b) { crate(b, {0, 0.5, 0}, {10, 1, 8}, 0.2, 8); });
    add("house of thick walls", [](MeshBuilder& b) { crate(b, {0, 2, 0}, {8, 4, 6}, 0.3, 0); });
    add("doll's house", [](MeshBuilder& b) { crate(b, {0, 2, 0}, {8, 4, 6}, 0.3, 32); });
    out.push_back({"terrace of sheets", scene_of(room({10, 3, 8}, 1 | 8 | 32))});
    out.push_back({"corner of two walls", scene_of(room({4, 3, 4}, 2 | 8 | 32))});
    return out;
}

std::vector<Case> interiors() {
    std::vector<Case> out;
    out.push_back({"room", scene_of(room({5, 3, 4}))});
    out.push_back({"room without its near wall", scene_of(room({5, 3, 4}, 32))});
    out.push_back({"stage", scene_of(room({10, 4, 4}, 32))});
    out.push_back({"room without a ceiling", scene_of(room({5, 3, 4}, 8))});
    out.push_back({"corridor with open ends", scene_of(room({2, 3, 20}, 16 | 32))});
    out.push_back({"hall with columns", furnished(room({30, 8, 12}), [](MeshBuilder& b) {
                       for (int i = 0; i < 20; ++i) {
                           block(b, {2.8 * (i % 10) - 12.6, 0, i < 10 ? -4 : 4}, {0.6, 8, 0.6});
                       }
                   })});
    out.push_back(
        {"room with a block in its middle", furnished(room({6, 3, 6}), [](MeshBuilder& b) {
             block(b, {0, -0.2, 0}, {1.5, 2.6, 1.5});
         })});
    out.push_back({"dome", inward_ball()});
    out.push_back({"room full of crates", furnished(room({10, 3, 10}), [](MeshBuilder& b) {
                       each_place({4, 1, 4}, [&](const glm::dvec3& at) {
                           block(b, {2.2 * at.x - 3.3, -0.9, 2.2 * at.z - 3.3}, {1, 1.2, 1});
                       });
                   })});
    out.push_back({"flat of six rooms", flat()});
    out.push_back({"L-shaped room", corner_room()});
    for (const char* name : {"atrium", "corridor"}) {
        out.push_back({name, make_generated_scene(name)});
    }
    return out;
}

TEST(Enclosure, VesselsAndTubesAreObjects) { expect_interior(vessels_and_tubes(), false); }
TEST(Enclosure, FurnitureAndVehiclesAreObjects) {
    expect_interior(furniture_and_vehicles(), false);
}
TEST(Enclosure, GroupsAndGroundAreObjects) { expect_interior(groups_and_ground(), false); }
// Embree ends a program that gives it instances without a size.
TEST(Enclosure, OfTrianglesThatArePointsIsNone) {
    for (const double scale : {1.0, 1e-30}) {
        Mesh mesh;
        mesh.positions.assign(3, {1.0f, 2.0f, 3.0f});
        mesh.normals.assign(3, {0.0f, 0.0f, 1.0f});
        mesh.indices = {0, 1, 2};
        Scene scene = scene_of(std::move(mesh));
        scene.instances[0].world_from_object = glm::dmat4(glm::dmat3(scale));
        scene.instances.push_back(scene.instances[0]);
        EXPECT_EQ(enclosure_of(scene, bounds(scene)).kind, SceneKind::open);
    }
}

// Embree ends a program whose rays leave its range: those that meet an instance are made longer by
// the inverse of its scale.
TEST(Enclosure, OfShapesOfAnySizeIsFound) {
    for (const double scale : {1e-30, 1e-12, 1.0, 1e12, 1e30}) {
        for (const double vertices : {1e-30, 1.0, 1e30}) {
            Mesh mesh;
            const auto far = static_cast<float>(vertices);
            mesh.positions = {{0.0f, 0.0f, 0.0f}, {far, 0.0f, 0.0f}, {0.0f, far, 0.0f}};
            mesh.normals.assign(3, {0.0f, 0.0f, 1.0f});
            mesh.indices = {0, 1, 2};
            mesh.positions.push_back({3e38f, 0.0f, 0.0f});  // of no triangle
            mesh.normals.push_back({0.0f, 0.0f, 1.0f});
            Scene scene = scene_of(std::move(mesh));
            for (const glm::dvec3& factors : {glm::dvec3(1.0), glm::dvec3(1.0, 1.0, 1e-20)}) {
                glm::dmat3 size(scale);
                for (int i = 0; i < 3; ++i) size[i] *= factors[i];
                scene.instances[0].world_from_object = glm::dmat4(size);
                scene.instances.resize(1);
                scene.instances.push_back(scene.instances[0]);
                scene.instances[1].world_from_object = glm::dmat4(glm::dmat3(1.0));
                EXPECT_EQ(enclosure_of(scene, bounds(scene)).kind, SceneKind::open);
            }
        }
    }
}

TEST(Enclosure, WallsWithoutOuterSidesAreInteriors) { expect_interior(interiors(), true); }

}  // namespace
}  // namespace kilolux
