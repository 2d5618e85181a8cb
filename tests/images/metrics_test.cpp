// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/metrics.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <random>

namespace kilolux {
namespace {

std::vector<float> random_values(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> out(count);
    for (float& v : out) v = static_cast<float>(random() >> 8) * 0x1p-24f;
    return out;
}

TEST(HdrMetrics, AgreesWithOpenImageIo) {
    constexpr double kFloat = 1e-7;  // it subtracts in float32
    constexpr int kNoiseWidth = 61, kNoiseHeight = 37;
    std::vector<float> a = random_values(3 * kNoiseWidth * kNoiseHeight, 1);
    std::vector<float> b = random_values(3 * kNoiseWidth * kNoiseHeight, 2);
    a[3 * (kNoiseWidth * 20 + 11) + 1] = 5.0f;
    const OIIO::ImageSpec spec(kNoiseWidth, kNoiseHeight, 3, OIIO::TypeDesc::FLOAT);
    const auto oiio = OIIO::ImageBufAlgo::compare(OIIO::ImageBuf(spec, a.data()),
                                                  OIIO::ImageBuf(spec, b.data()), 0.1f, 0.1f);
    const HdrMetrics m =
        compare_hdr(rgb_image_of(kNoiseWidth, kNoiseHeight, a),
                    rgb_image_of(kNoiseWidth, kNoiseHeight, b), {.psnr_peak = 5.0});
    EXPECT_NEAR(m.absolute.mean, oiio.meanerror, kFloat);
    EXPECT_NEAR(m.rmse, oiio.rms_error, kFloat);
    EXPECT_NEAR(m.psnr_db, oiio.PSNR, kFloat) << "its peak is the largest value of either picture";
    EXPECT_NEAR(m.absolute.max, oiio.maxerror, 5 * kFloat);
    EXPECT_EQ(m.absolute.x, oiio.maxx);
    EXPECT_EQ(m.absolute.y, oiio.maxy);
    EXPECT_EQ(m.absolute.channel, oiio.maxc);
    EXPECT_EQ(m.absolute.x, 11);
    EXPECT_EQ(m.absolute.y, 20);
}

}  // namespace
}  // namespace kilolux
