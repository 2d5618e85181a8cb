// SPDX-License-Identifier: Apache-2.0
// The background against double: every direction, levels, surfaces left alone, bands.
#include "host/stages/shading/fill_background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/certify/synthetic/synthetic.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr float kFormer = 7.5f;  // of radiance, before
// Of values in [0, 1], whose neighbours differ by up to 1: float's rounding of the texel's place.
constexpr double kBackgroundTolerance = 5e-5;

struct Map {
    uint width = 64, height = 32;
    std::vector<float> rgb;

    double at(int x, int y, std::size_t channel) const {
        const int w = static_cast<int>(width), h = static_cast<int>(height);
        const auto column = static_cast<std::size_t>((x + w) % w);
        const auto row = static_cast<std::size_t>(std::clamp(y, 0, h - 1));
        return double{rgb[3 * (row * width + column) + channel]};
    }
    // Bilinear towards a world direction, +X right of the middle, +Y in row 0.
    double towards(const glm::dvec3& d, std::size_t channel) const {
        const double column =
            width * (std::atan2(d.x, -d.z) / (2.0 * std::numbers::pi) + 0.5) - 0.5;
        const double row = height * std::acos(d.y / glm::length(d)) / std::numbers::pi - 0.5;
        const double left = std::floor(column), top = std::floor(row);
        const int x = static_cast<int>(left), y = static_cast<int>(top);
        const double right = column - left, down = row - top;
        const double upper = at(x, y, channel) * (1 - right) + at(x + 1, y, channel) * right;
        const double lower =
            at(x, y + 1, channel) * (1 - right) + at(x + 1, y + 1, channel) * right;
        return upper * (1 - down) + lower * down;
    }
    Map half() const {
        Map out{width / 2, height / 2, {}};
        for (int y = 0; y < static_cast<int>(out.height); ++y) {
            for (int x = 0; x < static_cast<int>(out.width); ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const double sum = at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) +
                                       at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c);
                    out.rgb.push_back(static_cast<float>(sum / 4));
                }
            }
        }
        return out;
    }
};

Map noise_map(uint width) {
    Map map{width, width / 2, {}};
    Random random(3);
    for (uint i = 0; i < 3 * map.width * map.height; ++i) {
        map.rgb.push_back(static_cast<float>(random.uniform(0.0, 1.0)));
    }
    return map;
}

// Turned so that its row axes are those of world_from_view's columns.
View turned(View view, const glm::dmat3& world_from_view) {
    const auto row = [](const glm::dvec3& v) {
        return float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0};
    };
    view.view_from_world_x = row(world_from_view[0]);
    view.view_from_world_y = row(world_from_view[1]);
    view.view_from_world_z = row(world_from_view[2]);
    return view;
}

glm::dmat3 looking(const glm::dvec3& direction) {
    const glm::dvec3 f = glm::normalize(direction);
    const glm::dvec3 right = glm::normalize(glm::cross(f, glm::dvec3(0.1, 1.0, 0.05)));
    return {right, glm::cross(right, f), -f};
}

std::vector<float> fill(const Gpu& gpu, const Map& map, const View& view, const GBuffer* gbuffer) {
    FillBackground stage(gpu, default_tuning(gpu.info));
    stage.set_image(map.rgb, map.width, map.height);
    const std::vector<float> former(std::size_t{3} * view.stride * view.height, kFormer);
    const Radiance radiance{new_buffer(gpu, former), view};
    StageTimer timer;
    if (gbuffer != nullptr) {
        stage.enqueue(*gbuffer, radiance, timer);
    } else {
        stage.enqueue_everywhere(radiance, timer);
    }
    return download<float>(gpu, radiance.planes, former.size());
}

void expect_map(const std::vector<float>& filled, const View& view, const Map& map) {
    const std::size_t plane = std::size_t{view.stride} * view.height;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            const double py = y + view.first_row + 0.5;
            const glm::dvec3 ray = view.orthographic != 0u ? glm::dvec3(0, 0, -1)
                                                           : position_at(view, x + 0.5, py, 1.0);
            const glm::dvec3 d = world_from_view(view, ray);
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_NEAR(double{filled[c * plane + std::size_t{y} * view.stride + x]},
                            map.towards(d, c), kBackgroundTolerance)
                    << x << "," << y << " channel " << c << " towards " << d.x << " " << d.y << " "
                    << d.z;
            }
        }
    }
}

