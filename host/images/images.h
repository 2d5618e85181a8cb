// SPDX-License-Identifier: Apache-2.0
// Image files, through OpenImageIO. To load its 260 libraries takes longer than most commands do,
// so what calls it is a library of ours, libkilolux_images.so, which the first image loads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kilolux {

enum class SampleType { uint8, uint16, uint32, half, float32 };

/// [byte]
constexpr std::size_t size_of(SampleType type) {
    if (type == SampleType::uint8) return 1;
    return type == SampleType::uint16 || type == SampleType::half ? 2 : 4;
}

struct ImageChannel {
    std::string name;
    SampleType type;
};

using ImageAttribute = std::variant<int, std::string, glm::mat4, std::vector<float>>;

/// Size, channels and attributes of an image file.
struct ImageLayout {
    int width = 0;                       // [pixel]
    int height = 0;                      // [pixel]
    std::vector<ImageChannel> channels;  // in the order of a pixel's samples
    // By OpenImageIO's names. Of a file that is read: texts whose names begin with "kilolux:", and
    // what EXR has of the camera and of compression.
    std::vector<std::pair<std::string, ImageAttribute>> attributes{};
    bool associated_alpha = false;  // of a file that is read: its colours are multiplied by alpha
    // Of a file that is read: x and y of red, green, blue and white (CIE 1931); else empty.
    std::vector<float> chromaticities{};
    // The larger picture that these pixels are a part of, from (x, y) on; width 0: there is none.
    // EXR's display window, in which the pixels are the data window.
    int x = 0;
    int y = 0;
    int full_width = 0;
    int full_height = 0;

    std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    /// [byte], of the samples of one pixel side by side.
    std::size_t pixel_bytes() const;
};

/// Loads OpenImageIO now: a command that ends with an image fails before its work where it cannot.
/// Throws Error.
void load_image_library();

/// A file's bytes in `format` ("png", "jpeg", "openexr", ...: OpenImageIO's names), alpha not
/// associated where the format leaves the choice. `pixels`: rows from the top, `pixel_stride` bytes
/// from a pixel to the next, samples in the channels' types. Throws Error "<name>: cannot encode:
/// <OpenImageIO's reason>".
std::vector<unsigned char> encode_pixels(const std::string& name, const std::string& format,
                                         const ImageLayout& layout,
                                         std::span<const unsigned char> pixels,
                                         std::size_t pixel_stride);

/// Formats code at most so many rows at once: OpenEXR's piz, and OpenImageIO's TIFF.
inline constexpr int kFileBlockRows = 32;

/// A file of an image that is written from the top down. Nothing is complete before close().
class ImageWriter {
 public:
    virtual ~ImageWriter() = default;

    /// Writes the next `rows` rows: their pixels as encode_pixels() takes them. Throws Error.
    virtual void write(int rows, std::span<const unsigned char> pixels,
                       std::size_t pixel_stride) = 0;

    /// Writes the end of the file. Throws Error.
    virtual void close() = 0;
};

/// Writes the bytes of encode_pixels() to `file`, an open descriptor at its beginning, which must
/// outlive the writer. Where all writes but the last are of whole blocks of kFileBlockRows, the
/// bytes are the same. Throws Error as encode_pixels(), and with the system's reason.
std::unique_ptr<ImageWriter> open_writer(const std::string& name, const std::string& format,
                                         const ImageLayout& layout, int file);

/// An image whose header is read.
class ImageReader {
 public:
    virtual ~ImageReader() = default;

    virtual const ImageLayout& layout() const = 0;

    /// Reads the channels [begin, end) of all pixels, converted to `type` (integers to 0..1 and
    /// back), to `out`, `stride` bytes from a pixel to the next. Throws Error.
    virtual void read(int begin, int end, SampleType type, void* out, std::size_t stride) = 0;

    /// Reads all channels of `rows` rows from row `first` on, as they are stored, to `out`,
    /// `row_stride` bytes from a row to the next. Throws Error.
    virtual void read_rows(int first, int rows, void* out, std::size_t row_stride) = 0;

    /// Reads the last row of pixels: throws Error for a file that is cut off.
    virtual void check_end() = 0;
};

/// Colours as stored. Throws Error "<file>: cannot read the image: <OpenImageIO's reason>".
std::unique_ptr<ImageReader> open_image(const std::filesystem::path& file);

/// An image in memory, which must outlive the reader; null if there is no reader of `format`.
/// Throws Error with OpenImageIO's reason alone, as does the reader.
std::unique_ptr<ImageReader> open_encoded(const std::string& format,
                                          std::span<const unsigned char> bytes);

/// Which transform of a configuration of OpenColorIO makes the display picture.
struct OcioOptions {
    std::string display;  // empty: the configuration's default
    std::string view;     // empty: the display's default; "none": OpenColorIO stays out
    std::string input;    // colour space of the radiance; empty: a linear Rec. 709 one by its usual
                          // names, else the role scene_linear
    bool operator==(const OcioOptions&) const = default;
};

/// Linear RGB to the display's, in place; 3 * width values a row. Throws Error with OpenColorIO's
/// reason, UsageError for displays, views and spaces that the configuration file lacks.
void apply_ocio(std::span<float> rgb, int width, const std::string& configuration,
                const OcioOptions& options);

/// A line of text as coverage, 0..255 a pixel, row 0 on top.
struct TextMask {
    int width = 0;   // [pixel]
    int height = 0;  // [pixel]; the same for all texts of a size
    std::vector<unsigned char> coverage;
};

/// `text` in DejaVu Sans Mono, whose characters are all as wide, of `size` pixels from one line to
/// the next. Throws Error with OpenImageIO's reason, e.g. where the font is missing.
TextMask text_mask(const std::string& text, int size);

}  // namespace kilolux
