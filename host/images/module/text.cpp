// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "host/base/error.h"
#include "host/images/module/parts.h"

namespace kilolux::oiio {
namespace {

// Where distributions put the font; else OpenImageIO looks for it.
std::string font_file() {
    for (const char* file : {"/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf",
                             "/usr/share/fonts/TTF/DejaVuSansMono.ttf",
                             "/usr/share/fonts/dejavu-sans-mono-fonts/DejaVuSansMono.ttf"}) {
        if (std::filesystem::exists(file)) return file;
    }
    return "DejaVuSansMono";
}

}  // namespace

TextMask text_mask(const std::string& text, int size) {
    static const std::string font = font_file();
    const int pixels = std::max(size * 4 / 5, 1);  // of an em
    // text_size() measures ink: one character's height, and the advance as two characters less one.
    const OIIO::ROI one = OIIO::ImageBufAlgo::text_size("|", pixels, font);
    const OIIO::ROI two = OIIO::ImageBufAlgo::text_size("||", pixels, font);
    if (!one.defined() || !two.defined())
        throw Error(
            fmt::format("text: cannot draw in the font {} (package fonts-dejavu-core)", font));
    TextMask out{static_cast<int>(text.size()) * (two.xend - one.xend), size, {}};
    if (text.empty()) return out;
    OIIO::ImageBuf image(OIIO::ImageSpec(out.width, out.height, 1, OIIO::TypeDesc::UINT8));
    OIIO::ImageBufAlgo::zero(image);
    const float ink = 1.0f;
    if (!OIIO::ImageBufAlgo::render_text(image, 0, -one.ybegin, text, pixels, font, ink))
        throw Error("text: " + image.geterror());
    out.coverage.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    image.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::UINT8, out.coverage.data());
    return out;
}

}  // namespace kilolux::oiio
