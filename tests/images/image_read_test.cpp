// SPDX-License-Identifier: Apache-2.0
// Image files that are read.
#include <gtest/gtest.h>
#include <cmath>

#include "host/base/formats/srgb.h"
#include "host/base/system/atomic_write.h"
#include "host/images/images.h"
#include "host/scene/lights/environment.h"
#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/images/file_frames.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

TEST(ImageRead, ATruncatedExrIsAnErrorAndNotAPicture) {
    const TemporaryFolder folder;
    auto bytes = encode_image("a.exr", make_layered_frame(), {}, {});
    const std::string half(reinterpret_cast<const char*>(bytes.data()), bytes.size() / 2);
    write_text(folder / "a.exr", half);
    EXPECT_THROW(read_image(folder / "a.exr"), Error);
}

// An environment's light is that of its file's sRGB codes, whatever its alpha.
TEST(ImageRead, AlphaDarkensNoEnvironment) {
    const TemporaryFolder folder;
    const std::vector<unsigned char> half(std::size_t{4} * 4 * 2, 128);
    ImageLayout layout{4, 2, {}};
    for (const char* name : {"R", "G", "B", "A"}) {
        layout.channels.push_back({name, SampleType::uint8});
    }
    write_atomically(folder / "a.png", encode_pixels("a.png", "png", layout, half, 4));
    for (const glm::vec3& light : read_environment(folder / "a.png").rows) {
        EXPECT_NEAR(light.x, srgb_to_linear(128.0 / 255.0), 1e-6);
    }
}

TEST(ImageRead, WebpKeepsTheColoursThatAlphaHides) {
    // Lossless, 2x2 pixels, by libwebp.
    const unsigned char webp[] = {0x52, 0x49, 0x46, 0x46, 0x3a, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42,
                                  0x50, 0x56, 0x50, 0x38, 0x4c, 0x2e, 0x00, 0x00, 0x00, 0x2f, 0x01,
                                  0x40, 0x00, 0x10, 0x1f, 0x20, 0xa6, 0x21, 0xe6, 0xd2, 0x55, 0x7c,
                                  0x69, 0x14, 0xb4, 0x6d, 0xc3, 0xf4, 0xed, 0xf0, 0x07, 0x34, 0x6a,
                                  0x53, 0xd0, 0x36, 0x0a, 0x9c, 0xba, 0x17, 0x0c, 0xc0, 0x03, 0xff,
                                  0x83, 0x57, 0x77, 0xed, 0xd7, 0x5d, 0xec, 0x42, 0x44, 0xff, 0x23};
    const TemporaryFolder folder;
    write_atomically(folder / "a.webp", webp);
    std::vector<float> codes = read_image(folder / "a.webp").values;
    for (float& code : codes) code = std::round(code * 255.0f);
    EXPECT_EQ(codes, (std::vector<float>{200, 100, 50, 0, 10, 250, 30, 1,  //
                                         7, 8, 9, 128, 255, 1, 2, 255}));
}

TEST(ImageRead, ColourOfGreyAndUnnamedChannels) {
    const FloatImage grey{2, 1, {"Y"}, {1.0f, 2.0f}};
    EXPECT_EQ(colour_of(grey), (std::vector<float>{1, 1, 1, 2, 2, 2}));
    const FloatImage mixed{1, 1, {"Z", "B", "G", "R"}, {9, 3, 2, 1}};
    EXPECT_EQ(colour_of(mixed), (std::vector<float>{1, 2, 3}));
    EXPECT_THROW(colour_of(FloatImage{}), Error);
}

}  // namespace
}  // namespace kilolux
