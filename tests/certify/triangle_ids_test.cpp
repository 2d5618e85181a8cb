// SPDX-License-Identifier: Apache-2.0
// Triangles drawn in OpenCL: each pixel is one triangle's, the same on every way of drawing, and
// that of float64 rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>

#include "host/base/hash.h"
#include "host/certify/scene_case.h"
#include "host/certify/triangle_coverage.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "host/scene/generated/scenes.h"
#include "tests/certify/triangle_drawing.h"
#include "tests/support/full.h"
#include "tests/support/quad_scene.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

void expect_each_once(const std::vector<int>& counts, int width) {
    int wrong = 0;
    std::size_t first = counts.size();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 1) continue;
        ++wrong;
        first = std::min(first, i);
    }
    EXPECT_EQ(wrong, 0) << "first at " << first % static_cast<std::size_t>(width) << ", "
                        << first / static_cast<std::size_t>(width);
}

// A grid of quads cut in two, with some of its vertices on pixels' centres and the rest anywhere.
std::vector<std::array<int, 3>> grid_triangles(int cells) {
    std::vector<std::array<int, 3>> out;
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            const int a = y * (cells + 1) + x;
            const int b = a + cells + 1;
            out.push_back({a, a + 1, b + 1});
            out.push_back({a, b + 1, b});
        }
    }
    return out;
}

TEST(TriangleIds, GridsWithVerticesOnPixelsCoverEachPixelOnce) {
    constexpr int kSize = 24, kCells = 10;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> offset(-1.2f, 1.2f);
    std::vector<glm::vec3> vertices;
    for (int y = 0; y <= kCells; ++y) {
        for (int x = 0; x <= kCells; ++x) {
            glm::vec3 v(3.0f * static_cast<float>(x) - 3.0f, 3.0f * static_cast<float>(y) - 3.0f,
                        0.0f);
            if (random() % 2 == 0) {
                v += glm::vec3(0.5f, 0.5f, 0.0f);
            } else {
                v += glm::vec3(offset(random), offset(random), offset(random));
            }
            vertices.push_back(v);
        }
    }
    const Scene scene = scene_of_triangles({vertices, grid_triangles(kCells)});
    expect_each_once(triangle_coverage(test_gpu(), scene, quad_camera(kSize, kSize), kSize, kSize),
                     kSize);
}

// Triangles 2000 times as long as wide, seen in perspective from near by, and 2^20 m away from the
// world's middle.
TEST(TriangleIds, SliversFarOutCoverEachPixelOnce) {
    constexpr int kSize = 32, kCells = 12;
    std::vector<glm::vec3> vertices;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> offset(-0.3f, 0.3f);
    for (int y = 0; y <= kCells; ++y) {
        for (int x = 0; x <= kCells; ++x) {
            vertices.emplace_back((static_cast<float>(x) - 6.0f + offset(random)) * 1e-2f,
                                  (static_cast<float>(y) - 6.0f) * 20.0f, -0.02f);
        }
    }
    const glm::dvec3 far(1048576.0, -1048576.0, 3.0);
    glm::dmat4 world_from_object(1.0);
    world_from_object[3] = glm::dvec4(far, 1.0);
    const Scene scene = scene_of_triangles({vertices, grid_triangles(kCells)}, world_from_object);
    Camera camera = look_at(far, far + glm::dvec3(0.001, 0.002, -1), {0.1, 1, 0}, 1.2);
    camera.z_near = 1e-3;
    expect_each_once(triangle_coverage(test_gpu(), scene, camera, kSize, kSize), kSize);
}

