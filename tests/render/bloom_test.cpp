// SPDX-License-Identifier: Apache-2.0
// Bloom: it moves light and neither makes nor loses any.
#include "host/stages/picture/bloom.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "host/render/plan/kernel_choice.h"
#include "tests/support/full.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

struct BloomPicture {
    View view{};
    std::vector<float> planes;  // [3][height][stride]

    float& at(uint plane, uint x, uint y) {
        return planes[(std::size_t{plane} * view.height + y) * view.stride + x];
    }
    double sum(uint plane) {
        double out = 0.0;
        for (uint y = 0; y < view.height; ++y) {
            for (uint x = 0; x < view.width; ++x) out += at(plane, x, y);
        }
        return out;
    }
};

// Pixels past the width must not bloom into the picture.
BloomPicture picture(uint width, uint height, float value = 0.0f) {
    BloomPicture out;
    out.view.width = width;
    out.view.height = height;
    out.view.stride = (width + 15) / 16 * 16;
    out.planes.assign(std::size_t{3} * out.view.stride * height, 777.0f);
    for (uint c = 0; c < 3; ++c) {
        for (uint y = 0; y < height; ++y) {
            for (uint x = 0; x < width; ++x) out.at(c, x, y) = value;
        }
    }
    return out;
}

Gpu gpu_of(int lanes) {
    RenderSettings settings = small_settings();
    settings.kernels.lanes = lanes;
    return open_device(settings);
}

BloomPicture bloomed(const Gpu& gpu, const BloomPicture& source, float share) {
    GrowingBuffer buffer(gpu, "test");
    buffer.reserve(source.planes.size() * sizeof(float));
    upload<float>(gpu, buffer.get(), source.planes);
    Bloom stage(gpu);
    StageTimer timer;
    const Radiance out = stage.enqueue({buffer.get(), source.view}, share, timer);
    BloomPicture picture{source.view, download<float>(gpu, out.planes, source.planes.size())};
    const auto after = download<float>(gpu, buffer.get(), source.planes.size());
    EXPECT_EQ(std::memcmp(after.data(), source.planes.data(), after.size() * sizeof(float)), 0);
    return picture;
}

TEST(Bloom, KeepsTheEnergyOfImpulses) {
    const Gpu gpu = gpu_of(0);
    const std::pair<uint, uint> places[] = {{128, 64}, {127, 63}, {70, 41}, {0, 0}, {255, 5}};
    for (const auto& [x, y] : places) {
        BloomPicture source = picture(256, 128);
        for (uint c = 0; c < 3; ++c) source.at(c, x, y) = 1000.0f * static_cast<float>(c + 1);
        BloomPicture out = bloomed(gpu, source, 0.3f);
        for (uint c = 0; c < 3; ++c) {
            const double given = 1000.0 * (c + 1);
            EXPECT_NEAR(out.sum(c), given, 1e-5 * given) << x << ", " << y << ", plane " << c;
            EXPECT_LT(out.at(c, x, y), 0.8f * static_cast<float>(given));
            EXPECT_GE(out.at(c, x, y), 0.7f * static_cast<float>(given));
        }
        EXPECT_GT(out.at(0, x < 128 ? x + 20 : x - 20, y), 0.0f) << "the skirt is wide";
    }
}

TEST(Bloom, KeepsTheEnergyOfInteriorImpulsesAtOddSizes) {
    const Gpu gpu = gpu_of(0);
    BloomPicture source = picture(243, 201);
    source.at(1, 121, 100) = 50.0f;
    EXPECT_NEAR(bloomed(gpu, source, 1.0f).sum(1), 50.0, 50.0 * 1e-3);
}

TEST(Bloom, LeavesAConstantImageAsItIs) {
    for (const auto& [width, height] : std::vector<std::pair<uint, uint>>{
             {1, 1}, {17, 31}, {16, 16}, {33, 95}, {100, 1}, {160, 90}}) {
        for (const int lanes : {1, 8}) {
            BloomPicture out = bloomed(gpu_of(lanes), picture(width, height, 0.37f), 0.8f);
            for (uint c = 0; c < 3; ++c) {
                for (uint y = 0; y < height; ++y) {
                    for (uint x = 0; x < width; ++x) {
                        ASSERT_NEAR(out.at(c, x, y), 0.37f, 2e-6f)
                            << width << "x" << height << ": " << x << ", " << y;
                    }
                }
            }
        }
    }
}

BloomPicture noise(uint width, uint height) {
    BloomPicture out = picture(width, height);
    std::uint32_t state = 1;
    for (float& value : out.planes) {
        state = state * 1664525u + 1013904223u;
        value = static_cast<float>(state >> 8) * 0x1p-20f;
    }
    return out;
}

TEST(Bloom, IsMirrorSymmetric) {
    const Gpu gpu = gpu_of(0);
    BloomPicture source = noise(128, 64);
    BloomPicture mirrored = source;
    for (uint c = 0; c < 3; ++c) {
        for (uint y = 0; y < 64; ++y) {
            for (uint x = 0; x < 128; ++x) mirrored.at(c, x, y) = source.at(c, 127 - x, 63 - y);
        }
    }
    BloomPicture a = bloomed(gpu, source, 0.5f);
    BloomPicture b = bloomed(gpu, mirrored, 0.5f);
    for (uint c = 0; c < 3; ++c) {
        for (uint y = 0; y < 64; ++y) {
            for (uint x = 0; x < 128; ++x) {
                ASSERT_NEAR(a.at(c, x, y), b.at(c, 127 - x, 63 - y), 1e-5f * a.at(c, x, y));
            }
        }
    }
}

TEST(Bloom, SameBitsForLaneWidths) {
    const BloomPicture source = noise(83, 61);
    BloomPicture expected = bloomed(gpu_of(1), source, 0.5f);
    for (const int lanes : lane_widths()) {
        BloomPicture found = bloomed(gpu_of(lanes), source, 0.5f);
        for (uint y = 0; y < 61; ++y) {
            for (uint x = 0; x < 83; ++x) {
                ASSERT_EQ(found.at(2, x, y), expected.at(2, x, y)) << lanes << " lanes";
            }
        }
    }
}

TEST(Bloom, WhatIsNoLightDoesNotSpread) {
    BloomPicture source = picture(64, 64, 1.0f);
    source.at(0, 30, 30) = std::numeric_limits<float>::quiet_NaN();
    source.at(1, 30, 30) = -1e30f;
    BloomPicture out = bloomed(gpu_of(0), source, 0.5f);
    EXPECT_GE(out.at(0, 31, 30), 0.9f);
    EXPECT_GE(out.at(1, 31, 30), 0.9f);
}

TEST(Bloom, IsOfTheDisplayOnly) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings();
    const Frame plain = render_once(scene, settings);
    settings.bloom = 0.5f;
    const Frame blooming = render_once(scene, settings);
    EXPECT_EQ(plain.radiance, blooming.radiance);
    EXPECT_NE(plain.display, blooming.display);
    const auto has_stage = [](const Frame& frame) {
        return std::any_of(frame.stats.stages.begin(), frame.stats.stages.end(),
                           [](const StageTime& s) { return s.name == "bloom"; });
    };
    EXPECT_FALSE(has_stage(plain));
    EXPECT_TRUE(has_stage(blooming));
}

TEST(Bloom, NoShareIsTheSameBuffer) {
    const Gpu gpu = gpu_of(0);
    const BloomPicture source = noise(64, 64);
    EXPECT_EQ(bloomed(gpu, source, 0.0f).planes, source.planes);
}

}  // namespace
}  // namespace kilolux
