// SPDX-License-Identifier: Apache-2.0
// TIFF files beyond 4 GiB.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/images/file_frames.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

// TIFF's places of 32 bits reach 4 GiB: by the size of the picture, not of the strip.
TEST(BigTiff, LargeTiffIsBigTiff) {
    const Frame strip = make_frame();
    const auto is_big = [&](int height) {
        const ImageLayout layout = file_rows("a.tif", height, strip, {}, {}).layout;
        return std::ranges::any_of(layout.attributes, [](const auto& attribute) {
            return attribute.first == "tiff:bigtiff";
        });
    };
    constexpr int kMost = (1 << 30) / kFileWidth / 3 * 2;  // rows of 2^31 bytes
    EXPECT_FALSE(is_big(kMost - 1));
    EXPECT_TRUE(is_big(kMost + 2));
}

// The header says so, and the reader finds the rows.
TEST(BigTiff, BigTiffIsRead) {
    const TemporaryFolder folder;
    const Frame frame = make_frame();
    FileRows rows = file_rows(folder / "a.tif", kFileHeight, frame, {}, {});
    rows.layout.attributes.emplace_back("tiff:bigtiff", 1);
    ImageStream stream(folder / "a.tif");
    stream.write(rows);
    stream.commit();
    EXPECT_EQ(text_of_file(folder / "a.tif").substr(0, 4), std::string("II\x2b\0", 4));
    const FloatImage image = read_image(folder / "a.tif");
    for (std::size_t i = 0; i < kFilePixels; ++i) {
        ASSERT_EQ(std::lround(image.values[3 * i] * 255.0f), frame.display[4 * i]) << i;
    }
}

}  // namespace
}  // namespace kilolux
