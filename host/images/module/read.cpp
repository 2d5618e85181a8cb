// SPDX-License-Identifier: Apache-2.0
#include "host/images/module/read.h"

#include <OpenImageIO/filesystem.h>
#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "host/base/error.h"
#include "host/images/module/library.h"

namespace kilolux::oiio {
namespace {

SampleType sample_type(const OIIO::TypeDesc& type) {
    for (const SampleType known :
         {SampleType::uint8, SampleType::uint16, SampleType::uint32, SampleType::half}) {
        if (type == type_of(known)) return known;
    }
    return SampleType::float32;
}

ImageLayout layout_of(const OIIO::ImageSpec& spec, const std::string& where) {
    if (spec.depth > 1) throw Error(where + "is a volume of depth " + std::to_string(spec.depth));
    ImageLayout out{spec.width, spec.height, {}};
    for (int i = 0; i < spec.nchannels; ++i) {
        out.channels.push_back({spec.channel_name(i), sample_type(spec.channelformat(i))});
    }
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        const std::string name = attribute.name().string();
        if (name.starts_with("kilolux:") || name == "ImageDescription" || name == "compression") {
            out.attributes.emplace_back(name, attribute.get_string());
        } else if (attribute.type() == OIIO::TypeDesc::TypeMatrix && name.starts_with("worldTo")) {
            glm::mat4 matrix;
            std::memcpy(&matrix, attribute.data(), sizeof matrix);
            out.attributes.emplace_back(name, matrix);
        }
    }
    const OIIO::TypeDesc eight_floats(OIIO::TypeDesc::FLOAT, 8);
    if (const auto* found = spec.find_attribute("chromaticities", eight_floats)) {
        const auto* values = static_cast<const float*>(found->data());
        out.chromaticities.assign(values, values + 8);
    }
    if (spec.full_width != spec.width || spec.full_height != spec.height) {
        out.x = spec.x - spec.full_x;
        out.y = spec.y - spec.full_y;
        out.full_width = spec.full_width;
        out.full_height = spec.full_height;
    }
    out.associated_alpha = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    return out;
}

OIIO::ImageSpec as_stored() {
    OIIO::ImageSpec wanted;
    wanted.attribute("oiio:UnassociatedAlpha", 1);
    return wanted;
}

// Throws Error, begun by `where`, for a PNG file that lacks its last chunk: libpng would print
// lines of its own. Images of scenes are checked by the loader. Chunks are length, name, data and
// checksum (PNG specification, 5.3).
void refuse_cut_png(OIIO::Filesystem::IOProxy& file, const std::string& where) {
    constexpr std::size_t kSignature = 8, kBesideData = 12;  // [byte]
    unsigned char head[8];
    if (file.pread(head, 8, 0) != 8 || std::memcmp(head, "\x89PNG\r\n\x1a\n", 8) != 0) return;
    for (std::size_t at = kSignature; at + kBesideData <= file.size();) {
        file.pread(head, sizeof head, static_cast<std::int64_t>(at));
        if (std::memcmp(head + 4, "IEND", 4) == 0) return;
        std::size_t length = 0;
        for (int i = 0; i < 4; ++i) length = length << 8 | head[i];
        at += kBesideData + length;
    }
    throw Error(where + "the file is cut off");
}

// The WebP file with its alpha flag cleared; empty for a file without alpha. With the flag set,
// OpenImageIO 2.4 multiplies colours by alpha in 8 bits; without it, it reads them as stored. RFC
// 9649: the flag is in the chunk VP8X, or in the header of a lossless file's one chunk.
std::vector<unsigned char> without_alpha(std::span<const unsigned char> webp) {
    constexpr std::size_t kHeaders = 25;
    constexpr unsigned char kAlpha = 0x10;
    if (webp.size() < kHeaders) return {};
    const std::string_view chunk(reinterpret_cast<const char*>(webp.data()) + 12, 4);
    const std::size_t flags = chunk == "VP8X" ? 20 : chunk == "VP8L" ? 24 : 0;
    if (flags == 0 || (webp[flags] & kAlpha) == 0) return {};
    std::vector<unsigned char> out;
    out.insert(out.end(), webp.begin(), webp.end());
    out[flags] = static_cast<unsigned char>(out[flags] & ~kAlpha);
    return out;
}

class Reader : public ImageReader {
 public:
    Reader(std::unique_ptr<OIIO::Filesystem::IOMemReader> memory,
           std::unique_ptr<OIIO::ImageInput> input, std::string where)
        : memory_(std::move(memory)),
          input_(std::move(input)),
          where_(std::move(where)),
          layout_(layout_of(input_->spec(), where_)) {}

