// SPDX-License-Identifier: Apache-2.0
#include "host/images/module/encode.h"

#include <OpenImageIO/filesystem.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>

#include "host/base/error.h"
#include "host/base/system/descriptor.h"
#include "host/images/module/library.h"

namespace kilolux::oiio {
namespace {

void set(OIIO::ImageSpec& spec, const std::string& name, const ImageAttribute& value) {
    if (const auto* number = std::get_if<int>(&value)) spec.attribute(name, *number);
    if (const auto* text = std::get_if<std::string>(&value)) spec.attribute(name, *text);
    if (const auto* matrix = std::get_if<glm::mat4>(&value)) {
        // The same bytes: glm stores columns of a matrix for column vectors, OpenEXR rows of a
        // matrix for row vectors.
        spec.attribute(name, OIIO::TypeDesc::TypeMatrix, &(*matrix)[0][0]);
    }
    if (const auto* values = std::get_if<std::vector<float>>(&value)) {
        const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, static_cast<int>(values->size()));
        spec.attribute(name, type, values->data());
    }
}

OIIO::ImageSpec spec_of(const ImageLayout& layout) {
    const SampleType first = layout.channels.front().type;
    OIIO::ImageSpec spec(layout.width, layout.height, static_cast<int>(layout.channels.size()),
                         type_of(first));
    bool mixed = false;
    spec.alpha_channel = -1;
    for (std::size_t i = 0; i < layout.channels.size(); ++i) {
        const ImageChannel& channel = layout.channels[i];
        spec.channelnames[i] = channel.name;
        spec.channelformats.push_back(type_of(channel.type));
        if (channel.name == "A") spec.alpha_channel = static_cast<int>(i);
        mixed |= channel.type != first;
    }
    if (!mixed) spec.channelformats.clear();
    if (layout.full_width > 0) {
        spec.x = layout.x;
        spec.y = layout.y;
        spec.full_width = layout.full_width;
        spec.full_height = layout.full_height;
    }
    spec.attribute("oiio:UnassociatedAlpha", 1);
    for (const auto& [name, value] : layout.attributes) set(spec, name, value);
    return spec;
}

// The type of the pixels that OpenImageIO gets: unknown for mixed channels, since it would scale
// their integers to 0..1.
OIIO::TypeDesc type_in(const OIIO::ImageSpec& spec) {
    return spec.channelformats.empty() ? spec.format : OIIO::TypeUnknown;
}

[[noreturn]] void fail(const std::string& name, const std::string& reason) {
    throw Error(name + ": cannot encode: " + one_line(reason));
}

// A writer of the format that is to write to `proxy`; it is not open yet.
std::unique_ptr<OIIO::ImageOutput> create_output(const std::string& name, const std::string& format,
                                                 OIIO::Filesystem::IOProxy& proxy) {
    // Without this, OpenImageIO prints which attributes a format cannot hold.
    OIIO::attribute("debug", 0);
    std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(format);
    if (!out) fail(name, OIIO::geterror());
    if (!out->set_ioproxy(&proxy)) fail(name, "the writer takes no memory or descriptor");
    return out;
}

// Writes to a descriptor until an error, which it keeps.
class DescriptorProxy : public OIIO::Filesystem::IOProxy {
 public:
    explicit DescriptorProxy(int file) : IOProxy("", Write), file_(file) {}

    const char* proxytype() const override { return "descriptor"; }
    std::size_t size() const override { return static_cast<std::size_t>(end_); }

    bool seek(std::int64_t offset) override {
        m_pos = offset;
        return true;
    }

    std::size_t write(const void* bytes, std::size_t count) override {
        if (m_pos != place_ && error_ == 0 && ::lseek(file_, m_pos, SEEK_SET) < 0) error_ = errno;
        std::size_t done = 0;
        while (done < count && error_ == 0) {
            const ssize_t n = ::write(file_, static_cast<const char*>(bytes) + done, count - done);
            if (n < 0 && errno != EINTR) error_ = errno;
            if (n > 0) done += static_cast<std::size_t>(n);
        }
        place_ = m_pos += static_cast<std::int64_t>(done);
        end_ = std::max(end_, place_);
        return done;
    }

