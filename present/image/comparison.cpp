// SPDX-License-Identifier: Apache-2.0
#include "present/image/comparison.h"

#include "host/base/error.h"
#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/metrics/flip_ldr.h"
#include "host/measure/metrics/metrics.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

// Display codes as read_image() gives those of a file.
std::vector<float> display_colour(const Frame& frame) {
    std::vector<float> colour;
    colour.reserve(frame.display.size() / 4 * 3);
    for (std::size_t i = 0; i < frame.display.size(); ++i) {
        if (i % 4 != 3) colour.push_back(static_cast<float>(frame.display[i]) / 255.0f);
    }
    return colour;
}

RgbImage linear_of_display(RgbImage image) {
    for (double& value : image.rgb) value = linear_from_srgb(value);
    return image;
}

double flip_of(const RgbImage& picture, const RgbImage& reference, bool linear) {
    if (linear) return flip_hdr(picture, reference).flip.error.mean;
    return flip_ldr(linear_of_display(picture), linear_of_display(reference)).error.mean;
}

}  // namespace

std::vector<std::string> metric_names() {
    return {"rmse", "mean", "max", "max-relative", "relmse", "different-pixels", "flip"};
}

Reference::Reference(std::filesystem::path file)
    : file_(std::move(file)), linear_(image_meaning(file_) == ImageMeaning::linear) {
    const FloatImage image = read_image(file_);
    colour_ = rgb_image_of(image.width, image.height, colour_of(image));
}

Comparison Reference::compare(const Frame& frame, const std::string& metric,
                              double threshold) const {
    if (frame.width != colour_.width || frame.height != colour_.height) {
        throw Error(file_.string() + ": the reference is " +
                    size_text(colour_.width, colour_.height) + " pixels, the picture " +
                    size_text(frame.width, frame.height));
    }
    const RgbImage picture =
        rgb_image_of(frame.width, frame.height, linear_ ? frame.radiance : display_colour(frame));
    const HdrMetrics m = compare_hdr(picture, colour_);
    Comparison out{metric, 0.0, threshold, {}};
    out.errors = {
        {"rmse", m.rmse},        {"mean", m.absolute.mean},
        {"max", m.absolute.max}, {"max-relative", m.relative.max},
        {"relmse", m.rel_mse},   {"different-pixels", static_cast<double>(m.different_pixels)}};
    if (metric == "flip") out.errors.emplace_back("flip", flip_of(picture, colour_, linear_));
    for (const auto& [name, value] : out.errors) {
        if (name == metric) out.value = value;
    }
    return out;
}

}  // namespace kilolux