    // For a WebP file of these bytes: with alpha, its colors are read without it.
    void keep_colors_of(std::span<const unsigned char> webp) {
        bytes_ = without_alpha(webp);
        if (bytes_.empty()) return;
        colors_ = open_encoded("webp", bytes_);
        layout_.associated_alpha = false;
    }

    const ImageLayout& layout() const override { return layout_; }

    void read(int begin, int end, SampleType type, void* out, std::size_t stride) override {
        const auto step = static_cast<OIIO::stride_t>(stride);
        if (!input_->read_image(0, 0, begin, end, type_of(type), out, step)) fail();
        if (colors_ && begin < 3) colors_->read(begin, std::min(end, 3), type, out, stride);
    }

    void read_rows(int first, int rows, void* out, std::size_t row_stride) override {
        const OIIO::ImageSpec& spec = input_->spec();
        const OIIO::TypeDesc type =
            spec.channelformats.empty() ? spec.format : OIIO::TypeDesc(OIIO::TypeUnknown);
        if (!input_->read_scanlines(0, 0, spec.y + first, spec.y + first + rows, 0, 0,
                                    spec.nchannels, type, out, OIIO::AutoStride,
                                    static_cast<OIIO::stride_t>(row_stride))) {
            fail();
        }
    }

    // libjpeg fills what is cut off, with an error that only has_error() shows.
    void check_end() override {
        const OIIO::ImageSpec& spec = input_->spec();
        std::vector<unsigned char> row(spec.scanline_bytes(true));
        const int end = spec.y + spec.height;
        const bool is_read = input_->read_native_scanlines(0, 0, end - 1, end, 0, row.data());
        if (!is_read || input_->has_error()) fail();
    }

 private:
    [[noreturn]] void fail() const { throw Error(where_ + one_line(input_->geterror())); }

    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives input_, which reads it
    std::unique_ptr<OIIO::ImageInput> input_;
    std::string where_;  // begins its errors
    ImageLayout layout_;
    std::vector<unsigned char> bytes_;  // outlives colors_, which reads it
    std::unique_ptr<ImageReader> colors_;
};

}  // namespace

std::unique_ptr<ImageReader> open_image(const std::filesystem::path& file) {
    const std::string where = file.string() + ": cannot read the image: ";
    const OIIO::ImageSpec wanted = as_stored();
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) {
        OIIO::Filesystem::IOFile bytes(file.string(), OIIO::Filesystem::IOProxy::Read);
        if (bytes.opened()) refuse_cut_png(bytes, where);
    }
    auto input = OIIO::ImageInput::open(file.string(), &wanted);
    if (!input) throw Error(where + one_line(OIIO::geterror()));
    const bool is_webp = input->format_name() == std::string_view("webp");
    auto reader = std::make_unique<Reader>(nullptr, std::move(input), where);
    if (is_webp) {
        std::ifstream in(file, std::ios::binary);
        const std::vector<char> webp(std::istreambuf_iterator<char>(in), {});
        reader->keep_colors_of({reinterpret_cast<const unsigned char*>(webp.data()), webp.size()});
    }
    return reader;
}

std::unique_ptr<ImageReader> open_encoded(const std::string& format,
                                          std::span<const unsigned char> bytes) {
    auto input = OIIO::ImageInput::create(format);
    if (!input) {
        const std::string ignored = OIIO::geterror();
        return nullptr;
    }
    auto memory = std::make_unique<OIIO::Filesystem::IOMemReader>(
        OIIO::cspan<unsigned char>(bytes.data(), static_cast<std::ptrdiff_t>(bytes.size())));
    OIIO::ImageSpec spec;
    if (!input->set_ioproxy(memory.get()) || !input->open("image." + format, spec, as_stored())) {
        throw Error(one_line(input->geterror()));
    }
    auto reader = std::make_unique<Reader>(std::move(memory), std::move(input), "");
    if (format == "webp") reader->keep_colors_of(bytes);
    return reader;
}

}  // namespace kilolux::oiio