    int error() const { return error_; }
    void begin_flush() const { kilolux::begin_flush(file_); }

 private:
    int file_;
    std::int64_t place_ = 0;  // of the descriptor
    std::int64_t end_ = 0;
    int error_ = 0;  // of errno
};

// Compresses the rows of an OpenEXR file in all threads. OpenImageIO hands OpenEXR 16 MB at a time,
// which in a wide picture are blocks for a few threads only. So each piece of the picture becomes a
// file in memory, and its blocks are copied to the whole file.
class ExrRows {
 public:
    /// `proxy`: the file, after its header and the empty table of its blocks.
    ExrRows(std::string name, const OIIO::ImageSpec& spec, OIIO::Filesystem::IOProxy& proxy)
        : name_(std::move(name)), spec_(spec), proxy_(proxy), table_end_(proxy.tell()) {}

    /// `begin`: in the picture that the file may hold a part of.
    void write(int begin, int rows, const unsigned char* pixels, std::size_t pixel_stride) {
        constexpr std::size_t kPiece = 4u << 20;  // [byte]
        const std::size_t row_bytes = static_cast<std::size_t>(spec_.width) * pixel_stride;
        const int fitting = static_cast<int>(kPiece / row_bytes) / kFileBlockRows;
        const int piece = std::max(fitting, 1) * kFileBlockRows;
        // A piece takes four times its memory at most; all pieces take twice that of the rows.
        const int most = (rows / piece + 1) / 2;
        const int threads = tbb::this_task_arena::max_concurrency();
        int next = 0, done = 0;
        const auto pieces = [&](tbb::flow_control& flow) {
            if (next >= rows) flow.stop();
            return std::exchange(next, next + piece);
        };
        const auto coded = [&](int row) {
            return blocks_of(std::min(piece, rows - row),
                             pixels + static_cast<std::size_t>(row) * row_bytes, pixel_stride);
        };
        const auto put = [&](Blocks blocks) {
            append(std::move(blocks), begin + std::exchange(done, done + piece));
        };
        // Otherwise a waiting thread may begin another picture, and need memory for both.
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_pipeline(
                static_cast<std::size_t>(std::clamp(most, 1, threads)),
                tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, pieces) &
                    tbb::make_filter<int, Blocks>(tbb::filter_mode::parallel, coded) &
                    tbb::make_filter<Blocks, void>(tbb::filter_mode::serial_in_order, put));
        });
    }

    /// Fills in the table of blocks. Call it after the last row.
    void write_table() {
        const std::size_t bytes = places_.size() * sizeof places_[0];
        proxy_.seek(table_end_ - static_cast<std::int64_t>(bytes));
        proxy_.write(places_.data(), bytes);
    }

 private:
    // A file in memory, whose blocks begin at `begin`.
    struct Blocks {
        std::vector<unsigned char> bytes{};
        std::size_t begin = 0;
    };
    // The beginning of a block, before its data.
    struct BlockHead {
        std::int32_t row;
        std::int32_t bytes;
    };

    Blocks blocks_of(int rows, const unsigned char* pixels, std::size_t pixel_stride) const {
        OIIO::ImageSpec spec = spec_;
        spec.x = spec.y = 0;
        spec.full_width = spec.width;
        spec.height = spec.full_height = rows;
        Blocks out;
        out.bytes.reserve(spec.image_bytes(true));  // growing would copy: few pieces are larger
        OIIO::Filesystem::IOVecOutput memory(out.bytes);
        const auto file = create_output(name_, "openexr", memory);
        bool is_good = file->open("memory.openexr", spec);
        out.begin = out.bytes.size();
        is_good = is_good && file->write_scanlines(0, rows, 0, type_in(spec), pixels,
                                                   static_cast<OIIO::stride_t>(pixel_stride));
        if (!is_good || !file->close()) fail(name_, file->geterror());
        return out;
    }

    // Appends the blocks of a piece whose first row is `row`.
    void append(Blocks blocks, int row) {
        for (std::size_t at = blocks.begin; at < blocks.bytes.size();) {
            BlockHead head;
            std::memcpy(&head, &blocks.bytes[at], sizeof head);
            head.row += row;
            std::memcpy(&blocks.bytes[at], &head, sizeof head);
            places_.push_back(static_cast<std::uint64_t>(proxy_.tell()) + at - blocks.begin);
            at += sizeof head + static_cast<std::size_t>(head.bytes);
        }
        proxy_.write(&blocks.bytes[blocks.begin], blocks.bytes.size() - blocks.begin);
    }

    std::string name_;
    OIIO::ImageSpec spec_;
    OIIO::Filesystem::IOProxy& proxy_;
    std::int64_t table_end_;
    std::vector<std::uint64_t> places_{};  // of the blocks in the file
};

