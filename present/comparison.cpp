// SPDX-License-Identifier: Apache-2.0
#include "present/comparison.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "host/base/error.h"
#include "present/image_file.h"

namespace kilolux {
namespace {

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

std::vector<float> display_colour(const Frame& frame) {
    std::vector<float> colour;
    colour.reserve(frame.display.size() / 4 * 3);
    for (std::size_t i = 0; i < frame.display.size(); ++i) {
        if (i % 4 != 3) colour.push_back(static_cast<float>(frame.display[i]) / 255.0f);
    }
    return colour;
}

// What is not finite and not the same is infinitely wrong, so that no average can pass over it.
double difference(float a, float b) {
    if (std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || a == b) return 0.0;
    const double d = std::abs(static_cast<double>(a) - static_cast<double>(b));
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

std::vector<std::pair<std::string, double>> errors_of(const std::vector<float>& picture,
                                                      const std::vector<float>& reference) {
    double squares = 0.0;
    double sum = 0.0;
    double largest = 0.0;
    double different = 0.0;
    for (std::size_t i = 0; i < picture.size(); i += 3) {
        bool same = true;
        for (std::size_t c = i; c < i + 3; ++c) {
            const double d = difference(picture[c], reference[c]);
            squares += d * d;
            sum += d;
            largest = std::max(largest, d);
            same = same && d == 0.0;
        }
        different += same ? 0.0 : 1.0;
    }
    const double count = std::max(1.0, static_cast<double>(picture.size()));
    return {{"rmse", std::sqrt(squares / count)},
            {"mean", sum / count},
            {"max", largest},
            {"different-pixels", different}};
}

}  // namespace

std::vector<std::string> metric_names() {
    return {"rmse", "mean", "max", "different-pixels"};
}

Reference::Reference(std::filesystem::path file)
    : file_(std::move(file)), linear_(image_meaning(file_) == ImageMeaning::linear) {
    const FloatImage image = read_image(file_);
    width_ = image.width;
    height_ = image.height;
    colour_ = colour_of(image);
}

Comparison Reference::compare(const Frame& frame, const std::string& metric,
                              double threshold) const {
    if (frame.width != width_ || frame.height != height_) {
        throw Error(file_.string() + ": the reference is " + size_text(width_, height_) +
                    " pixels, the picture " + size_text(frame.width, frame.height));
    }
    Comparison out{metric, 0.0, threshold, {}};
    out.errors = errors_of(linear_ ? frame.radiance : display_colour(frame), colour_);
    for (const auto& [name, value] : out.errors) {
        if (name == metric) out.value = value;
    }
    return out;
}

}  // namespace kilolux
