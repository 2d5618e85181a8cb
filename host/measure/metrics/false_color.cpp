// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/false_color.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

constexpr SrgbCode kNanColor = {255, 0, 255};

// Coefficients of t^0 .. t^6 for red, green and blue: Zucker's least squares fit of viridis (CC0).
constexpr std::array<std::array<double, 7>, 3> kViridis = {{
    {0.2777273272234177, 0.1050930431085774, -0.3308618287255563, -4.634230498983486,
     6.228269936347081, 4.776384997670288, -5.435455855934631},
    {0.005407344544966578, 1.404613529898575, 0.214847559468213, -5.799100973351585,
     14.17993336680509, -13.74514537774601, 4.645852612178535},
    {0.3340998053353061, 1.384590162594685, 0.09509516302823659, -19.33244095627987,
     56.69055260068105, -65.35303263337234, 26.3124352495832},
}};

std::uint8_t code_of(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
}

}  // namespace

SrgbCode viridis(double t) {
    const double x = std::clamp(t, 0.0, 1.0);
    SrgbCode out{};
    for (std::size_t c = 0; c < 3; ++c) {
        double value = 0.0;
        for (std::size_t k = kViridis[c].size(); k-- > 0;) value = value * x + kViridis[c][k];
        out[c] = code_of(value);
    }
    return out;
}

double scale_position(double magnitude, const FalseColorScale& scale) {
    if (std::isnan(magnitude)) return magnitude;
    const double clamped = std::clamp(magnitude, scale.low, scale.high);
    if (scale.logarithmic) return std::log(clamped / scale.low) / std::log(scale.high / scale.low);
    return (clamped - scale.low) / (scale.high - scale.low);
}

std::vector<std::uint8_t> false_color(std::span<const double> magnitudes,
                                      const FalseColorScale& scale) {
    std::vector<std::uint8_t> out;
    out.reserve(4 * magnitudes.size());
    for (const double magnitude : magnitudes) {
        const double t = scale_position(magnitude, scale);
        const SrgbCode color = std::isnan(t) ? kNanColor : viridis(t);
        out.insert(out.end(), {color[0], color[1], color[2], 255});
    }
    return out;
}

}  // namespace kilolux