// Slivers in the plane at depth 0.02, whichever vertex is first, and a large quad at `depth`.
TriangleMesh slivers_and_quad(int cells, float depth) {
    TriangleMesh mesh;
    mesh.triangles = grid_triangles(cells);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<int, 3>& t = mesh.triangles[i];
        std::rotate(t.begin(), t.begin() + i / 2 % 3, t.end());
    }
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            mesh.vertices.emplace_back((static_cast<float>(x) - 6.3f) * 1e-2f,
                                       (static_cast<float>(y) - 6.4f) * 20.0f, -0.02f);
        }
    }
    const auto corner = static_cast<int>(mesh.vertices.size());
    for (const glm::vec2 at : {glm::vec2(-100, -90), {100, -90}, {100, 90}, {-100, 90}}) {
        mesh.vertices.emplace_back(at, -depth);
    }
    mesh.triangles.push_back({corner, corner + 1, corner + 2});
    mesh.triangles.push_back({corner, corner + 2, corner + 3});
    return mesh;
}

// Depths of slivers are accurate to 0.5 %.
TEST(TriangleIds, SliversAreAsNearAsTheyAre) {
    constexpr int kSize = 32, kCells = 12;
    Camera camera = look_at({0, 0, 0}, {0.001, 0.002, -1}, {0.1, 1, 0}, 1.2);
    camera.z_near = 1e-3;
    for (const float depth : {0.0199f, 0.0201f}) {
        const TriangleMesh mesh = slivers_and_quad(kCells, depth);
        const Scene scene = scene_of_triangles(mesh);
        for (const Shown& shown : Drawing(scene).at(camera, kSize, kSize)) {
            ASSERT_EQ(shown.instance + 2 < mesh.triangles.size(), depth > 0.02f) << depth;
        }
    }
}

// Lane widths, tiles and work-groups, and bands of rows.
TEST(TriangleIds, AreTheSameOnEveryWay) {
    const Scene scene = make_generated_scene("grid");
    const Camera camera = first_camera(scene);
    constexpr int kWidth = 149, kHeight = 83;
    const Gpu gpu = test_gpu();
    const std::vector<Shown> expected = Drawing(scene).at(camera, kWidth, kHeight);
    EXPECT_GT(std::ranges::count_if(expected, [](const Shown& s) { return s != Shown{}; }), 4000);
    for (const int lanes : lane_widths()) {
        for (const auto& [width, height, group] :
             {std::array{16, 64, 1}, std::array{64, 16, 1}, std::array{32, 32, 64}}) {
            if (group > 1 && lanes > 1) continue;
            Tuning tuning = default_tuning(gpu.info);
            tuning.raster_tile_width = width;
            tuning.raster_tile_height = height;
            tuning.raster_group = group;
            tuning.raster_lanes = lanes;
            tuning.cull_chunks = 3;
            Drawing drawing(scene, test_gpu(lanes), tuning);
            EXPECT_EQ(drawing.at(camera, kWidth, kHeight), expected)
                << lanes << " lanes, " << width << "x" << height << ", groups of " << group;
        }
    }
}

// Pixels of needed tiles are the same as without restriction; others may lack surfaces.
TEST(TriangleIds, OfSomeTilesAreThoseOfAll) {
    const Scene scene = make_generated_scene("atrium");
    constexpr int kWidth = 149, kHeight = 90, kColumns = 10, kRows = 6;
    const Camera camera = first_camera(scene);
    for (const bool by_group : {false, true}) {
        Tuning tuning = default_tuning(test_gpu().info);
        tuning.raster_tile_width = tuning.raster_tile_height = by_group ? 32 : 16;
        tuning.raster_group = by_group ? 64 : 1;
        Drawing drawing(scene, test_gpu(by_group ? 1 : 0), tuning);
        const std::vector<Shown> whole = drawing.at(camera, kWidth, kHeight);
        const std::uint64_t triangles = drawing.triangles(), pairs = drawing.pairs();
        for (const int first_row : {0, -5}) {
            OpenTiles open{FINE_TILE, kColumns, first_row,
                           std::vector<bool>(std::size_t{kColumns} * kRows)};
            for (const std::size_t tile : {3u, 21u, 22u, 58u}) open.open[tile] = true;
            const std::vector<Shown> some = drawing.at(camera, kWidth, kHeight, &open);
            EXPECT_LT(drawing.triangles(), triangles);
            EXPECT_LT(drawing.pairs(), pairs / 2);
            int wrong = 0, needed = 0;
            for (int y = 0; y < kHeight; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    const int row = (y - first_row) / FINE_TILE;
                    const auto tile = static_cast<std::size_t>(row * kColumns + x / FINE_TILE);
                    if (tile >= open.open.size() || !open.open[tile]) continue;
                    const auto i = static_cast<std::size_t>(y * kWidth + x);
                    ++needed;
                    wrong += !(some[i] == whole[i]);
                }
            }
            EXPECT_EQ(wrong, 0);
            EXPECT_GT(needed, 600);
        }
    }
}

