// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "host/scene/generated/noise.h"
#include "host/scene/generated/scenes.h"
#include "tests/scene/generated_scenes_fixture.h"

namespace kilolux {
namespace {

TEST(Atrium, IsTheStoredBuilding) {
    EXPECT_EQ(fingerprint(scene_of("atrium")), 11900675417646898819u);
}

TEST(Atrium, IsAsLargeAsPromised) {
    const Scene& scene = scene_of("atrium");
    EXPECT_NEAR(static_cast<double>(triangle_count(scene)), 250e3, 25e3);
    EXPECT_GE(scene.instances.size(), 50u);
    EXPECT_LE(scene.instances.size(), 320u);
    EXPECT_EQ(scene.cameras.size(), 4u);
    const glm::dvec3 size = bounds(scene).size();
    EXPECT_NEAR(size.x, 31.0, 2.0);
    EXPECT_NEAR(size.y, 12.5, 1.0);
    EXPECT_NEAR(size.z, 18.5, 2.0);
}

TEST(Atrium, NeedsNoFourthPlane) {
    for (const Material& material : scene_of("atrium").materials) {
        EXPECT_EQ(material.metallic, 0.0f) << material.name;
        EXPECT_EQ(material.emissive, glm::vec3(0.0f)) << material.name;
        EXPECT_EQ(material.alpha_mode, AlphaMode::opaque) << material.name;
    }
}

TEST(Atrium, NormalMapsHaveTangents) {
    const Scene& scene = scene_of("atrium");
    std::set<std::string> mapped;
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        EXPECT_EQ(material.normal_texture.present(), !mesh.tangents.empty()) << mesh.name;
        if (material.normal_texture.present()) mapped.insert(material.name);
    }
    EXPECT_EQ(mapped.count("brick") + mapped.count("tile"), 2u);
}

TEST(Atrium, SeedsDiffer) {
    const Scene other = make_generated_scene("atrium", 2);
    EXPECT_NE(fingerprint(other), fingerprint(scene_of("atrium")));
    EXPECT_NE(image_fingerprint(other), image_fingerprint(scene_of("atrium")));
    EXPECT_EQ(triangle_count(other) / 10000, triangle_count(scene_of("atrium")) / 10000);
}

// At an image's border neighbours must be about as similar as inside it.
TEST(Atrium, TexturesTile) {
    for (const Image& image : scene_of("atrium").images) {
        const auto row_step = [&](int y) {
            double sum = 0.0;
            for (int x = 0; x < image.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](int row) {
                        return image.rgba[static_cast<std::size_t>(
                            4 * ((row % image.height) * image.width + x) + c)];
                    };
                    sum += std::abs(at(y) - at(y + 1));
                }
            }
            return sum / image.width;
        };
        const auto column_step = [&](int x) {
            double sum = 0.0;
            for (int y = 0; y < image.height; ++y) {
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](int column) {
                        return image.rgba[static_cast<std::size_t>(
                            4 * (y * image.width + column % image.width) + c)];
                    };
                    sum += std::abs(at(x) - at(x + 1));
                }
            }
            return sum / image.height;
        };
        double largest_row = 0.0;
        double largest_column = 0.0;
        for (int i = 0; i + 1 < image.height; ++i) largest_row = std::max(largest_row, row_step(i));
        for (int i = 0; i + 1 < image.width; ++i) {
            largest_column = std::max(largest_column, column_step(i));
        }
        EXPECT_LE(row_step(image.height - 1), 1.3 * largest_row + 1.0) << image.name;
        EXPECT_LE(column_step(image.width - 1), 1.3 * largest_column + 1.0) << image.name;
    }
}

TEST(ProceduralNoise, HasItsPeriod) {
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 p(0.37 * i, 0.11 * i);
        EXPECT_NEAR(gradient_noise(p, {8, 5}, 3), gradient_noise(p + glm::dvec2(8, 5), {8, 5}, 3),
                    1e-9);
        const glm::dvec2 q = glm::fract(p);
        EXPECT_NEAR(fractal_noise(q, 4, 5, 9), fractal_noise(q + 1.0, 4, 5, 9), 1e-9);
        EXPECT_LE(std::abs(fractal_noise(q, 4, 5, 9)), 1.2);
    }
}

}  // namespace
}  // namespace kilolux
