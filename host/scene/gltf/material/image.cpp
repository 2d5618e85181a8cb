// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/material/image.h"

#include <fmt/core.h>
#include <zlib.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <string_view>

#include "host/base/error.h"
#include "host/base/system/parallel.h"
#include "host/images/images.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

constexpr int kMaxSide = 16384;  // [pixel]; what OpenGL implementations take
// An image is refused if its header claims more than kFreeBytes and more than kMaxExpansion times
// the encoded bytes, which no encoder reaches.
constexpr std::uint64_t kFreeBytes = std::uint64_t{64} << 20;
constexpr std::uint64_t kMaxExpansion = 8192;

struct Magic {
    std::string_view bytes;
    std::size_t offset;
    const char* format;  // OpenImageIO's name
};

using namespace std::string_view_literals;
constexpr std::array kMagics = {
    Magic{"\x89PNG"sv, 0, "png"},     Magic{"\xff\xd8\xff"sv, 0, "jpeg"},
    Magic{"WEBP"sv, 8, "webp"},       Magic{"GIF8"sv, 0, "gif"},
    Magic{"BM"sv, 0, "bmp"},          Magic{"DDS "sv, 0, "dds"},
    Magic{"II*\0"sv, 0, "tiff"},      Magic{"MM\0*"sv, 0, "tiff"},
    Magic{"v/1\x01"sv, 0, "openexr"}, Magic{"#?RADIANCE"sv, 0, "hdr"},
    Magic{"8BPS"sv, 0, "psd"},        Magic{"jP  "sv, 4, "jpeg2000"},
    Magic{"P6"sv, 0, "pnm"},          Magic{"P5"sv, 0, "pnm"},
};

std::string name_of(const GltfDocument& document, int image) {
    const auto index = static_cast<std::size_t>(image);
    const std::string& uri = document.model.images[index].uri;
    return element_name("images", index) + (uri.empty() ? "" : " '" + shown_uri(uri) + "'");
}

FileBytes read_encoded(const GltfDocument& document, int image) {
    const auto index = static_cast<std::size_t>(image);
    const tinygltf::Image& source = document.model.images[index];
    const std::string where = element_name("images", index);
    if (source.uri.empty() && source.bufferView < 0) {
        document.fail(where, "has neither a uri nor a bufferView");
    }
    return read_source(document, source.uri, source.bufferView, where);
}

// OpenImageIO's name of the format. The bytes tell it, since file names and MIME types may be
// wrong; a TGA file has its signature at the end.
std::string format_of(std::span<const unsigned char> bytes, const std::string& uri) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const Magic& magic : kMagics) {
        if (text.size() > magic.offset && text.substr(magic.offset).starts_with(magic.bytes)) {
            return magic.format;
        }
    }
    constexpr std::size_t kTargaFooterBytes = 26;
    const std::size_t footer = text.size() - std::min(text.size(), kTargaFooterBytes);
    if (text.find("TRUEVISION-XFILE", footer) != std::string_view::npos) return "targa";
    const std::size_t dot = is_data_uri(uri) ? std::string::npos : uri.rfind('.');
    return dot == std::string::npos ? "" : uri.substr(dot + 1);
}

std::string reason(std::string text) {
    text.resize(std::min(text.size(), text.find('\n')));
    return text.empty() ? "is broken" : text;
}

// Throws if the image is too large for a texture, for its encoded bytes or for the memory left.
void check_size(const GltfDocument& document, const std::string& name, const ImageLayout& image,
                std::size_t encoded_bytes, SampleType type) {
    if (image.width < 1 || image.height < 1 || image.width > kMaxSide || image.height > kMaxSide) {
        document.fail(name, "is {}x{} pixels, must be from 1x1 to {}x{}", image.width, image.height,
                      kMaxSide, kMaxSide);
    }
    if (image.channels.empty() || image.channels.size() > 16) {
        document.fail(name, "has {} channels, which no texture has", image.channels.size());
    }
    const std::uint64_t bytes = 4 * size_of(type) * std::uint64_t{image.pixels()};
    if (bytes > std::max(kFreeBytes, kMaxExpansion * encoded_bytes)) {
        document.fail(name, "claims {}x{} pixels in {} bytes, which no image holds", image.width,
                      image.height, encoded_bytes);
    }
    document.budget->charge_memory(bytes, document.base.file + ": " + name);
}

