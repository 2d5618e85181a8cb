// SPDX-License-Identifier: Apache-2.0
#include "present/image/display_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "host/base/error.h"
#include "host/base/formats/srgb.h"
#include "host/render/environment_light.h"
#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

float srgb_of_linear(float linear) {
    return static_cast<float>(linear_to_srgb(std::clamp<double>(linear, 0.0, 1.0)));
}

// Gives the pixels of the backdrop's light its code.
void show_backdrop(const Backdrop& backdrop, const std::vector<float>& light,
                   std::vector<float>& rgb) {
    const FV3 wanted = fv3(backdrop.light.x, backdrop.light.y, backdrop.light.z);
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
        if (!is_backdrop(fv3(light[i], light[i + 1], light[i + 2]), wanted)) continue;
        for (uint c = 0; c < 3; ++c) {
            rgb[i + c] = static_cast<float>(backdrop.code >> (8 * c) & 255u) / 255.0f;
        }
    }
}

FV3 tone_mapped(FV3 c, ToneCurve curve) {
    c = fv3(displayable(c.x), displayable(c.y), displayable(c.z));
    return tone_curve_of(static_cast<int>(curve), c);
}

}  // namespace

const char* ocio_config() {
    const char* file = std::getenv("OCIO");
    return file != nullptr && *file != '\0' ? file : nullptr;
}

bool uses_ocio(const OcioOptions& options) {
    if (ocio_config() != nullptr) return options.view != "none";
    const bool asked = !options.display.empty() || !options.input.empty() ||
                       (!options.view.empty() && options.view != "none");
    if (asked) {
        throw UsageError(
            "--ocio-view and its like need the environment's OCIO to name a "
            "configuration, e.g. OCIO=config.ocio");
    }
    return false;
}

std::vector<float> display_codes(const Frame& frame) {
    std::vector<float> rgb;
    rgb.reserve(frame.display.size() / 4 * 3);
    for (std::size_t i = 0; i < frame.display.size(); ++i) {
        if (i % 4 != 3) rgb.push_back(static_cast<float>(frame.display[i]) / 255.0f);
    }
    return rgb;
}

void set_display(Frame& frame, const std::vector<float>& rgb) {
    frame.display.assign(rgb.size() / 3 * 4, 255);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        frame.display[i / 3 * 4 + i % 3] =
            static_cast<std::uint8_t>(std::lround(static_cast<double>(rgb[i]) * 255.0));
    }
}

std::vector<float> display_colours(const Frame& frame, const RenderSettings& settings,
                                   const OcioOptions& ocio) {
    if (settings.want.view != ViewKind::lit) return display_codes(frame);
    const std::vector<float>& light =
        frame.shown_light.empty() ? frame.radiance : frame.shown_light;
    std::vector<float> rgb = light;
    const float gain = std::exp2(settings.exposure);
    for (float& v : rgb) v *= gain;
    if (uses_ocio(ocio)) {
        for (float& v : rgb) v = displayable(v);
        apply_ocio(rgb, frame.width, ocio_config(), ocio);
        for (float& v : rgb) v = std::fmin(std::fmax(v, 0.0f), 1.0f);
    } else {
        for (std::size_t i = 0; i < rgb.size(); i += 3) {
            const FV3 c = tone_mapped(fv3(rgb[i], rgb[i + 1], rgb[i + 2]), settings.tone_curve);
            rgb[i] = srgb_of_linear(c.x);
            rgb[i + 1] = srgb_of_linear(c.y);
            rgb[i + 2] = srgb_of_linear(c.z);
        }
    }
    show_backdrop(backdrop_of(settings), light, rgb);
    return rgb;
}

}  // namespace kilolux
