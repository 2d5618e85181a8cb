// SPDX-License-Identifier: Apache-2.0
#include "host/images/images.h"

#include <dlfcn.h>

#include "host/base/error.h"
#include "host/base/system/memory.h"
#include "host/images/library.h"

namespace kilolux {
namespace {

// Looked for beside the program, then where it is installed: CMAKE_BUILD_RPATH,
// CMAKE_INSTALL_RPATH.
const ImageLibrary& load() {
    // The 260 libraries of OpenImageIO 2.4, with two cores. With less, their start crashes or never
    // ends.
    constexpr std::uint64_t kAddressSpace = std::uint64_t{456} << 20;
    require_address_space(kAddressSpace, "the library of images");
    void* const library = dlopen(KILOLUX_IMAGES_FILE, RTLD_LAZY | RTLD_LOCAL);
    void* const table = library == nullptr ? nullptr : dlsym(library, "kilolux_images");
    if (table == nullptr)
        throw Error("cannot load the library of images: " + std::string(dlerror()));
    return *static_cast<const ImageLibrary*>(table);
}

const ImageLibrary& library() {
    static const ImageLibrary& loaded = load();
    return loaded;
}

}  // namespace

void load_image_library() { library(); }

std::size_t ImageLayout::pixel_bytes() const {
    std::size_t bytes = 0;
    for (const ImageChannel& channel : channels) bytes += size_of(channel.type);
    return bytes;
}

std::vector<unsigned char> encode_pixels(const std::string& name, const std::string& format,
                                         const ImageLayout& layout,
                                         std::span<const unsigned char> pixels,
                                         std::size_t pixel_stride) {
    return library().encode(name, format, layout, pixels, pixel_stride);
}

std::unique_ptr<ImageWriter> open_writer(const std::string& name, const std::string& format,
                                         const ImageLayout& layout, int file) {
    return library().writer(name, format, layout, file);
}

std::unique_ptr<ImageReader> open_image(const std::filesystem::path& file) {
    return library().open_file(file);
}

std::unique_ptr<ImageReader> open_encoded(const std::string& format,
                                          std::span<const unsigned char> bytes) {
    return library().open_bytes(format, bytes);
}

void apply_ocio(std::span<float> rgb, int width, const std::string& configuration,
                const OcioOptions& options) {
    library().ocio(rgb, width, configuration, options);
}

TextMask text_mask(const std::string& text, int size) { return library().text(text, size); }

}  // namespace kilolux
