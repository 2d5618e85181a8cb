// SPDX-License-Identifier: Apache-2.0
#include "present/image/image_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/base/formats/srgb.h"
#include "host/base/system/atomic_write.h"
#include "host/images/images.h"
#include "host/scene/lights/environment.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

// Not a multiple of anything, and more rows than EXR's blocks and TIFF's strips have.
constexpr int kWidth = 37;
constexpr int kHeight = 51;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

Layer make_layer(const std::string& name, std::vector<std::string> channels, bool is_id) {
    Layer layer{name, std::move(channels)};
    for (std::size_t i = 0; i < kPixels * layer.channels.size(); ++i) {
        if (is_id) {
            layer.ids.push_back(16777217u + static_cast<std::uint32_t>(i) * 2'000'003u);
        } else {
            layer.values.push_back(std::sin(static_cast<float>(i)) * 1e4f);
        }
    }
    return layer;
}

ImageOptions half_colour() {
    ImageOptions options;
    options.half_colour = true;
    return options;
}

Frame make_frame() {
    Frame frame;
    frame.width = kWidth;
    frame.height = kHeight;
    for (std::size_t i = 0; i < kPixels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            frame.radiance.push_back(std::exp(std::sin(static_cast<float>(3 * i + c)) * 8.0f));
            frame.display.push_back(static_cast<std::uint8_t>((i * 7 + c * 31) % 256));
        }
        frame.display.push_back(255);
    }
    // Values that a file of light must keep: unclamped, negative, infinite, smallest.
    frame.radiance[0] = 1e30f;
    frame.radiance[1] = -2.5f;
    frame.radiance[2] = std::numeric_limits<float>::infinity();
    frame.radiance[3] = std::numeric_limits<float>::denorm_min();
    return frame;
}

