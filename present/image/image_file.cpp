// SPDX-License-Identifier: Apache-2.0
#include "present/image/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/base/error.h"
#include "host/base/formats/half.h"
#include "host/base/suggest.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/parallel.h"
#include "host/base/version.h"
#include "host/images/images.h"
#include "present/image/image_notes.h"

namespace kilolux {
namespace {

struct Format {
    const char* extension;
    const char* plugin;  // OpenImageIO's name
    ImageMeaning meaning;
    NoteForm notes;
    bool has_alpha = false;    // may hold the covered share of pixels
    bool has_16_bits = false;  // may hold display pictures of 16 bits a channel
};

constexpr std::array kFormats = {
    Format{".exr", "openexr", ImageMeaning::linear, NoteForm::attributes, true},
    Format{".hdr", "hdr", ImageMeaning::linear, NoteForm::comments},
    Format{".png", "png", ImageMeaning::display, NoteForm::attributes, true, true},
    Format{".jpg", "jpeg", ImageMeaning::display, NoteForm::description},
    Format{".jpeg", "jpeg", ImageMeaning::display, NoteForm::description},
    Format{".tif", "tiff", ImageMeaning::display, NoteForm::description, false, true},
    Format{".tiff", "tiff", ImageMeaning::display, NoteForm::description, false, true}};

const Format& format_of(const std::filesystem::path& file) {
    const std::string extension = lower(file.extension().string());
    for (const Format& format : kFormats) {
        if (extension == format.extension) return format;
    }
    const std::vector<std::string> known = image_extensions();
    throw UsageError(file.string() + ": image type '" + extension + "' is none of " +
                     joined(known) + did_you_mean(extension, known));
}

void add_channels(ImageLayout& layout, std::initializer_list<const char*> names, SampleType type) {
    for (const char* name : names) layout.channels.push_back({name, type});
}

constexpr int kPaethFilter = 0x80;  // libpng's PNG_FILTER_PAETH: see kPngLevel

// Display codes as RGB, or RGBA where the options have alpha.
void add_display(ImageLayout& layout, const std::filesystem::path& file,
                 const ImageOptions& options) {
    const SampleType type = options.bits == 16 ? SampleType::uint16 : SampleType::uint8;
    add_channels(layout, {"R", "G", "B"}, type);
    if (std::string_view(format_of(file).plugin) == "tiff") {
        // Exif's form of an unknown date; without one OpenImageIO writes the present time. No
        // colour space is written: readers take a TIFF without a profile for sRGB, and with "sRGB"
        // OpenImageIO 2.4 writes an Exif directory that breaks the file.
        layout.attributes = {{"Compression", "zip"}, {"DateTime", "    :  :     :  :  "}};
        constexpr std::size_t kMostTiff = std::size_t{1} << 31;  // [byte] of 2^32, with a reserve
        const bool is_big = layout.pixels() * layout.pixel_bytes() > kMostTiff;
        if (is_big) layout.attributes.emplace_back("tiff:bigtiff", 1);
        return;
    }
    if (!options.alpha.empty()) add_channels(layout, {"A"}, type);
    layout.attributes = {{"oiio:ColorSpace", "sRGB"},
                         {"jpeg:subsampling", "4:4:4"},
                         {"png:compressionLevel", options.png_level},
                         {"png:filter", kPaethFilter},
                         {"CompressionQuality", options.jpeg_quality}};
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

void put_display(FileRows& out, const Frame& frame, const ImageOptions& options) {
    if (options.display.empty()) {
        out.pixels = frame.display;
        out.pixel_stride = 4;
        return;
    }
    const std::vector<float> colours = with_alpha(options);
    out.own =
        options.bits == 16 ? codes_of<std::uint16_t>(colours) : codes_of<std::uint8_t>(colours);
}

// CIE xy of red, green, blue and white of Rec. 709 (ITU-R BT.709-6, 1.3 and 1.4).
constexpr std::array kRec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

void describe_camera(ImageLayout& layout, const Camera& camera) {
    glm::dmat4 view_from_world(glm::transpose(camera.world_from_view));
    view_from_world[3] = glm::dvec4(glm::dmat3(view_from_world) * -camera.position, 1.0);
    const bool is_part = layout.full_width > 0;
    const glm::dmat4 clip_from_world =
        clip_from_view(camera, is_part ? layout.full_width : layout.width,
                       is_part ? layout.full_height : layout.height) *
        view_from_world;
    layout.attributes.emplace_back("worldToCamera", glm::mat4(view_from_world));
    layout.attributes.emplace_back("worldToNDC", glm::mat4(clip_from_world));
}

void add_channel(ImageLayout& layout, const std::string& name, SampleType type) {
    for (const ImageChannel& known : layout.channels) {
        if (known.name == name) throw Error("EXR: two layers have a channel '" + name + "'");
    }
    layout.channels.push_back({name, type});
}

template <typename Call>
void each_in_parallel(std::size_t count, const Call& call) {
    constexpr std::size_t kAtOnce = 1u << 16;  // fewer are not worth a task
    parallel_for(std::size_t{0}, count, call, kAtOnce);
}

// Copies interleaved values, `count` a pixel, into every pixel's slots from `offset` bytes on.
template <typename T>
void place(std::vector<unsigned char>& pixels, std::size_t offset, std::size_t pixel_bytes,
           const std::vector<T>& values, std::size_t count) {
    each_in_parallel(values.size() / count, [&](std::size_t i) {
        std::memcpy(&pixels[offset + i * pixel_bytes], &values[i * count], count * sizeof(T));
    });
}

std::vector<std::uint16_t> half_of(const std::vector<float>& values) {
    std::vector<std::uint16_t> out(values.size());
    each_in_parallel(values.size(), [&](std::size_t i) { out[i] = half_bits_clamped(values[i]); });
    return out;
}

bool is_uint(const Layer& layer, const ImageOptions& options) {
    return layer.is_id() && (options.uint_ids || !float_holds(layer));
}

// The metadata and the channels of an EXR file: colour, then every layer's, in order.
void add_linear(ImageLayout& layout, const Frame& frame, const ImageNotes& notes,
                const ImageOptions& options) {
    if (options.crop) {
        layout.x = options.crop->x;
        layout.y = options.crop->y;
        layout.full_width = options.full_width;
        layout.full_height = options.full_height;
    }
    const SampleType colour = options.half_colour ? SampleType::half : SampleType::float32;
    add_channels(layout, {"R", "G", "B"}, colour);
    if (!options.alpha.empty()) add_channels(layout, {"A"}, colour);
    for (const Layer& layer : frame.aovs) {
        for (const std::string& channel : layer.channels) {
            add_channel(layout, channel,
                        is_uint(layer, options) ? SampleType::uint32 : SampleType::float32);
        }
    }
    layout.attributes = {{"compression", options.exr_compression},
                         {"oiio:ColorSpace", "Linear"},
                         {"chromaticities", std::vector<float>(kRec709.begin(), kRec709.end())}};
    // Without a date OpenImageIO writes the present time as capDate. A date that is not a text is
    // left out of the file.
    layout.attributes.emplace_back("DateTime", 0);
    if (notes.camera) describe_camera(layout, *notes.camera);
}

// Pixels in that layout: interleaved, each channel in its own format.
std::vector<unsigned char> exr_pixels(const Frame& frame, const ImageLayout& layout,
                                      const ImageOptions& options) {
    const std::size_t pixel_bytes = layout.pixel_bytes();
    const std::size_t count_of_pixels =
        static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    std::vector<unsigned char> pixels(pixel_bytes * count_of_pixels);
    std::size_t channel = 0;
    std::size_t offset = 0;
    const auto add = [&](const auto& values, std::size_t count) {
        if (values.size() != count * count_of_pixels) {
            throw Error(fmt::format("EXR: channel '{}' has {} values, needs {}",
                                    layout.channels[channel].name, values.size() / count,
                                    count_of_pixels));
        }
        place(pixels, offset, pixel_bytes, values, count);
        offset += count * sizeof values[0];
        channel += count;
    };
    const bool half = layout.channels[0].type == SampleType::half;
    const auto add_colour = [&](const std::vector<float>& values, std::size_t count) {
        if (half) {
            add(half_of(values), count);
        } else {
            add(values, count);
        }
    };
    add_colour(frame.radiance, 3);
    if (!options.alpha.empty()) add_colour(options.alpha, 1);
    for (const Layer& layer : frame.aovs) {
        if (is_uint(layer, options)) {
            add(layer.ids, layer.channels.size());
        } else if (layer.is_id()) {
            add(std::vector<float>(layer.ids.begin(), layer.ids.end()), layer.channels.size());
        } else {
            add(layer.values, layer.channels.size());
        }
    }
    return pixels;
}

}  // namespace

bool float_holds(const Layer& layer) {
    constexpr std::uint32_t kMost = 1u << std::numeric_limits<float>::digits;
    return layer.most_id <= kMost &&
           std::ranges::all_of(layer.ids, [](std::uint32_t id) { return id <= kMost; });
}

std::vector<std::string> image_extensions(std::optional<ImageMeaning> meaning) {
    std::vector<std::string> out;
    for (const Format& format : kFormats) {
        if (!meaning || format.meaning == *meaning) out.emplace_back(format.extension);
    }
    return out;
}

ImageMeaning image_meaning(const std::filesystem::path& file) { return format_of(file).meaning; }

bool holds_16_bits(const std::filesystem::path& file) { return format_of(file).has_16_bits; }

bool is_png(const std::filesystem::path& file) {
    return std::string_view(format_of(file).plugin) == "png";
}

bool holds_alpha(const std::filesystem::path& file) { return format_of(file).has_alpha; }

bool holds_layers(const std::filesystem::path& file) {
    return std::string_view(format_of(file).plugin) == "openexr";
}

std::vector<unsigned char> encode_image(const std::filesystem::path& file, const Frame& frame,
                                        const ImageNotes& notes, const ImageOptions& options) {
    const FileRows rows = file_rows(file, frame.height, frame, notes, options);
    std::vector<unsigned char> out = encode_pixels(file.string(), format_of(file).plugin,
                                                   rows.layout, rows.pixels, rows.pixel_stride);
    if (format_of(file).notes == NoteForm::comments) insert_comments(out, notes);
    return out;
}

FileRows file_rows(const std::filesystem::path& file, int height, const Frame& frame,
                   const ImageNotes& notes, const ImageOptions& options) {
    const bool display = image_meaning(file) == ImageMeaning::display;
    FileRows out{{frame.width, height, {}}, frame.height};
    ImageLayout& layout = out.layout;
    if (display) {
        add_display(layout, file, options);
    } else if (holds_layers(file)) {
        add_linear(layout, frame, notes, options);
    } else {
        add_channels(layout, {"R", "G", "B"}, SampleType::float32);
    }
    layout.attributes.emplace_back("Software", "kilolux " + version());
    add_notes(layout, notes, format_of(file).notes);
    out.pixel_stride = layout.pixel_bytes();
    const bool has_more = !options.alpha.empty() || !frame.aovs.empty() || options.half_colour;
    if (display) {
        put_display(out, frame, options);
    } else if (holds_layers(file) && has_more) {
        out.own = exr_pixels(frame, layout, options);
    } else {
        out.pixels = {reinterpret_cast<const unsigned char*>(frame.radiance.data()),
                      frame.radiance.size() * sizeof(float)};
    }
    if (!out.own.empty()) out.pixels = out.own;
    return out;
}

ImageLayout layout_of_whole(const std::filesystem::path& file, const ImageLayout& part, int width,
                            int height, const std::string& without) {
    ImageLayout out{width, height, {}};
    ImageOptions options;
    if (holds_layers(file)) {
        Frame colourless;
        add_linear(out, colourless, {}, options);
        out.channels = part.channels;
    } else {
        options.bits = part.channels.front().type == SampleType::uint16 ? 16 : 8;
        if (part.channels.size() > 3) options.alpha = {1.0f};
        add_display(out, file, options);
    }
    out.attributes.emplace_back("Software", "kilolux " + version());
    for (const auto& attribute : part.attributes) {
        ImageAttribute kept = attribute.second;
        if (auto* text = std::get_if<std::string>(&kept)) {
            const std::size_t at = text->find(without);
            if (!without.empty() && at != std::string::npos) text->erase(at, without.size());
        }
        std::erase_if(out.attributes,
                      [&](const auto& known) { return known.first == attribute.first; });
        out.attributes.emplace_back(attribute.first, std::move(kept));
    }
    return out;
}

bool share_lossless_format(const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::string_view format = format_of(a).plugin;
    return format == format_of(b).plugin && can_stream(a) && format != "jpeg";
}

bool can_stream(const std::filesystem::path& file) {
    return format_of(file).notes != NoteForm::comments;  // which are inserted into the bytes
}

ImageStream::ImageStream(std::filesystem::path file) : file_(std::move(file)), out_(file_) {}

void ImageStream::write(const FileRows& rows) {
    if (!writer_) {
        writer_ =
            open_writer(file_.string(), format_of(file_).plugin, rows.layout, out_.descriptor());
    }
    writer_->write(rows.rows, rows.pixels, rows.pixel_stride);
}

void ImageStream::commit() {
    writer_->close();
    writer_.reset();
    out_.commit();
}

std::string note_in(const std::filesystem::path& file, const ImageLayout& layout,
                    const std::string& name) {
    return note_of_form(file, layout, name, format_of(file).notes);
}

void check_can_write_image(const std::filesystem::path& file) {
    check_can_write(file);
    load_image_library();
}

void write_image(const std::filesystem::path& file, const Frame& frame, const ImageNotes& notes,
                 const ImageOptions& options) {
    write_atomically(file, encode_image(file, frame, notes, options));
}

}  // namespace kilolux
