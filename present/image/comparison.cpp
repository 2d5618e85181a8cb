// SPDX-License-Identifier: Apache-2.0
#include "present/image/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/base/srgb.h"
#include "host/measure/metrics/flip.h"
#include "host/measure/metrics/metrics.h"
#include "host/picture/view_canvas.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

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
    for (double& value : image.rgb) value = srgb_to_linear(value);
    return image;
}

double flip_of(const RgbImage& picture, const RgbImage& reference, bool linear) {
    if (linear) return flip_hdr(picture, reference).error.mean;
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

void require_reference_size(const std::filesystem::path& file, int width, int height) {
    const auto [w, h] = image_size(file);
    if (w == width && h == height) return;
    throw Error(fmt::format("{}: the reference is {}x{} pixels, the picture {}x{}", file.string(),
                            w, h, width, height));
}

RgbImage Reference::comparable(const Frame& frame) const {
    return rgb_image_of(frame.width, frame.height,
                        linear_ ? frame.radiance : display_colour(frame));
}

Comparison Reference::compare(const Frame& frame, const std::string& metric,
                              double threshold) const {
    const RgbImage picture = comparable(frame);
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

Frame Reference::difference(const Frame& frame) const {
    const RgbImage picture = comparable(frame);
    Frame out;
    out.width = frame.width;
    out.height = frame.height;
    Canvas map = make_canvas(frame.width, frame.height);
    const HeatScale scale{1e-6, 1.0, true, "DIFFERENCE"};
    for (std::size_t pixel = 0; pixel < picture.pixel_count(); ++pixel) {
        double largest = 0.0;
        for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            const double error = std::abs(picture.rgb[i] - colour_.rgb[i]);
            out.radiance.push_back(static_cast<float>(error));
            largest = std::max(largest, std::isnan(error) ? scale.high : error);
        }
        const int place = static_cast<int>(pixel);
        map.set(place % frame.width, place / frame.width, heat_color(position_on(scale, largest)));
    }
    draw_legend(map, scale);
    out.display = std::move(map.rgba);
    return out;
}

}  // namespace kilolux