Frame make_layered_frame() {
    Frame frame = make_frame();
    frame.aovs = {make_layer("depth", {"Z"}, false),
                  make_layer("position", {"P.X", "P.Y", "P.Z"}, false),
                  make_layer("normal", {"N.X", "N.Y", "N.Z"}, false),
                  make_layer("albedo", {"albedo.R", "albedo.G", "albedo.B"}, false),
                  make_layer("roughness", {"roughness"}, false),
                  make_layer("metallic", {"metallic"}, false),
                  make_layer("emissive", {"emissive.R", "emissive.G", "emissive.B"}, false),
                  make_layer("light-count", {"light-count"}, true),
                  make_layer("cluster", {"cluster"}, true)};
    return frame;
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

TEST(ImageFile, ExrKeepsEveryBitOfColourAndLayers) {
    const TemporaryFolder folder;
    const Frame frame = make_layered_frame();
    write_image(folder / "a.exr", frame);
    const FloatImage image = read_image(folder / "a.exr");
    ASSERT_EQ(image.width, kWidth);
    ASSERT_EQ(image.height, kHeight);
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

TEST(ImageFile, ExrCompressionsKeepEveryDigit) {
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

TEST(ImageFile, ExrFormatsOfChannels) {
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
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
}

TEST(ImageFile, IdsAreFloatsWhereTheseAreExact) {
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

TEST(ImageFile, HalfColourIsRoundedAndFinite) {
    const TemporaryFolder folder;
    Frame frame = make_frame();
    frame.radiance[0] = 1000.3f;
    write_image(folder / "a.exr", frame, {}, half_colour());
    const std::vector<float> colour = colour_of(read_image(folder / "a.exr"));
    EXPECT_EQ(colour[0], 1000.5f);
    EXPECT_EQ(colour[1], -2.5f);
    EXPECT_EQ(colour[2], 65504.0f);
}

TEST(ImageFile, ExrSaysWhatItShows) {
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

TEST(ImageFile, ExrMatricesTakeWorldPointsToCameraAndScreen) {
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
    const double aspect = static_cast<double>(kWidth) / kHeight;
    const glm::dvec4 p(1 + 5 * aspect, 2 + 5, 3 - 5, 1);
    const glm::dvec4 in_view = row_times(p, to_camera);
    EXPECT_NEAR(in_view.x, 5 * aspect, 1e-5);
    EXPECT_NEAR(in_view.y, 5.0, 1e-5);
    EXPECT_NEAR(in_view.z, -5.0, 1e-5);
    const glm::dvec4 clip = row_times(p, to_ndc);
    EXPECT_NEAR(clip.x / clip.w, 1.0, 1e-5);
    EXPECT_NEAR(clip.y / clip.w, 1.0, 1e-5);
}

TEST(ImageFile, TheSameFrameGivesTheSameBytes) {
    const Frame frame = make_layered_frame();
    ImageNotes notes;
    notes.strings = {{"scene", "atrium"}};
    const std::vector<std::string> names = {"a.exr", "a.hdr", "a.png", "a.jpg", "a.tif"};
    std::vector<std::vector<unsigned char>> firsts;
    for (const std::string& name : names) {
        const auto first = encode_image(name, frame, notes, {});
        EXPECT_GT(first.size(), 100u) << name;
        firsts.push_back(first);
    }
    // A file that held the time of writing would differ after this pause.
    const timespec pause{1, 100'000'000};
    nanosleep(&pause, nullptr);
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(firsts[i], encode_image(names[i], frame, notes, {})) << names[i];
    }
}

// Rows of a frame as a frame.
Frame strip_of(const Frame& frame, int first_row, int rows) {
    Frame out;
    out.width = frame.width;
    out.height = rows;
    out.first_row = first_row;
    const auto width = static_cast<std::size_t>(frame.width);
    const auto cut = [&](const auto& values, std::size_t channels) {
        const auto at = [&](int row) {
            return values.begin() +
                   static_cast<std::ptrdiff_t>(channels * width * static_cast<std::size_t>(row));
        };
        return std::decay_t<decltype(values)>(at(first_row), at(first_row + rows));
    };
    out.radiance = cut(frame.radiance, 3);
    out.display = cut(frame.display, 4);
    for (const Layer& layer : frame.aovs) {
        Layer part{layer.name, layer.channels};
        const std::size_t channels = layer.channels.size();
        if (!layer.values.empty()) part.values = cut(layer.values, channels);
        if (layer.is_id()) part.ids = cut(layer.ids, channels);
        out.aovs.push_back(std::move(part));
    }
    return out;
}

std::string bytes_of_stream(const std::filesystem::path& file, const Frame& frame,
                            const ImageOptions& options) {
    ImageNotes notes;
    notes.strings = {{"scene", "atrium"}};
    notes.camera = Camera{};
    ImageStream stream(file);
    for (int row = 0; row < frame.height; row += 32) {
        const Frame strip = strip_of(frame, row, std::min(32, frame.height - row));
        EXPECT_FALSE(std::filesystem::exists(file));
        stream.write(file_rows(file, frame.height, strip, notes, options));
    }
    stream.commit();
    const std::vector<unsigned char> whole = encode_image(file, frame, notes, options);
    EXPECT_TRUE(text_of_file(file) == std::string(whole.begin(), whole.end())) << file;
    return text_of_file(file);
}

TEST(ImageFile, StripsMakeTheSameBytes) {
    const TemporaryFolder folder;
    const Frame plain = make_frame(), layered = make_layered_frame();
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
        EXPECT_TRUE(can_stream(name));
        bytes_of_stream(folder / name, plain, {});
    }
    EXPECT_FALSE(can_stream("a.hdr")) << "its notes are inserted into the bytes";
    for (const char* compression : kExrCompressions) {
        ImageOptions options = half_colour();
        options.exr_compression = compression;
        bytes_of_stream(folder / (std::string(compression) + ".exr"), layered, options);
    }
}

// A strip's channels are those of the picture, which has ids that floats do not hold.
TEST(ImageFile, IdsOfAStripAreStoredAsThePictureNeeds) {
    Frame strip = make_frame();
    strip.aovs = {{.name = "cluster", .channels = {"cluster"}, .ids{}, .most_id = 1 << 24}};
    strip.aovs[0].ids.assign(kPixels, 7);
    const auto type = [&] {
        return file_rows("a.exr", 1000, strip, {}, {}).layout.channels.back().type;
    };
    EXPECT_EQ(type(), SampleType::float32);
    ++strip.aovs[0].most_id;
    EXPECT_EQ(type(), SampleType::uint32);
}

// TIFF's places of 32 bits reach 4 GiB: by the size of the picture, not of the strip.
TEST(ImageFile, LargeTiffIsBigTiff) {
    const Frame strip = make_frame();
    const auto is_big = [&](int height) {
        const ImageLayout layout = file_rows("a.tif", height, strip, {}, {}).layout;
        return std::ranges::any_of(layout.attributes, [](const auto& attribute) {
            return attribute.first == "tiff:bigtiff";
        });
    };
    constexpr int kMost = (1 << 30) / kWidth / 3 * 2;  // rows of 2^31 bytes
    EXPECT_FALSE(is_big(kMost - 1));
    EXPECT_TRUE(is_big(kMost + 2));
}

// The header says so, and the reader finds the rows.
TEST(ImageFile, BigTiffIsRead) {
    const TemporaryFolder folder;
    const Frame frame = make_frame();
    FileRows rows = file_rows(folder / "a.tif", kHeight, frame, {}, {});
    rows.layout.attributes.emplace_back("tiff:bigtiff", 1);
    ImageStream stream(folder / "a.tif");
    stream.write(rows);
    stream.commit();
    EXPECT_EQ(text_of_file(folder / "a.tif").substr(0, 4), std::string("II\x2b\0", 4));
    const FloatImage image = read_image(folder / "a.tif");
    for (std::size_t i = 0; i < kPixels; ++i) {
        ASSERT_EQ(std::lround(image.values[3 * i] * 255.0f), frame.display[4 * i]) << i;
    }
}

// The system's reason, once the bytes that wait are written, and no file.
TEST(ImageFile, AStreamOntoAFullDiskSaysSo) {
    const Frame frame = make_frame();
    for (const char* name : {"full.png", "full.exr", "full.tif"}) {
        const TemporaryFolder folder;
        const std::filesystem::path file = folder / name;
        std::filesystem::create_symlink("/dev/full", file);
        const auto write = [&] {
            ImageStream stream(file);
            stream.write(file_rows(file, frame.height, frame, {}, {}));
            stream.commit();
        };
        EXPECT_EQ(message_of<Error>(write),
                  file.string() + ": cannot write: No space left on device");
    }
}

TEST(ImageFile, LosslessDisplayFormatsKeepCodes) {
    const TemporaryFolder folder;
    const Frame frame = make_frame();
    for (const char* name : {"a.png", "a.tif", "a.TIFF"}) {
        write_image(folder / name, frame);
        const FloatImage image = read_image(folder / name);
        ASSERT_EQ(image.channels.size(), 3u) << name;
        for (std::size_t i = 0; i < kPixels; ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_EQ(std::lround(image.values[3 * i + c] * 255.0f), frame.display[4 * i + c])
                    << name << " pixel " << i << " channel " << c;
            }
        }
    }
}

TEST(ImageFile, JpegIsCloseAndHdrKeepsItsEightBits) {
    const TemporaryFolder folder;
    Frame frame = make_frame();
    frame.display.assign(frame.display.size(), 200);
    frame.radiance.assign(frame.radiance.size(), 12.7f);
    write_image(folder / "a.jpg", frame);
    write_image(folder / "a.hdr", frame);
    for (const float v : read_image(folder / "a.jpg").values) EXPECT_NEAR(v * 255.0f, 200.0f, 2.0f);
    for (const float v : read_image(folder / "a.hdr").values) EXPECT_NEAR(v, 12.7f, 12.7f / 128.0f);
}

TEST(ImageFile, MeaningComesFromTheExtension) {
    EXPECT_EQ(image_meaning("x/y.EXR"), ImageMeaning::linear);
    EXPECT_EQ(image_meaning("y.hdr"), ImageMeaning::linear);
    for (const char* name : {"a.png", "a.jpg", "a.jpeg", "a.tif", "a.tiff", "a.PNG"}) {
        EXPECT_EQ(image_meaning(name), ImageMeaning::display) << name;
    }
    EXPECT_TRUE(holds_layers("a.exr"));
    EXPECT_FALSE(holds_layers("a.hdr"));
    EXPECT_EQ(message_of<UsageError>([] { image_meaning("a.pgn"); }),
              "a.pgn: image type '.pgn' is none of .exr, .hdr, .png, .jpg, .jpeg, .tif, .tiff; did "
              "you mean '.png'?");
    EXPECT_THROW(image_meaning("png"), UsageError);
}

TEST(ImageFile, OneLineForWhatCannotBeReadOrWritten) {
    const TemporaryFolder folder;
    const Frame frame = make_frame();
    const auto lost = message_of<Error>([&] { write_image(folder / "no/a.exr", frame); });
    EXPECT_TRUE(contains(lost, "no/a.exr: cannot write")) << lost;
    write_text(folder / "a.exr", "this is no image");
    const auto broken = message_of<Error>([&] { read_image(folder / "a.exr"); });
    EXPECT_TRUE(contains(broken, "a.exr: cannot read the image: ")) << broken;
    EXPECT_FALSE(contains(broken, "\n")) << broken;
    EXPECT_THROW(read_image(folder / "none.exr"), Error);
    Frame twice = make_layered_frame();
    twice.aovs.push_back(twice.aovs[0]);
    EXPECT_TRUE(contains(message_of<Error>([&] { encode_image("a.exr", twice, {}, {}); }), "'Z'"));
    Frame short_layer = make_layered_frame();
    short_layer.aovs[0].values.pop_back();
    EXPECT_THROW(encode_image("a.exr", short_layer, {}, {}), Error);
}

TEST(ImageFile, ATruncatedExrIsAnErrorAndNotAPicture) {
    const TemporaryFolder folder;
    auto bytes = encode_image("a.exr", make_layered_frame(), {}, {});
    const std::string half(reinterpret_cast<const char*>(bytes.data()), bytes.size() / 2);
    write_text(folder / "a.exr", half);
    EXPECT_THROW(read_image(folder / "a.exr"), Error);
}

// An environment's light is that of its file's sRGB codes, whatever its alpha.
TEST(ImageFile, AlphaDarkensNoEnvironment) {
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

TEST(ImageFile, WebpKeepsTheColoursThatAlphaHides) {
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

TEST(ImageFile, ColourOfGreyAndUnnamedChannels) {
    const FloatImage grey{2, 1, {"Y"}, {1.0f, 2.0f}};
    EXPECT_EQ(colour_of(grey), (std::vector<float>{1, 1, 1, 2, 2, 2}));
    const FloatImage mixed{1, 1, {"Z", "B", "G", "R"}, {9, 3, 2, 1}};
    EXPECT_EQ(colour_of(mixed), (std::vector<float>{1, 2, 3}));
    EXPECT_THROW(colour_of(FloatImage{}), Error);
}

}  // namespace
}  // namespace kilolux
