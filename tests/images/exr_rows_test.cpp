// SPDX-License-Identifier: Apache-2.0
// OpenEXR files, whose rows are compressed in pieces, are those that OpenImageIO writes in one.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "host/base/system/atomic_write.h"
#include "host/images/images.h"
#include "present/image/image_file.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

// Pieces of 32 rows: a row has 84 KB. The last block is not whole.
constexpr int kWidth = 6007;
constexpr int kHeight = 101;

// Smooth values with some noise, which compressions make smaller, then rows that no compression
// does.
std::vector<unsigned char> wide_pixels() {
    constexpr std::size_t kPixelBytes = 14;
    std::vector<unsigned char> out(std::size_t{kWidth} * kHeight * kPixelBytes);
    unsigned noise = 1;
    for (std::size_t i = 0; i < out.size(); ++i) {
        noise = noise * 1664525u + 1013904223u;
        const bool is_smooth = i < out.size() / 2;
        out[i] = static_cast<unsigned char>(is_smooth ? i / 5000 + (noise >> 31) : noise >> 24);
    }
    return out;
}

ImageLayout wide_layout(const std::string& compression) {
    ImageLayout layout{kWidth, kHeight, {}};
    for (const char* name : {"R", "G", "B"}) {
        layout.channels.push_back({name, SampleType::half});
    }
    layout.channels.push_back({"Z", SampleType::float32});
    layout.channels.push_back({"cluster", SampleType::uint32});
    layout.attributes = {{"compression", compression}, {"DateTime", 0}};
    return layout;
}

std::string by_openimageio(const std::filesystem::path& file, const std::string& compression,
                           const std::vector<unsigned char>& pixels) {
    OIIO::ImageSpec spec(kWidth, kHeight, 5, OIIO::TypeDesc::HALF);
    spec.channelnames = {"R", "G", "B", "Z", "cluster"};
    spec.channelformats = {OIIO::TypeDesc::HALF, OIIO::TypeDesc::HALF, OIIO::TypeDesc::HALF,
                           OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::UINT};
    spec.alpha_channel = -1;
    spec.attribute("compression", compression);
    spec.attribute("DateTime", 0);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto out = OIIO::ImageOutput::create("openexr");
    EXPECT_TRUE(out->open(file.string(), spec));
    EXPECT_TRUE(out->write_image(OIIO::TypeUnknown, pixels.data()));
    EXPECT_TRUE(out->close());
    return text_of_file(file);
}

TEST(ExrRows, AreThoseOfOpenImageIO) {
    const TemporaryFolder folder;
    const std::vector<unsigned char> pixels = wide_pixels();
    for (const std::string compression : kExrCompressions) {
        const ImageLayout layout = wide_layout(compression);
        const std::string wanted = by_openimageio(folder / "one.exr", compression, pixels);
        const auto whole = encode_pixels("whole", "openexr", layout, pixels, layout.pixel_bytes());
        EXPECT_TRUE(std::string(whole.begin(), whole.end()) == wanted) << compression;
        AtomicFile out(folder / "strips.exr");
        const auto writer = open_writer("strips", "openexr", layout, out.descriptor());
        const std::span<const unsigned char> rest(pixels);
        const std::size_t row = kWidth * layout.pixel_bytes();
        writer->write(64, rest.first(64 * row), layout.pixel_bytes());
        writer->write(kHeight - 64, rest.subspan(64 * row), layout.pixel_bytes());
        writer->close();
        out.commit();
        EXPECT_TRUE(text_of_file(folder / "strips.exr") == wanted) << compression;
    }
}

}  // namespace
}  // namespace kilolux