// The same bytes on every device: PoCL on AVX2 and AVX-512, and GPUs, where this test runs on them.
TEST(TriangleIds, AreTheSameOnEveryDevice) {
    const Scene scene = make_generated_scene("atrium");
    std::vector<std::uint32_t> words;
    for (const Shown& shown : Drawing(scene).at(first_camera(scene), 640, 360)) {
        words.insert(words.end(), {shown.instance, shown.triangle});
    }
    // The digits that these devices gave.
    EXPECT_EQ(hash64(std::as_bytes(std::span(words))), 0x4395e2e48ba401c3u);
}

// A pixel shows the triangle of the ray through it, or that of a ray within `tolerance` pixels.
int unlike_rays(const Scene& scene, const Camera& camera, int width, int height, double tolerance) {
    const std::vector<Shown> drawn = Drawing(scene).at(camera, width, height);
    const RayCaster caster(scene);
    std::vector<SurfaceSamples> rays;
    for (const glm::dvec2 offset : {glm::dvec2(0), glm::dvec2(1, 0), glm::dvec2(-1, 0),
                                    glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
        Camera moved = camera;
        moved.jitter += offset * tolerance;
        rays.push_back(caster.cast(moved, width, height));
    }
    int unlike = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const bool found = std::ranges::any_of(rays, [&](const SurfaceSamples& cast) {
            const SurfaceSample& s = cast.pixels[i];
            const bool background = s.kind == SurfaceKind::background;
            return drawn[i] == (background ? Shown{} : Shown{s.instance, s.triangle});
        });
        if (!found) ++unlike;
    }
    return unlike;
}

TEST(TriangleIds, AreThoseOfRays) {
    const Scene scene = make_generated_scene("atrium");
    // Leaves of two levels of detail, and surfaces that lie in one plane.
    EXPECT_LE(unlike_rays(scene, first_camera(scene), 320, 180, 2e-3), 320 * 180 / 1000);
}

// Texels' alpha, in a quad that is turned away from the viewer: mip levels differ along it.
TEST(TriangleIds, AreThoseOfRaysThroughMasks) {
    Scene scene = quad_scene(4.0f);
    Image& image = scene.images.emplace_back();
    image.width = image.height = 64;
    for (int i = 0; i < 64 * 64; ++i) {
        const int block = i % 64 / 4 + i / 64 / 4 * 16;
        const auto alpha = static_cast<std::uint8_t>(block * 151 % 256);
        image.rgba.insert(image.rgba.end(), {200, 100, 50, alpha});
    }
    scene.textures.emplace_back().image = 0;
    Material& material = scene.materials.front();
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.45f;
    material.base_color_texture.texture = 0;
    const Camera camera = look_at({3, 2, 3}, {0, 0, 0}, {0, 1, 0}, 1.0);
    const std::vector<Shown> drawn = Drawing(scene).at(camera, 160, 90);
    const auto seen = std::ranges::count_if(drawn, [](const Shown& s) { return s != Shown{}; });
    EXPECT_GT(seen, 1500);
    EXPECT_LE(unlike_rays(scene, camera, 160, 90, 2e-3), 4);
}

TEST(TriangleIds, AreThoseOfParallelRays) {
    const Scene scene = make_generated_scene("corridor");
    Camera camera = first_camera(scene);
    camera.orthographic = true;
    camera.y_extent = 2.0;
    camera.z_near = 0.5;
    camera.z_far = 30.0;
    EXPECT_LE(unlike_rays(scene, camera, 160, 90, 2e-3), 160 * 90 / 1000);
}

}  // namespace
}  // namespace kilolux
