// SPDX-License-Identifier: Apache-2.0
#include "host/images/module/pixels.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

#include "host/base/error.h"
#include "host/base/suggest.h"

namespace kilolux::oiio {
namespace {

// `name` if the list has it; else throws UsageError with the list.
std::string checked(const char* option, const std::string& name,
                    const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return name;
    throw UsageError(std::string(option) + ": the configuration in $OCIO has no '" + name +
                     "'; it has " + joined(known) + did_you_mean(name, known));
}

std::string input_space(const OIIO::ColorConfig& config, const std::string& wanted) {
    const std::vector<std::string> spaces = config.getColorSpaceNames();
    if (!wanted.empty()) return checked("--ocio-input", wanted, spaces);
    // Names in the configurations of ACES (studio, CG, older), Blender, The Foundry and Sony.
    for (const char* name : {"Linear Rec.709 (sRGB)", "Utility - Linear - sRGB", "lin_srgb",
                             "Linear Rec.709", "lin_rec709", "linear", "lnf"}) {
        if (std::find(spaces.begin(), spaces.end(), name) != spaces.end()) return name;
    }
    const char* role = config.getColorSpaceNameByRole("scene_linear");
    if (role != nullptr) return role;
    throw UsageError(
        "--ocio-input: the configuration in $OCIO has no linear Rec. 709 space by name "
        "and no role scene_linear; it has " +
        joined(spaces));
}

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

void apply_ocio(std::span<float> rgb, int width, const std::string& configuration,
                const OcioOptions& options) {
    OIIO::ColorConfig config(configuration);
    const auto fail = [&](const std::string& reason) {
        throw Error("OpenColorIO, " + configuration + ": " + reason);
    };
    if (config.has_error() || config.getNumDisplays() == 0) fail(config.geterror());
    const std::string display = options.display.empty() ? config.getDefaultDisplayName()
                                                        : checked("--ocio-display", options.display,
                                                                  config.getDisplayNames());
    const std::string view =
        options.view.empty() ? config.getDefaultViewName(display)
                             : checked("--ocio-view", options.view, config.getViewNames(display));
    const int height = static_cast<int>(rgb.size() / 3 / static_cast<std::size_t>(width));
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT), rgb.data());
    if (!OIIO::ImageBufAlgo::ociodisplay(image, image, display, view,
                                         input_space(config, options.input), "", false, "", "",
                                         &config)) {
        fail(image.geterror());
    }
}

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