// Completes RGBA pixels of which only the first `channels` are filled; one or two are grey, with
// alpha.
template <typename T>
void fill_rgba(std::vector<T>& rgba, std::size_t channels) {
    for (std::size_t i = 0; channels < 4 && i < rgba.size(); i += 4) {
        T* pixel = &rgba[i];
        pixel[3] = channels == 2 ? pixel[1] : std::numeric_limits<T>::max();
        if (channels < 3) pixel[1] = pixel[2] = pixel[0];
    }
}

// Divides colours by alpha: glTF's are not multiplied by it, but some readers of OpenImageIO
// multiply them (WebP in 2.4). The division restores them up to rounding.
template <typename T>
void undo_associated_alpha(std::vector<T>& rgba) {
    constexpr unsigned kOne = std::numeric_limits<T>::max();
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const unsigned alpha = rgba[i + 3];
        if (alpha == 0 || alpha == kOne) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned value = (rgba[i + c] * kOne + alpha / 2) / alpha;
            rgba[i + c] = static_cast<T>(std::min(value, kOne));
        }
    }
}

template <typename T>
void read_rgba(ImageReader& reader, SampleType type, std::vector<T>& rgba) {
    const ImageLayout& layout = reader.layout();
    const std::size_t channels = std::min<std::size_t>(layout.channels.size(), 4);
    rgba.resize(4 * layout.pixels());
    reader.read(0, static_cast<int>(channels), type, rgba.data(), 4 * sizeof(T));
    fill_rgba(rgba, channels);
    if (layout.associated_alpha) undo_associated_alpha(rgba);
}

// By image of the materials, whether all that read it are maps in tangent space.
std::vector<char> images_in_tangent_space(const GltfMaterials& materials) {
    std::vector<char> out(materials.images.size(), 1);
    for (const Material& material : materials.materials) {
        for (const MaterialMap& map : kMaterialMaps) {
            const TextureUse& use = material.*map.member;
            if (!use.present() || (TANGENT_USES & (1u << map.use)) != 0) continue;
            const int image = materials.textures[static_cast<std::size_t>(use.texture)].image;
            const auto place = static_cast<std::size_t>(image);  // behind them: made of others
            if (place < out.size()) out[place] = 0;
        }
    }
    return out;
}

// `widest`: the type to keep where the file has more than 8 bits.
Image decode(const GltfDocument& document, int index, SampleType widest) {
    const std::string name = name_of(document, index);
    const tinygltf::Image& source = document.model.images[static_cast<std::size_t>(index)];
    const FileBytes encoded = read_encoded(document, index);
    const std::string format = format_of(encoded.bytes, source.uri);
    if (format == "png") check_png(encoded.bytes, document.base.file + ": " + name);
    const auto of_codec = [&](auto call) {
        try {
            return call();
        } catch (const Error& e) {
            document.fail(name, "{}", reason(e.what()));
        }
    };
    const auto reader =
        of_codec([&] { return format.empty() ? nullptr : open_encoded(format, encoded.bytes); });
    if (!reader) document.fail(name, "is of no image format that can be read");
    const ImageLayout& layout = reader->layout();
    const bool is_narrow = std::ranges::all_of(
        layout.channels, [](const ImageChannel& c) { return c.type == SampleType::uint8; });
    const SampleType type = is_narrow ? SampleType::uint8 : widest;
    check_size(document, name, layout, encoded.bytes.size(), type);
    Image out{source.name, layout.width, layout.height, {}};
    of_codec([&] {
        type == SampleType::uint8 ? read_rgba(*reader, type, out.rgba)
                                  : read_rgba(*reader, type, out.rgba16);
    });
    return out;
}

using PngBytes = std::span<const unsigned char>;

constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
constexpr std::size_t kFrameBytes = 12;  // of a chunk: length, type, checksum
// The chunks that pixels depend on: the critical ones and transparency.
constexpr std::array<std::string_view, 5> kNeeded = {"IHDR", "PLTE", "IDAT", "IEND", "tRNS"};

std::uint32_t big_endian(PngBytes bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
           std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]};
}

