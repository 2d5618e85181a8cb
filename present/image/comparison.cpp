// SPDX-License-Identifier: Apache-2.0
#include "present/image/comparison.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/base/formats/srgb.h"
#include "host/measure/metrics/error_metrics.h"
#include "host/measure/metrics/flip.h"
#include "host/measure/metrics/flip_hdr.h"
#include "present/image/display_picture.h"
#include "present/image/image_file.h"
#include "present/image/read.h"

namespace kilolux {
namespace {

RgbImage linear_of_display(RgbImage image) {
    for (double& value : image.rgb) value = srgb_to_linear(value);
    return image;
}

ErrorDistribution flip_of(const RgbImage& picture, const RgbImage& reference, bool linear) {
    if (linear) return flip_hdr(picture, reference).error;
    return flip_ldr(linear_of_display(picture), linear_of_display(reference)).error;
}

}  // namespace

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
    return rgb_image_of(frame.width, frame.height, linear_ ? frame.radiance : display_codes(frame));
}

Comparison Reference::compare(const Frame& frame, const std::string& metric,
                              double threshold) const {
    const RgbImage picture = comparable(frame);
    const auto asked = std::ranges::find(error_metrics(), metric, &ErrorMetric::name);
    PictureErrors errors;
    errors.hdr = compare_hdr(picture, colour_);
    if (asked->part == MetricPart::flip) errors.flip = flip_of(picture, colour_, linear_);
    Comparison out{metric, *asked->value(errors), threshold, {}};
    for (const ErrorMetric& m : error_metrics()) {
        if (m.is_error && (m.part == MetricPart::hdr || m.part == asked->part))
            out.errors.emplace_back(m.name, *m.value(errors));
    }
    return out;
}

Canvas Reference::error_map(const Frame& frame) const {
    const auto relative = pixel_errors(comparable(frame), colour_, &colour_);
    return kilolux::error_map(relative, {frame.width, frame.height, frame.width, frame.height});
}

Frame Reference::difference(const Frame& frame) const {
    const RgbImage picture = comparable(frame);
    Frame out;
    out.width = frame.width;
    out.height = frame.height;
    const HeatScale scale{1e-6, 1.0, true, "DIFFERENCE"};
    std::vector<double> largest(picture.pixel_count(), 0.0);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        const double error = std::abs(picture.rgb[i] - colour_.rgb[i]);
        out.radiance.push_back(static_cast<float>(error));
        largest[i / 3] = std::max(largest[i / 3], std::isnan(error) ? scale.high : error);
    }
    Canvas map = heat_map(largest, frame.width, frame.height, scale);
    draw_legend(map, scale);
    out.display = std::move(map.rgba);
    return out;
}

Canvas error_map(std::span<const double> relative, const ErrorMapSize& size) {
    const HeatScale scale{1e-8, 1.0, true, "RELATIVE ERROR"};
    std::vector<double> values;
    for (int y = 0; y < size.height; ++y) {
        const int row = y * size.from_height / size.height;
        for (int x = 0; x < size.width; ++x) {
            const int from = row * size.from_width + x * size.from_width / size.width;
            values.push_back(relative[static_cast<std::size_t>(from)]);
        }
    }
    Canvas map = heat_map(values, size.width, size.height, scale);
    draw_legend(map, scale);
    return map;
}

}  // namespace kilolux
