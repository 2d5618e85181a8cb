// SPDX-License-Identifier: Apache-2.0
// OpenEXR files: channels, compressions and what their headers say.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cstring>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/images/file_frames.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

ImageOptions half_colour() {
    ImageOptions options;
    options.half_colour = true;
    return options;
}

std::vector<float> channel_of(const FloatImage& image, const std::string& name) {
    std::vector<float> out;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        if (image.channels[c] != name) continue;
        for (std::size_t i = c; i < image.values.size(); i += image.channels.size()) {
            out.push_back(image.values[i]);
        }
    }
    return out;
}

std::vector<float> channel_of(const Layer& layer, std::size_t channel) {
    std::vector<float> out;
    for (std::size_t i = channel; i < layer.values.size(); i += layer.channels.size()) {
        out.push_back(layer.values[i]);
    }
    return out;
}

TEST(ExrFile, ExrKeepsEveryBitOfColourAndLayers) {
    const TemporaryFolder folder;
    const Frame frame = make_layered_frame();
    write_image(folder / "a.exr", frame);
    const FloatImage image = read_image(folder / "a.exr");
    ASSERT_EQ(image.width, kFileWidth);
    ASSERT_EQ(image.height, kFileHeight);
    const std::vector<float> colour = colour_of(image);
    ASSERT_EQ(colour.size(), frame.radiance.size());
    EXPECT_EQ(std::memcmp(colour.data(), frame.radiance.data(), 4 * colour.size()), 0);
    std::size_t channels = 3;
    for (const Layer& layer : frame.aovs) {
        if (layer.is_id()) continue;
        for (std::size_t c = 0; c < layer.channels.size(); ++c, ++channels) {
            EXPECT_EQ(channel_of(image, layer.channels[c]), channel_of(layer, c))
                << layer.channels[c];
        }
    }
    EXPECT_EQ(image.channels.size(), channels);
    // Ids that no float holds are read back, too.
    ASSERT_EQ(image.ids.size(), 2u);
    for (const Layer& layer : image.ids) {
        EXPECT_EQ(layer.channels, std::vector{layer.name});
        const auto wanted = std::find_if(frame.aovs.begin(), frame.aovs.end(),
                                         [&](const Layer& l) { return l.name == layer.name; });
        ASSERT_NE(wanted, frame.aovs.end()) << layer.name;
        EXPECT_EQ(layer.ids, wanted->ids) << layer.name;
    }
}

TEST(ExrFile, ExrCompressionsKeepEveryDigit) {
    const TemporaryFolder folder;
    const Frame frame = make_layered_frame();
    for (const char* compression : kExrCompressions) {
        ImageOptions options;
        options.exr_compression = compression;
        const auto file = folder / (std::string(compression) + ".exr");
        write_image(file, frame, {}, options);
        const auto in = OIIO::ImageInput::open(file.string());
        ASSERT_TRUE(in) << compression;
        EXPECT_EQ(in->spec().get_string_attribute("compression"), compression);
        EXPECT_EQ(colour_of(read_image(file)), frame.radiance) << compression;
    }
}

TEST(ExrFile, ExrFormatsOfChannels) {
    const TemporaryFolder folder;
    write_image(folder / "a.exr", make_layered_frame(), {}, half_colour());
    const auto in = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(in);
    const OIIO::ImageSpec& spec = in->spec();
    for (int c = 0; c < spec.nchannels; ++c) {
        const std::string name = spec.channel_name(c);
        const bool is_colour = name == "R" || name == "G" || name == "B";
        const bool is_id = name == "light-count" || name == "cluster";
        const OIIO::TypeDesc wanted = is_colour ? OIIO::TypeDesc::HALF
                                      : is_id   ? OIIO::TypeDesc::UINT32
                                                : OIIO::TypeDesc::FLOAT;
        EXPECT_EQ(spec.channelformat(c), wanted) << name;
    }
    EXPECT_EQ(spec.get_string_attribute("compression"), kExrCompression);
}

TEST(ExrFile, HalfColourIsRoundedAndFinite) {
    const TemporaryFolder folder;
    Frame frame = make_frame();
    frame.radiance[0] = 1000.3f;
    write_image(folder / "a.exr", frame, {}, half_colour());
    const std::vector<float> colour = colour_of(read_image(folder / "a.exr"));
    EXPECT_EQ(colour[0], 1000.5f);
    EXPECT_EQ(colour[1], -2.5f);
    EXPECT_EQ(colour[2], 65504.0f);
}

TEST(ExrFile, ExrSaysWhatItShows) {
    const TemporaryFolder folder;
    ImageNotes notes;
    notes.strings = {{"scene", "atrium"}, {"seed", "7"}, {"device", "a CPU, \"quoted\""}};
    notes.camera = look_at({1, 2, 3}, {1, 2, -7}, {0, 1, 0}, glm::radians(90.0));
    write_image(folder / "a.exr", make_frame(), notes);
    const auto in = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(in);
    const OIIO::ImageSpec& spec = in->spec();
    EXPECT_EQ(spec.get_string_attribute("kilolux:scene"), "atrium");
    EXPECT_EQ(spec.get_string_attribute("kilolux:seed"), "7");
    EXPECT_EQ(spec.get_string_attribute("kilolux:device"), "a CPU, \"quoted\"");
    EXPECT_TRUE(contains(spec.get_string_attribute("Software"), "kilolux "));
    EXPECT_EQ(spec.find_attribute("DateTime"), nullptr);
    float primaries[8] = {};
    ASSERT_TRUE(
        spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries));
    EXPECT_FLOAT_EQ(primaries[0], 0.64f);
    EXPECT_FLOAT_EQ(primaries[7], 0.3290f);
}

// A row vector times the matrix, which is OpenEXR's convention.
glm::dvec4 row_times(const glm::dvec4& p, const float* m) {
    glm::dvec4 out(0.0);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) out[column] += p[row] * m[4 * row + column];
    }
    return out;
}

TEST(ExrFile, ExrMatricesTakeWorldPointsToCameraAndScreen) {
    const TemporaryFolder folder;
    ImageNotes notes;
    notes.camera = look_at({1, 2, 3}, {1, 2, -7}, {0, 1, 0}, glm::radians(90.0));
    write_image(folder / "a.exr", make_frame(), notes);
    const auto in = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(in);
    float to_camera[16] = {};
    float to_ndc[16] = {};
    ASSERT_TRUE(in->spec().getattribute("worldToCamera", OIIO::TypeMatrix, to_camera));
    ASSERT_TRUE(in->spec().getattribute("worldToNDC", OIIO::TypeMatrix, to_ndc));
    // Five metres ahead, at the picture's right and upper edges.
    const double aspect = static_cast<double>(kFileWidth) / kFileHeight;
    const glm::dvec4 p(1 + 5 * aspect, 2 + 5, 3 - 5, 1);
    const glm::dvec4 in_view = row_times(p, to_camera);
    EXPECT_NEAR(in_view.x, 5 * aspect, 1e-5);
    EXPECT_NEAR(in_view.y, 5.0, 1e-5);
    EXPECT_NEAR(in_view.z, -5.0, 1e-5);
    const glm::dvec4 clip = row_times(p, to_ndc);
    EXPECT_NEAR(clip.x / clip.w, 1.0, 1e-5);
    EXPECT_NEAR(clip.y / clip.w, 1.0, 1e-5);
}

}  // namespace
}  // namespace kilolux