// Whether ExrRows writes the file: uncompressed ones leave threads nothing to do.
bool has_exr_rows(const std::string& format, const OIIO::ImageSpec& spec) {
    return format == "openexr" && spec.get_string_attribute("compression") != "none";
}

class FileWriter : public ImageWriter {
 public:
    FileWriter(const std::string& name, const std::string& format, const ImageLayout& layout,
               int file)
        : name_(name),
          spec_(spec_of(layout)),
          proxy_(file),
          out_(create_output(name, format, proxy_)) {
        check(out_->open("memory." + format, spec_));
        next_ = spec_.y;
        if (has_exr_rows(format, spec_)) exr_.emplace(name_, spec_, proxy_);
    }

    void write(int rows, std::span<const unsigned char> pixels, std::size_t pixel_stride) override {
        if (exr_) exr_->write(next_, rows, pixels.data(), pixel_stride);
        check(exr_ || out_->write_scanlines(next_, next_ + rows, 0, type_in(spec_), pixels.data(),
                                            static_cast<OIIO::stride_t>(pixel_stride)));
        next_ += rows;
        proxy_.begin_flush();
    }

    void close() override {
        check(out_->close());
        if (exr_) exr_->write_table();
        check(true);
    }

 private:
    // An error of the system is reported in place of what the format's library makes of it.
    void check(bool is_written) {
        if (is_written && proxy_.error() == 0) return;
        const std::string reason = out_->geterror();
        abandon();
        if (proxy_.error() == 0) fail(name_, reason);
        throw Error(name_ + ": cannot write: " + std::strerror(proxy_.error()));
    }

    // Keeps a writer that failed for ever: its destructor ends the file, for which libpng prints an
    // error of its own if rows are missing.
    void abandon() {
        static std::mutex mutex;
        static auto* const abandoned = new std::vector<std::unique_ptr<OIIO::ImageOutput>>;
        const std::scoped_lock lock(mutex);
        abandoned->push_back(std::move(out_));
    }

    std::string name_;
    OIIO::ImageSpec spec_;
    DescriptorProxy proxy_;
    std::unique_ptr<OIIO::ImageOutput> out_;  // its destructor writes, too
    std::optional<ExrRows> exr_{};            // of such a file
    int next_ = 0;                            // row
};

}  // namespace

std::vector<unsigned char> encode_pixels(const std::string& name, const std::string& format,
                                         const ImageLayout& layout,
                                         std::span<const unsigned char> pixels,
                                         std::size_t pixel_stride) {
    std::vector<unsigned char> bytes;
    bytes.reserve(pixels.size() + 65536);  // growing would copy: few files are larger
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const OIIO::ImageSpec spec = spec_of(layout);
    const auto out = create_output(name, format, memory);
    if (!out->open("memory." + format, spec)) fail(name, out->geterror());
    std::optional<ExrRows> exr;
    if (has_exr_rows(format, spec)) {
        exr.emplace(name, spec, memory).write(spec.y, spec.height, pixels.data(), pixel_stride);
    } else if (!out->write_image(type_in(spec), pixels.data(),
                                 static_cast<OIIO::stride_t>(pixel_stride))) {
        fail(name, out->geterror());
    }
    if (!out->close()) fail(name, out->geterror());
    if (exr) exr->write_table();
    return bytes;
}

std::unique_ptr<ImageWriter> open_writer(const std::string& name, const std::string& format,
                                         const ImageLayout& layout, int file) {
    return std::make_unique<FileWriter>(name, format, layout, file);
}

}  // namespace kilolux::oiio
