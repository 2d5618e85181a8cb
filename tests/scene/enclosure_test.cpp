// SPDX-License-Identifier: Apache-2.0
// Which scenes are interiors, seen from inside, and which are objects.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "host/scene/animated_scene.h"
#include "host/scene/generated/mesh_builder.h"
#include "host/scene/generated/scenes.h"
#include "host/scene/look_around.h"
#include "tests/support/box_scene.h"

namespace kilolux {
namespace {

using Build = std::function<void(MeshBuilder&)>;

Scene scene_of(Mesh mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, glm::dmat4(1.0)});
    return scene;
}

Scene built(const Build& build) {
    MeshBuilder builder;
    build(builder);
    return scene_of(builder.build("shape", -1, 1.0, false));
}

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

// Boxes given by their middle and size.
void block(MeshBuilder& b, const glm::dvec3& middle, const glm::dvec3& size) {
    b.box(middle - 0.5 * size, middle + 0.5 * size);
}

// A floor or a lid, walls, and thickness: an open crate where there is no lid.
void crate(MeshBuilder& b, const glm::dvec3& at, const glm::dvec3& size, double wall,
           unsigned open) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-0.5, 0.5}) {
            if ((open >> (2 * axis + (side > 0.0)) & 1u) != 0) continue;
            glm::dvec3 middle = at, plate = size;
            middle[axis] += side * (size[axis] - wall);
            plate[axis] = wall;
            block(b, middle, plate);
        }
    }
}

void legs(MeshBuilder& b, const glm::dvec2& apart, double height) {
    for (const double x : {-0.5, 0.5}) {
        for (const double z : {-0.5, 0.5}) {
            block(b, {x * apart.x, 0.5 * height, z * apart.y}, {0.06, height, 0.06});
        }
    }
}

void ball(MeshBuilder& b, const glm::dvec3& at, double radius) {
    std::vector<Point2> points;
    for (int i = 0; i <= 12; ++i) {
        const double angle = std::numbers::pi * (i / 12.0 - 0.5);
        points.push_back(radius * Point2(std::cos(angle), std::sin(angle)));
    }
    b.lathe({points}, 16, at);
}

// A surface y = height(x, z) of 20 m by 20 m.
void terrain(MeshBuilder& b, const std::function<double(double, double)>& height) {
    b.smooth_patch(40, 40,
                   [&](double u, double v) {
                       const double x = 20.0 * u - 10.0, z = 10.0 - 20.0 * v;
                       return glm::dvec3(x, height(x, z), z);
                   },
                   {1.0, 1.0});
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

struct Case {
    const char* name;
    Scene scene;
};

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
    for (const char* name : {"atrium", "corridor"}) {
        out.push_back({name, make_generated_scene(name)});
    }
    return out;
}

void expect_interior(const std::vector<Case>& cases, bool interior) {
    for (const Case& c : cases) {
        const Enclosure seen = enclosure_of(c.scene, bounds(c.scene));
        EXPECT_EQ(seen.kind == SceneKind::interior, interior)
            << c.name << ": within " << seen.within << ", open " << seen.open;
    }
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
