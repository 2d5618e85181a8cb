// SPDX-License-Identifier: Apache-2.0
// Files that are written strip by strip.
#include <gtest/gtest.h>

#include <algorithm>

#include "present/image/image_file.h"
#include "tests/images/file_frames.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

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

TEST(ImageStrips, StripsMakeTheSameBytes) {
    const TemporaryFolder folder;
    const Frame plain = make_frame(), layered = make_layered_frame();
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
        EXPECT_TRUE(can_stream(name));
        bytes_of_stream(folder / name, plain, {});
    }
    EXPECT_FALSE(can_stream("a.hdr")) << "its notes are inserted into the bytes";
    for (const char* compression : kExrCompressions) {
        ImageOptions options;
        options.half_colour = true;
        options.exr_compression = compression;
        bytes_of_stream(folder / (std::string(compression) + ".exr"), layered, options);
    }
}

// The system's reason, once the bytes that wait are written, and no file.
TEST(ImageStrips, AStreamOntoAFullDiskSaysSo) {
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

}  // namespace
}  // namespace kilolux