TEST(FillBackground, EveryDirection) {
    const Map map = noise_map(64);
    for (const int lanes : lane_widths()) {
        const Gpu gpu = test_gpu(lanes);
        ViewShape shape;
        shape.width = 53;
        shape.height = 41;
        // Ahead, behind (over the seam), to the sides, the poles.
        for (const glm::dvec3& towards :
             {glm::dvec3(0, 0, -1), glm::dvec3(0.1, 0.2, 1), glm::dvec3(1, 0, 0),
              glm::dvec3(-1, 0.3, 0), glm::dvec3(0.01, 1, 0), glm::dvec3(0, -1, 0.02)}) {
            const View view = turned(make_view(shape), looking(towards));
            expect_map(fill(gpu, map, view, nullptr), view, map);
        }
        shape.orthographic = true;
        const View parallel = turned(make_view(shape), looking({0.3, 0.2, 0.8}));
        expect_map(fill(gpu, map, parallel, nullptr), parallel, map);
    }
}

TEST(FillBackground, AMapFinerThanThePixelsIsHalved) {
    const Gpu gpu = test_gpu(4);
    const Map map = noise_map(1024);  // 0.006 rad a texel; a pixel is 1.6 / 53 = 0.03 rad
    ViewShape shape;
    shape.width = 53;
    shape.height = 41;
    const View view = turned(make_view(shape), looking({0.3, 0.2, -1}));
    expect_map(fill(gpu, map, view, nullptr), view, map.half().half());
}

TEST(FillBackground, SurfacesStayAndBandsAgree) {
    const Gpu gpu = test_gpu(8);
    const Map map = noise_map(64);
    ViewShape shape;
    shape.width = 53;
    shape.height = 48;
    const View view = make_view(shape);
    Synthetic image = make_synthetic(view, {}, noise_depth(2.0, 50.0, 0.6, 8));
    const GBuffer gbuffer = upload_gbuffer(gpu, image);
    const std::vector<float> filled = fill(gpu, map, view, &gbuffer);
    const std::vector<float> all = fill(gpu, map, view, nullptr);
    const std::size_t plane = std::size_t{view.stride} * view.height;
    int drawn = 0;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            const std::size_t at = std::size_t{y} * view.stride + x;
            drawn += image.shows_surface(x, y) ? 1 : 0;
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_EQ(filled[c * plane + at],
                          image.shows_surface(x, y) ? kFormer : all[c * plane + at])
                    << x << "," << y;
            }
        }
    }
    EXPECT_GT(drawn, 100);
    View band = view;
    band.first_row = 16;
    band.height = 16;
    const std::vector<float> rows = fill(gpu, map, band, nullptr);
    const std::size_t band_plane = std::size_t{view.stride} * 16;
    for (std::size_t c = 0; c < 3; ++c) {
        for (uint y = 0; y < 16; ++y) {
            for (uint x = 0; x < view.width; ++x) {
                ASSERT_EQ(rows[c * band_plane + std::size_t{y} * view.stride + x],
                          all[c * plane + (y + std::size_t{16}) * view.stride + x]);
            }
        }
    }
}

TEST(FillBackground, OneTexelIsOneColour) {
    const Gpu gpu = test_gpu(4);
    const Map map{1, 1, {0.25f, 3.0f, 0.0f}};
    const View view = make_view(ViewShape{});
    const std::vector<float> filled = fill(gpu, map, view, nullptr);
    const std::size_t plane = std::size_t{view.stride} * view.height;
    for (std::size_t c = 0; c < 3; ++c) {
        for (uint x = 0; x < view.width; ++x) ASSERT_EQ(filled[c * plane + x], map.rgb[c]);
    }
}

}  // namespace
}  // namespace kilolux