struct Chunk {
    PngBytes bytes;  // all of it
    std::size_t offset = 0;
    std::string_view type;
};

Chunk png_chunk_at(PngBytes png, std::size_t offset, const std::string& where) {
    const PngBytes rest = png.subspan(offset);
    if (rest.size() < kFrameBytes || big_endian(rest) > rest.size() - kFrameBytes) {
        throw Error(
            fmt::format("{}: is cut off in the chunk at byte {} of {}", where, offset, png.size()));
    }
    return {rest.first(kFrameBytes + big_endian(rest)), offset,
            std::string_view(reinterpret_cast<const char*>(rest.data()) + 4, 4)};
}

[[noreturn]] void fail(const Chunk& chunk, const std::string& where, const char* what) {
    std::string type(chunk.type);
    for (char& c : type) {
        if (!std::isalpha(static_cast<unsigned char>(c))) c = '?';
    }
    throw Error(fmt::format("{}: chunk {} at byte {} {}", where, type, chunk.offset, what));
}

// Throws when a decoder must read the chunk and cannot. Broken chunks that it may skip pass.
void check_chunk(const Chunk& chunk, const std::string& where) {
    if (std::find(kNeeded.begin(), kNeeded.end(), chunk.type) == kNeeded.end()) {
        if (std::islower(static_cast<unsigned char>(chunk.type[0]))) return;
        fail(chunk, where, "is of no type that PNG decoders know");
    }
    const PngBytes bytes = chunk.bytes;
    const PngBytes checked = bytes.subspan(4, bytes.size() - 8);  // type and data
    if (crc32_z(0, checked.data(), checked.size()) != big_endian(bytes.last(4))) {
        fail(chunk, where, "is damaged: its checksum is wrong");
    }
    if ((chunk.offset == kSignature.size()) != (chunk.type == "IHDR")) {
        fail(chunk, where, "is out of place: IHDR is the first chunk and no other");
    }
}

}  // namespace

std::vector<Image> decode_images(const GltfDocument& document, const GltfMaterials& materials,
                                 const LoadProgress& progress) {
    const std::vector<int>& images = materials.images;
    const std::vector<char> in_tangent_space = images_in_tangent_space(materials);
    const auto decoded = [&](std::size_t i) {
        return decode(document, images[i],
                      in_tangent_space[i] != 0 ? SampleType::uint16 : SampleType::uint8);
    };
    std::vector<Image> out(images.size());
    std::mutex telling;
    std::size_t done = 0;
    const auto tell = [&](std::size_t more) {
        if (!progress) return;
        const std::lock_guard lock(telling);
        progress(done += more, images.size());
    };
    if (!images.empty()) tell(0);
    std::vector<std::size_t> left(images.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    while (!left.empty()) {
        // An image may fail only because others borrow memory while they are decoded: it is tried
        // again in the next round. If all failed, one is tried alone.
        std::vector<char> waits(left.size(), 0);
        parallel_each(left.size(), [&](std::size_t i) {
            try {
                out[left[i]] = decoded(left[i]);
                tell(1);
            } catch (const MemoryError&) {
                waits[i] = 1;
            }
        });
        std::vector<std::size_t> next;
        for (std::size_t i = 0; i < left.size(); ++i) {
            if (waits[i] != 0) next.push_back(left[i]);
        }
        if (next.size() == left.size()) {
            out[next[0]] = decoded(next[0]);
            tell(1);
            next.erase(next.begin());
        }
        left = std::move(next);
    }
    return out;
}

void check_png(PngBytes png, const std::string& where) {
    const bool starts = png.size() >= kSignature.size() &&
                        std::equal(kSignature.begin(), kSignature.end(), png.begin());
    if (!starts) throw Error(where + ": does not start as a PNG file does");
    bool has_pixels = false;
    for (std::size_t offset = kSignature.size(); offset < png.size();) {
        const Chunk chunk = png_chunk_at(png, offset, where);
        check_chunk(chunk, where);
        if (chunk.type == "IEND") break;
        has_pixels = has_pixels || chunk.type == "IDAT";
        offset += chunk.bytes.size();
    }
    if (!has_pixels) throw Error(where + ": has no chunk IDAT, which holds a PNG's pixels");
}

}  // namespace kilolux
