// SPDX-License-Identifier: Apache-2.0
#include "present/image/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/base/version.h"
#include "present/image/encode.h"

namespace kilolux {
namespace {

struct Format {
    const char* extension;
    const char* plugin;  // OpenImageIO's name
    ImageMeaning meaning;
};

constexpr std::array kFormats = {
    Format{".exr", "openexr", ImageMeaning::linear}, Format{".hdr", "hdr", ImageMeaning::linear},
    Format{".png", "png", ImageMeaning::display},    Format{".jpg", "jpeg", ImageMeaning::display},
    Format{".jpeg", "jpeg", ImageMeaning::display},  Format{".tif", "tiff", ImageMeaning::display},
    Format{".tiff", "tiff", ImageMeaning::display}};

const Format& format_of(const std::filesystem::path& file) {
    const std::string extension = lower(file.extension().string());
    std::vector<std::string> known;
    for (const Format& format : kFormats) {
        if (extension == format.extension) return format;
        known.emplace_back(format.extension);
    }
    throw UsageError(file.string() + ": image type '" + extension + "' is none of " +
                     joined(known) + did_you_mean(extension, known));
}

// Rows of `pixel_stride` bytes a pixel, in the formats of `spec`, through one writer into memory.
std::vector<unsigned char> encode(const std::filesystem::path& file, const OIIO::ImageSpec& spec,
                                  std::span<const unsigned char> pixels, std::size_t pixel_stride) {
    const auto fail = [&file](const std::string& reason) {
        throw Error(file.string() + ": cannot encode: " + reason);
    };
    const auto out = OIIO::ImageOutput::create(format_of(file).plugin);
    if (!out) fail(OIIO::geterror());
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!out->set_ioproxy(&memory)) fail("the writer cannot write into memory");
    // Mixed channels go in as they are: OpenImageIO would scale integers to 0..1.
    const OIIO::TypeDesc format = spec.channelformats.empty() ? spec.format : OIIO::TypeUnknown;
    if (!out->open("memory" + file.extension().string(), spec) ||
        !out->write_image(format, pixels.data(), static_cast<OIIO::stride_t>(pixel_stride)) ||
        !out->close()) {
        fail(out->geterror());
    }
    return bytes;
}

// Display codes as RGB: JPEG has no alpha, and ours is opaque.
OIIO::ImageSpec display_spec(const std::filesystem::path& file, const Frame& frame,
                             const ImageOptions& options) {
    OIIO::ImageSpec spec(frame.width, frame.height, 3,
                         options.bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    if (std::string_view(format_of(file).plugin) == "tiff") {
        spec.attribute("Compression", "zip");
        // Exif's way to say unknown; OpenImageIO would write the hour. Saying sRGB, which a TIFF
        // without a profile is taken for, makes OpenImageIO 2.4 write an Exif directory that breaks
        // the file.
        spec.attribute("DateTime", "    :  :     :  :  ");
        return spec;
    }
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("CompressionQuality", options.jpeg_quality);
    return spec;
}

// Codes of 0..1, correctly rounded.
template <typename Code>
std::vector<unsigned char> codes_of(const std::vector<float>& colours) {
    constexpr double kLargest = std::numeric_limits<Code>::max();
    std::vector<unsigned char> bytes(colours.size() * sizeof(Code));
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const auto code =
            static_cast<Code>(std::lround(static_cast<double>(colours[i]) * kLargest));
        std::memcpy(&bytes[i * sizeof(Code)], &code, sizeof(Code));
    }
    return bytes;
}

std::vector<unsigned char> encode_display(const std::filesystem::path& file,
                                          const OIIO::ImageSpec& spec, const Frame& frame,
                                          const ImageOptions& options) {
    if (options.display.empty()) return encode(file, spec, frame.display, 4);
    if (options.bits == 16) return encode(file, spec, codes_of<std::uint16_t>(options.display), 6);
    return encode(file, spec, codes_of<std::uint8_t>(options.display), 3);
}

}  // namespace

ImageMeaning image_meaning(const std::filesystem::path& file) { return format_of(file).meaning; }

bool holds_16_bits(const std::filesystem::path& file) {
    const std::string_view plugin = format_of(file).plugin;
    return plugin == "png" || plugin == "tiff";
}

bool holds_layers(const std::filesystem::path& file) {
    return std::string_view(format_of(file).plugin) == "openexr";
}

std::vector<unsigned char> encode_image(const std::filesystem::path& file, const Frame& frame,
                                        const ImageNotes& notes, const ImageOptions& options) {
    const bool display = image_meaning(file) == ImageMeaning::display;
    OIIO::ImageSpec spec =
        display              ? display_spec(file, frame, options)
        : holds_layers(file) ? exr_spec(frame, notes, options)
                             : OIIO::ImageSpec(frame.width, frame.height, 3, OIIO::TypeDesc::FLOAT);
    spec.attribute("Software", "kilolux " + version());
    for (const auto& [name, text] : notes.strings) spec.attribute("kilolux:" + name, text);
    if (display) return encode_display(file, spec, frame, options);
    if (holds_layers(file)) {
        return encode(file, spec, exr_pixels(frame, spec), spec.pixel_bytes(true));
    }
    const auto* bytes = reinterpret_cast<const unsigned char*>(frame.radiance.data());
    return encode(file, spec, {bytes, frame.radiance.size() * sizeof(float)}, 3 * sizeof(float));
}

void write_image(const std::filesystem::path& file, const Frame& frame, const ImageNotes& notes,
                 const ImageOptions& options) {
    write_atomically(file, encode_image(file, frame, notes, options));
}

}  // namespace kilolux
