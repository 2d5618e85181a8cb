// SPDX-License-Identifier: Apache-2.0
// Pictures to and from files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/base/system/atomic_write.h"
#include "host/images/images.h"
#include "host/picture/crop.h"
#include "host/picture/frame.h"
#include "host/scene/camera.h"

namespace kilolux {

/// The meaning of a file's pixels: sRGB for display (PNG, JPEG, TIFF) or linear scene light (EXR,
/// HDR).
enum class ImageMeaning { display, linear };

/// The extensions of images: of one meaning, else all.
std::vector<std::string> image_extensions(std::optional<ImageMeaning> meaning = {});

/// By the extension; throws UsageError that lists the known ones.
ImageMeaning image_meaning(const std::filesystem::path& file);

/// Whether the format can hold display pictures of 16 bits a channel.
bool holds_16_bits(const std::filesystem::path& file);

bool is_png(const std::filesystem::path& file);

/// Whether the format can hold the covered share of pixels.
bool holds_alpha(const std::filesystem::path& file);

/// Whether the format keeps named channels beside the colour: EXR.
bool holds_layers(const std::filesystem::path& file);

/// Of zlib's levels 0 to 9. With Paeth's filter, level 2 takes a fifth of the time of zlib's usual
/// 6 with a filter chosen row by row, and 7 to 9 % more bytes. At 1920x1080: the atrium 190 ms in
/// place of 900 and 2.81 MB in place of 2.58, Sponza 210 ms for 920 and 3.57 MB for 3.35.
inline constexpr int kPngLevel = 2;

/// OpenEXR's compressions without loss. At 3840x2160, seconds of one core and MB (OpenEXR 3.1):
///
///                        none          zip           piz
///   atrium, float        0.0  99.6     2.0  89.3     1.3  75.9
///   Sponza, float        0.0  99.6     2.0  94.8     1.3  82.6
///   atrium, half         0.0  49.8     0.8  25.8     0.2  25.5
///   atrium, 4 layers     0.0 431.3     7.3 294.4     2.3 262.7
///
/// zip's level changes 2 % of its time. Reading zip and piz takes the same time.
inline constexpr const char* kExrCompressions[] = {"none", "rle", "zips", "zip", "piz"};
inline constexpr const char* kExrCompression = "piz";

/// The note of that name in a file that open_image() read as `layout`; empty where it has none.
std::string note_in(const std::filesystem::path& file, const ImageLayout& layout,
                    const std::string& name);

/// A file's notes about its picture.
struct ImageNotes {
    /// Written as "kilolux:<name>" (NoteForm): scene, lights, renderer, ... in this order.
    std::vector<std::pair<std::string, std::string>> strings;
    std::optional<Camera> camera;  // becomes worldToCamera and worldToNDC
};

/// How pixels are stored.
struct Encoding {
    bool half_colour = false;   // EXR: R, G, B in half
    bool uint_ids = false;      // EXR: layers of ids in UINT, also where floats hold them
    int bits = 8;               // PNG, TIFF: a channel, 8 or 16
    int png_level = kPngLevel;  // of zlib's compression, 0..9
    std::string exr_compression = kExrCompression;
    bool operator==(const Encoding&) const = default;
};

/// The parts of a file beside its frame.
struct ImageOptions : Encoding {
    int jpeg_quality = 95;  // 1..100
    // PNG, EXR: the covered share of each pixel, 0 to 1; empty: all are covered, and there is no
    // channel. Display colours are those of the covering surfaces, EXR's are multiplied by alpha.
    std::vector<float> alpha{};
    std::vector<float> display{};  // RGB from 0 to 1 in place of Frame::display; 16 bits need it
    // Where the frame's pixels are in a picture of which they are a part; EXR tells it.
    std::optional<PixelRect> crop{};
    int full_width = 0;   // of that picture [pixel]
    int full_height = 0;  // [pixel]
};

/// Whether floats hold a layer's ids exactly, and those that it may have elsewhere.
bool float_holds(const Layer& layer);

/// A frame as file bytes in the format of the extension. The same frame gives the same bytes. PNG,
/// JPEG and TIFF hold Frame::display, or the options'; HDR Frame::radiance; EXR Frame::radiance and
/// every layer as channels of one part, ids as UINT where floats cannot hold them. Throws Error
/// with OpenImageIO's reason.
std::vector<unsigned char> encode_image(const std::filesystem::path& file, const Frame& frame,
                                        const ImageNotes& notes, const ImageOptions& options);

/// Some rows of a picture in the form of its file; they refer to the frame.
struct FileRows {
    ImageLayout layout;  // of the whole picture
    int rows = 0;
    std::vector<unsigned char> own{};  // where the frame's form is another
    std::span<const unsigned char> pixels{};
    std::size_t pixel_stride = 0;  // [byte]
};

/// A frame's rows in a picture of `height` rows. Throws Error.
FileRows file_rows(const std::filesystem::path& file, int height, const Frame& frame,
                   const ImageNotes& notes, const ImageOptions& options);

/// The layout of a picture of `width` x `height` pixels in the form of its file, as file_rows()
/// makes it, from that of a file of a part of it; `without`: a text to be left out of
/// the part's notes.
ImageLayout layout_of_whole(const std::filesystem::path& file, const ImageLayout& part, int width,
                            int height, const std::string& without);

/// Whether ImageStream can write the format.
bool can_stream(const std::filesystem::path& file);

/// Whether files of both names have the same format, which keeps pixels as they are.
bool share_lossless_format(const std::filesystem::path& a, const std::filesystem::path& b);

/// A picture's file that is written from the top down: the bytes of encode_image() where strips but
/// the last one are whole blocks of kFileBlockRows. Whole or not at all.
class ImageStream {
 public:
    /// Throws Error where the file cannot be written.
    explicit ImageStream(std::filesystem::path file);

    /// Writes the next rows. Throws Error.
    void write(const FileRows& rows);

    /// Writes the end. Throws Error.
    void commit();

 private:
    std::filesystem::path file_;
    AtomicFile out_;
    std::unique_ptr<ImageWriter> writer_;  // from the first rows on
};

/// Throws Error where the file cannot be written or images cannot be encoded; writes nothing.
void check_can_write_image(const std::filesystem::path& file);

/// encode_image() into a file, whole or not at all.
void write_image(const std::filesystem::path& file, const Frame& frame,
                 const ImageNotes& notes = {}, const ImageOptions& options = {});

/// An image of any kind as floats: values of linear files, codes of others as 0..1.
struct FloatImage {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    std::vector<float> values;  // interleaved, row 0 on top
    std::vector<Layer> ids{};   // UINT channels of an EXR file
};

}  // namespace kilolux
