// SPDX-License-Identifier: Apache-2.0
// Layers of ids: floats where these are exact, else integers of 32 bits.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <algorithm>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/images/file_frames.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

TEST(ImageIds, IdsAreFloatsWhereTheseAreExact) {
    const TemporaryFolder folder;
    const auto type_of = [&](std::uint32_t id, bool uint_ids) {
        Frame frame = make_frame();
        const auto pixels = static_cast<std::size_t>(frame.width * frame.height);
        frame.aovs = {{"cluster", {"cluster"}, {}, std::vector<std::uint32_t>(pixels, id)}};
        ImageOptions options;
        options.uint_ids = uint_ids;
        write_image(folder / "a.exr", frame, {}, options);
        const FloatImage image = read_image(folder / "a.exr");
        if (!image.ids.empty()) {
            EXPECT_EQ(image.ids[0].ids[0], id);
            return OIIO::TypeDesc::UINT32;
        }
        const auto at = std::ranges::find(image.channels, "cluster") - image.channels.begin();
        EXPECT_EQ(image.values.at(static_cast<std::size_t>(at)), static_cast<float>(id));
        return OIIO::TypeDesc::FLOAT;
    };
    EXPECT_EQ(type_of(5, false), OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(type_of(1u << 24, false), OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(type_of((1u << 24) + 1, false), OIIO::TypeDesc::UINT32);
    EXPECT_EQ(type_of(5, true), OIIO::TypeDesc::UINT32);
}

// A strip's channels are those of the picture, which has ids that floats do not hold.
TEST(ImageIds, IdsOfAStripAreStoredAsThePictureNeeds) {
    Frame strip = make_frame();
    strip.aovs = {{.name = "cluster", .channels = {"cluster"}, .ids{}, .most_id = 1 << 24}};
    strip.aovs[0].ids.assign(kFilePixels, 7);
    const auto type = [&] {
        return file_rows("a.exr", 1000, strip, {}, {}).layout.channels.back().type;
    };
    EXPECT_EQ(type(), SampleType::float32);
    ++strip.aovs[0].most_id;
    EXPECT_EQ(type(), SampleType::uint32);
}

}  // namespace
}  // namespace kilolux
