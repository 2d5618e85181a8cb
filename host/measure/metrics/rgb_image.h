// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace kilolux {

/// A linear Rec. 709 picture in double, interleaved, row 0 on top.
struct RgbImage {
    int width = 0;            // [pixel]
    int height = 0;           // [pixel]
    std::vector<double> rgb;  // 3 * width * height
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
};

/// Luminance of linear Rec. 709 light (ITU-R BT.709-6, item 3.2).
template <typename Value>
double luminance(const Value* rgb) {
    return 0.2126 * double{rgb[0]} + 0.7152 * double{rgb[1]} + 0.0722 * double{rgb[2]};
}

/// A black picture.
RgbImage make_rgb_image(int width, int height);

/// From 3 * width * height float32 values, as in Frame::radiance; exact.
/// Throws Error when the count does not fit the size.
RgbImage rgb_image_of(int width, int height, std::span<const float> rgb);

/// A display-referred picture: sRGB codes, row 0 on top, as in Frame::display. Does not own them.
struct DisplayView {
    int width = 0;                       // [pixel]
    int height = 0;                      // [pixel]
    std::span<const std::uint8_t> rgba;  // 4 * width * height; alpha is ignored
};

/// Linear values in [0, 1] of sRGB codes (IEC 61966-2-1).
RgbImage linear_from_display(const DisplayView& display);

/// Throws Error that names `what` and both sizes unless they are equal and not empty.
void require_same_size(std::string_view what, int width, int height, int other_width,
                       int other_height);
template <typename Picture, typename Other>
void require_same_size(std::string_view what, const Picture& picture, const Other& other) {
    require_same_size(what, picture.width, picture.height, other.width, other.height);
}

}  // namespace kilolux
