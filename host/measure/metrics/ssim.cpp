// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/ssim.h"

#include "host/measure/metrics/compensated_sum.h"
#include "host/measure/metrics/separable_filter.h"

namespace kilolux {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = (0.01 * 255.0) * (0.01 * 255.0);
constexpr double kC2 = (0.03 * 255.0) * (0.03 * 255.0);

// Rec. 709 luma of the codes, 0..255.
Plane luma(const DisplayView& display) {
    Plane out = make_plane(display.width, display.height);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        const auto pixel = display.rgba.subspan(4 * i, 3);
        out.values[i] = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
    }
    return out;
}

Plane product(const Plane& a, const Plane& b) {
    Plane out = make_plane(a.width, a.height);
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
    return out;
}

// Weighted means over the window, of the two pictures and of their products.
struct Moments {
    Plane x, y, xx, yy, xy;
};

Moments moments(const Plane& x, const Plane& y) {
    const auto taps = normalized(gaussian_taps(kSigma, kRadius));
    const auto mean = [&](const Plane& plane) { return filter_separable(plane, taps, taps); };
    return {mean(x), mean(y), mean(product(x, x)), mean(product(y, y)), mean(product(x, y))};
}

double ssim_at(const Moments& m, std::size_t i) {
    const double mx = m.x.values[i];
    const double my = m.y.values[i];
    const double variance_x = m.xx.values[i] - mx * mx;
    const double variance_y = m.yy.values[i] - my * my;
    const double covariance = m.xy.values[i] - mx * my;
    return (2.0 * mx * my + kC1) * (2.0 * covariance + kC2) /
           ((mx * mx + my * my + kC1) * (variance_x + variance_y + kC2));
}

}  // namespace

std::optional<double> ssim(const DisplayView& picture, const DisplayView& reference) {
    require_same_size("SSIM", picture, reference);
    const int inner_width = picture.width - 2 * kRadius;
    const int inner_height = picture.height - 2 * kRadius;
    if (inner_width <= 0 || inner_height <= 0) return std::nullopt;
    const Moments m = moments(luma(picture), luma(reference));
    CompensatedSum sum;
    for (int y = kRadius; y < picture.height - kRadius; ++y) {
        for (int x = kRadius; x < picture.width - kRadius; ++x) {
            sum.add(
                ssim_at(m, static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                               static_cast<std::size_t>(x)));
        }
    }
    return sum.value() / (static_cast<double>(inner_width) * inner_height);
}

}  // namespace kilolux
