// SPDX-License-Identifier: Apache-2.0
#include "present/image/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/half.h"
#include "host/base/suggest.h"
#include "host/base/version.h"

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
    for (const Format& format : kFormats) {
        if (extension == format.extension) return format;
    }
    const std::vector<std::string> known = image_extensions();
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

// Display codes as RGB, or RGBA where the options have alpha.
OIIO::ImageSpec display_spec(const std::filesystem::path& file, const Frame& frame,
                             const ImageOptions& options) {
    OIIO::ImageSpec spec(frame.width, frame.height, 3,
                         options.bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    if (std::string_view(format_of(file).plugin) == "tiff") {
        spec.attribute("Compression", "zip");
        // Exif's form of an unknown date; without one OpenImageIO writes the present time. The
        // colour space stays unsaid: readers take a TIFF without a profile for sRGB, and with
        // "sRGB" OpenImageIO 2.4 writes an Exif directory that breaks the file.
        spec.attribute("DateTime", "    :  :     :  :  ");
        return spec;
    }
    if (!options.alpha.empty()) {
        spec.nchannels = 4;
        spec.default_channel_names();
        spec.attribute("oiio:UnassociatedAlpha", 1);
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

// RGB, or RGBA.
std::vector<float> with_alpha(const ImageOptions& options) {
    if (options.alpha.empty()) return options.display;
    std::vector<float> out;
    for (std::size_t i = 0; i < options.alpha.size(); ++i) {
        const float* rgb = &options.display[3 * i];
        out.insert(out.end(), {rgb[0], rgb[1], rgb[2], options.alpha[i]});
    }
    return out;
}

std::vector<unsigned char> encode_display(const std::filesystem::path& file,
                                          const OIIO::ImageSpec& spec, const Frame& frame,
                                          const ImageOptions& options) {
    if (options.display.empty()) return encode(file, spec, frame.display, 4);
    const std::vector<float> colours = with_alpha(options);
    const std::size_t bytes = spec.pixel_bytes();
    if (options.bits == 16) return encode(file, spec, codes_of<std::uint16_t>(colours), bytes);
    return encode(file, spec, codes_of<std::uint8_t>(colours), bytes);
}

// CIE xy of red, green, blue and white of Rec. 709 (ITU-R BT.709-6, 1.3 and 1.4).
constexpr float kRec709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

// Column-major with column vectors is, byte for byte, the row-major with row vectors of OpenEXR.
void set_matrix(OIIO::ImageSpec& spec, const char* name, const glm::dmat4& matrix) {
    const glm::mat4 narrow(matrix);
    spec.attribute(name, OIIO::TypeDesc::TypeMatrix, &narrow[0][0]);
}

void describe_camera(OIIO::ImageSpec& spec, const Camera& camera, const Frame& frame) {
    glm::dmat4 view_from_world(glm::transpose(camera.world_from_view));
    view_from_world[3] = glm::dvec4(glm::dmat3(view_from_world) * -camera.position, 1.0);
    set_matrix(spec, "worldToCamera", view_from_world);
    set_matrix(spec, "worldToNDC",
               clip_from_view(camera, frame.width, frame.height) * view_from_world);
}

void add_channel(OIIO::ImageSpec& spec, const std::string& name, const OIIO::TypeDesc& format) {
    for (const std::string& known : spec.channelnames) {
        if (known == name) throw Error("EXR: two layers have a channel '" + name + "'");
    }
    spec.channelnames.push_back(name);
    spec.channelformats.push_back(format);
    ++spec.nchannels;
}

// Copies interleaved values, `count` a pixel, into every pixel's slots from `offset` bytes on.
template <typename T>
void place(std::vector<unsigned char>& pixels, std::size_t offset, std::size_t pixel_bytes,
           const std::vector<T>& values, std::size_t count) {
    unsigned char* out = pixels.data() + offset;
    for (std::size_t i = 0; i < values.size(); i += count, out += pixel_bytes) {
        std::memcpy(out, &values[i], count * sizeof(T));
    }
}

std::vector<std::uint16_t> half_of(const std::vector<float>& values) {
    std::vector<std::uint16_t> out(values.size());
    std::transform(values.begin(), values.end(), out.begin(), half_bits_clamped);
    return out;
}

// How an EXR file describes itself and its channels: colour, then every layer's, in order.
OIIO::ImageSpec exr_spec(const Frame& frame, const ImageNotes& notes, const ImageOptions& options) {
    OIIO::ImageSpec spec(frame.width, frame.height, 0, OIIO::TypeDesc::FLOAT);
    const OIIO::TypeDesc colour =
        options.half_colour ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
    spec.channelnames.clear();
    for (const char* name : {"R", "G", "B"}) add_channel(spec, name, colour);
    if (!options.alpha.empty()) {
        spec.alpha_channel = spec.nchannels;
        add_channel(spec, "A", colour);
    }
    for (const Layer& layer : frame.aovs) {
        for (const std::string& channel : layer.channels) {
            add_channel(spec, channel,
                        layer.is_id() ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
        }
    }
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kRec709);
    // Without a date OpenImageIO writes the present time as capDate. A date that is not a text is
    // left out of the file; "debug" 0 silences the remark about it.
    spec.attribute("DateTime", 0);
    OIIO::attribute("debug", 0);
    if (notes.camera) describe_camera(spec, *notes.camera, frame);
    return spec;
}

// Pixels as that spec lays them out: interleaved, each channel in its own format.
std::vector<unsigned char> exr_pixels(const Frame& frame, const OIIO::ImageSpec& spec,
                                      const std::vector<float>& alpha) {
    const std::size_t pixel_bytes = spec.pixel_bytes(true);
    std::vector<unsigned char> pixels(pixel_bytes * spec.image_pixels());
    std::size_t channel = 0;
    std::size_t offset = 0;
    const auto add = [&](const auto& values, std::size_t count) {
        if (values.size() != count * spec.image_pixels()) {
            throw Error(fmt::format("EXR: channel '{}' has {} values, needs {}",
                                    spec.channelnames[channel], values.size() / count,
                                    spec.image_pixels()));
        }
        place(pixels, offset, pixel_bytes, values, count);
        offset += count * sizeof values[0];
        channel += count;
    };
    const bool half = spec.channelformats[0] == OIIO::TypeDesc::HALF;
    const auto add_colour = [&](const std::vector<float>& values, std::size_t count) {
        if (half) {
            add(half_of(values), count);
        } else {
            add(values, count);
        }
    };
    add_colour(frame.radiance, 3);
    if (!alpha.empty()) add_colour(alpha, 1);
    for (const Layer& layer : frame.aovs) {
        if (layer.is_id()) {
            add(layer.ids, layer.channels.size());
        } else {
            add(layer.values, layer.channels.size());
        }
    }
    return pixels;
}

}  // namespace

std::vector<std::string> image_extensions() {
    std::vector<std::string> out;
    for (const Format& format : kFormats) out.emplace_back(format.extension);
    return out;
}

ImageMeaning image_meaning(const std::filesystem::path& file) { return format_of(file).meaning; }

bool holds_16_bits(const std::filesystem::path& file) {
    const std::string_view plugin = format_of(file).plugin;
    return plugin == "png" || plugin == "tiff";
}

bool holds_alpha(const std::filesystem::path& file) {
    return std::string_view(format_of(file).plugin) == "png" || holds_layers(file);
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
        return encode(file, spec, exr_pixels(frame, spec, options.alpha), spec.pixel_bytes(true));
    }
    const auto* bytes = reinterpret_cast<const unsigned char*>(frame.radiance.data());
    return encode(file, spec, {bytes, frame.radiance.size() * sizeof(float)}, 3 * sizeof(float));
}

void write_image(const std::filesystem::path& file, const Frame& frame, const ImageNotes& notes,
                 const ImageOptions& options) {
    write_atomically(file, encode_image(file, frame, notes, options));
}

}  // namespace kilolux
