// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/images/module/parts.h"

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

}  // namespace kilolux::oiio
