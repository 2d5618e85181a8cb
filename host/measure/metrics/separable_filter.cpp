// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/separable_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/measure/metrics/parallel_rows.h"

namespace kilolux {
namespace {

// out[x] = sum_i taps[i] * padded[x + i]; the inner loop runs along the row, so that it vectorises.
void accumulate(std::span<double> out, double tap, const double* in) {
    for (std::size_t x = 0; x < out.size(); ++x) out[x] += tap * in[x];
}

void filter_row(std::span<const double> in, std::span<const double> taps, std::span<double> out) {
    const std::size_t radius = taps.size() / 2;
    std::vector<double> padded(in.size() + 2 * radius);
    std::fill_n(padded.begin(), radius, in.front());
    std::copy(in.begin(), in.end(), padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, in.back());
    std::fill(out.begin(), out.end(), 0.0);
    for (std::size_t i = 0; i < taps.size(); ++i) accumulate(out, taps[i], padded.data() + i);
}

}  // namespace

Plane make_plane(int width, int height) {
    Plane plane{.width = width, .height = height, .values = {}};
    plane.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return plane;
}

std::vector<double> gaussian_taps(double sigma, int radius) {
    std::vector<double> taps;
    for (int x = -radius; x <= radius; ++x)
        taps.push_back(std::exp(-x * x / (2.0 * sigma * sigma)));
    return taps;
}

std::vector<double> normalized(std::vector<double> taps) {
    const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
    for (double& tap : taps) tap /= sum;
    return taps;
}

Plane filter_separable(const Plane& in, std::span<const double> horizontal,
                       std::span<const double> vertical) {
    Plane rows = make_plane(in.width, in.height);
    parallel_rows(in.height, [&](int y) { filter_row(in.row(y), horizontal, rows.row(y)); });
    Plane out = make_plane(in.width, in.height);
    const int radius = static_cast<int>(vertical.size() / 2);
    parallel_rows(in.height, [&](int y) {
        for (int j = 0; j < static_cast<int>(vertical.size()); ++j) {
            const int source = std::clamp(y + j - radius, 0, in.height - 1);
            accumulate(out.row(y), vertical[static_cast<std::size_t>(j)], rows.row(source).data());
        }
    });
    return out;
}

}  // namespace kilolux
