// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/rgb_image.h"

#include <fmt/core.h>

#include "host/base/error.h"
#include "host/base/formats/srgb.h"

namespace kilolux {
namespace {

void require_values(std::string_view what, const RgbImage& image, std::size_t channels,
                    std::size_t count) {
    if (count == channels * image.pixel_count()) return;
    throw Error(fmt::format("{} of {}x{} pixels: {} values, must be {}", what, image.width,
                            image.height, count, channels * image.pixel_count()));
}

}  // namespace

RgbImage make_rgb_image(int width, int height) {
    RgbImage image{.width = width, .height = height, .rgb = {}};
    image.rgb.resize(3 * image.pixel_count());
    return image;
}

RgbImage rgb_image_of(int width, int height, std::span<const float> rgb) {
    RgbImage image{.width = width, .height = height, .rgb = {}};
    require_values("picture", image, 3, rgb.size());
    image.rgb.assign(rgb.begin(), rgb.end());
    return image;
}

RgbImage linear_from_display(const DisplayView& display) {
    const auto linear = srgb_to_linear_table();
    RgbImage image = make_rgb_image(display.width, display.height);
    require_values("display picture", image, 4, display.rgba.size());
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        image.rgb[i] = linear[display.rgba[i / 3 * 4 + i % 3]];
    }
    return image;
}

void require_same_size(std::string_view what, int width, int height, int other_width,
                       int other_height) {
    if (width == other_width && height == other_height && width > 0 && height > 0) return;
    throw Error(
        fmt::format("{}: the pictures are {}x{} and {}x{} pixels, must be equal and not empty",
                    what, width, height, other_width, other_height));
}

}  // namespace kilolux
