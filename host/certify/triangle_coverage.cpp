// SPDX-License-Identifier: Apache-2.0
#include "host/certify/triangle_coverage.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "host/surfaces/surface_scene.h"
#include "host/surfaces/triangle_ids.h"

namespace kilolux {

Scene scene_of_triangles(const TriangleMesh& mesh, const glm::dmat4& world_from_object) {
    Scene scene;
    scene.name = "triangles";
    scene.materials.emplace_back().double_sided = true;
    for (const std::array<int, 3>& triangle : mesh.triangles) {
        Mesh& out = scene.meshes.emplace_back();
        for (const int vertex : triangle) {
            out.indices.push_back(static_cast<std::uint32_t>(out.positions.size()));
            out.positions.push_back(mesh.vertices.at(static_cast<std::size_t>(vertex)));
        }
        out.material = 0;
        scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, world_from_object});
    }
    return scene;
}

std::vector<int> triangle_coverage(const Gpu& gpu, const Scene& scene, const Camera& camera,
                                   int width, int height) {
    const Tuning tuning = default_tuning(gpu.info);
    const SurfaceFeatures features = surface_features(scene, {}, 1);
    SurfaceScene surfaces(gpu, tuning, scene, features);
    TriangleIds ids(gpu, tuning, scene, features);
    const View view = view_of(camera, width, height);
    std::vector<int> counts(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (Draw draw : ids.visible(camera, width, height)) {
        draw.row.first_triangle = 0;
        const std::span<const Draw> one(&draw, 1);
        StageTimer timer;
        const std::vector<uint> drawn = download(gpu, ids.draw(surfaces.at(one), one, view, timer));
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const std::size_t row = i / static_cast<std::size_t>(width);
            const std::size_t column = i % static_cast<std::size_t>(width);
            if (drawn[row * view.stride + column] != 0) ++counts[i];
        }
    }
    return counts;
}

TriangleMesh random_body(std::uint32_t seed) {
    constexpr int kAround = 12, kUp = 6;
    std::mt19937 random(seed);
    const auto radius = [&] {
        return 0.7f + 0.8f * static_cast<float>(random() % 65536u) / 65536.0f;
    };
    TriangleMesh out;
    out.vertices = {{0, -1, 0}, {0, 1, 0}};
    for (int j = 1; j < kUp; ++j) {
        for (int i = 0; i < kAround; ++i) {
            const float up = glm::pi<float>() * (static_cast<float>(j) / kUp - 0.5f);
            const float around = glm::two_pi<float>() * static_cast<float>(i) / kAround;
            out.vertices.push_back(radius() * glm::vec3(std::cos(up) * std::cos(around),
                                                        std::sin(up),
                                                        std::cos(up) * std::sin(around)));
        }
    }
    const auto ring = [](int j, int i) { return 2 + (j - 1) * kAround + i % kAround; };
    for (int i = 0; i < kAround; ++i) {
        out.triangles.push_back({0, ring(1, i + 1), ring(1, i)});
        out.triangles.push_back({1, ring(kUp - 1, i), ring(kUp - 1, i + 1)});
        for (int j = 1; j + 1 < kUp; ++j) {
            out.triangles.push_back({ring(j, i), ring(j, i + 1), ring(j + 1, i + 1)});
            out.triangles.push_back({ring(j, i), ring(j + 1, i + 1), ring(j + 1, i)});
        }
    }
    return out;
}

TriangleMesh fan(const glm::vec2& centre, int spokes) {
    TriangleMesh out;
    out.vertices.emplace_back(centre, 0.0f);
    for (int i = 0; i < spokes; ++i) {
        const double angle = glm::two_pi<double>() * i / spokes;
        out.vertices.emplace_back(std::round(centre.x + 100.0 * std::cos(angle)) + 0.5,
                                  std::round(centre.y + 100.0 * std::sin(angle)) + 0.5, 0.0);
        out.triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
    }
    return out;
}

}  // namespace kilolux
