// SPDX-License-Identifier: Apache-2.0
#include "host/picture/view_canvas.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>

#include "host/images/images.h"

namespace kilolux {
namespace {

constexpr std::array<DisplayColor, 9> kHeat = {{{0, 0, 4},
                                                {31, 12, 72},
                                                {85, 15, 109},
                                                {136, 34, 106},
                                                {186, 54, 85},
                                                {227, 89, 51},
                                                {249, 140, 10},
                                                {249, 201, 50},
                                                {252, 255, 164}}};
constexpr DisplayColor kPaper = {0, 0, 0};

constexpr int kLegendLine = 10;  // of text, at a zoom of 1 [pixel]

std::string number_text(double value) {
    const bool small = value > 0.0 && value < 0.01;
    return small ? fmt::format("{:.1e}", value) : fmt::format("{:.3g}", value);
}

void fill(Canvas& canvas, std::array<int, 4> box, const DisplayColor& color) {
    for (int y = box[1]; y < box[3]; ++y) {
        for (int x = box[0]; x < box[2]; ++x) canvas.set(x, y, color);
    }
}

double value_at(const HeatScale& scale, double t) {
    if (scale.logarithmic) return scale.low * std::pow(scale.high / scale.low, t);
    return scale.low + t * (scale.high - scale.low);
}

// Where a step begins: 1, 2, 5 times a power of ten.
double step_start(int step) {
    constexpr std::array kStarts = {1.0, 2.0, 5.0};
    const int decade = step >= 0 ? step / 3 : -((2 - step) / 3);
    return kStarts[static_cast<std::size_t>(step - 3 * decade)] * std::pow(10.0, decade);
}

// The colour of the bar at a place from 0 to 1.
DisplayColor bar_color(const HeatScale& scale, double t) {
    return heat_color(scale.steps ? position_on(scale, value_at(scale, t)) : t);
}

}  // namespace

int round_step(double value) {
    int step = 3 * static_cast<int>(std::floor(std::log10(value)));
    while (step_start(step) > value) --step;
    while (step_start(step + 1) <= value) ++step;
    return step;
}

HeatScale scale_in_steps(double most, std::string_view unit) {
    constexpr int kSteps = 12;  // four powers of ten
    const int last = most > 0.0 && std::isfinite(most) ? round_step(most) : 0;
    return {step_start(last + 1 - kSteps), step_start(last + 1), true, unit, true};
}

void Canvas::set(int x, int y, const DisplayColor& color) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const std::size_t i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x));
    std::copy(color.begin(), color.end(), rgba.begin() + static_cast<std::ptrdiff_t>(i));
}

Canvas make_canvas(int width, int height) {
    Canvas out{width, height, {}};
    out.rgba.assign(
        std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (std::size_t i = 3; i < out.rgba.size(); i += 4) out.rgba[i] = 255;
    return out;
}

DisplayColor heat_color(double t) {
    const double place = std::clamp(t, 0.0, 1.0) * (kHeat.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(place), kHeat.size() - 2);
    DisplayColor out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = static_cast<std::uint8_t>(
            std::lround(std::lerp(kHeat[i][c], kHeat[i + 1][c], place - static_cast<double>(i))));
    }
    return out;
}

DisplayColor id_color(std::uint32_t id) {
    // Two rounds of a multiplicative hash (Wellons 2018, lowbias32).
    std::uint32_t h = id + 0x9e3779b9u;
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
    const auto channel = [h](int shift) {
        return static_cast<std::uint8_t>(64u + (h >> shift & 0xffu) * 3u / 4u);
    };
    return {channel(0), channel(8), channel(16)};
}

double position_on(const HeatScale& scale, double value) {
    if (scale.steps) {
        if (!(value >= scale.low)) return 0.0;
        const int first = round_step(scale.low), count = round_step(scale.high) - first;
        const int step = std::min(round_step(std::min(value, scale.high)) - first, count - 1);
        return (step + 0.5) / count;
    }
    if (scale.logarithmic) {
        return std::log(std::max(value, scale.low) / scale.low) / std::log(scale.high / scale.low);
    }
    return (value - scale.low) / (scale.high - scale.low);
}

Canvas heat_map(std::span<const double> values, int width, int height, const HeatScale& scale) {
    constexpr DisplayColor kNan = {0, 255, 0};
    Canvas out = make_canvas(width, height);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const DisplayColor color =
            std::isnan(values[i]) ? kNan : heat_color(position_on(scale, values[i]));
        std::copy(color.begin(), color.end(),
                  out.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
    return out;
}

int draw_text(Canvas& canvas, int x, int y, int size, const std::string& text) {
    const TextMask mask = text_mask(text, size);
    for (int v = 0; v < mask.height; ++v) {
        for (int u = 0; u < mask.width; ++u) {
            const auto code = mask.coverage[static_cast<std::size_t>(v * mask.width + u)];
            if (code > 0) canvas.set(x + u, y + v, {code, code, code});
        }
    }
    return mask.width;
}

bool are_neighbour_steps(const HeatScale& scale, double a, double b) {
    const int count = round_step(scale.high) - round_step(scale.low);
    return std::lround(count * std::abs(a - b)) == 1;
}

void draw_legend(Canvas& canvas, const HeatScale& scale) {
    if (canvas.width < 128 || canvas.height < 48) return;
    const int zoom = std::max(1, canvas.height / 360);
    const int bar = 96 * zoom, margin = 4 * zoom, line = kLegendLine * zoom;
    const auto width_of = [&](const std::string& text) { return text_mask(text, line).width; };
    const std::string unit(scale.unit);
    const int height = line + 8 * zoom + 3 * margin;
    const int top = canvas.height - height;
    fill(canvas, {0, top, bar + 5 * margin + width_of(unit), canvas.height}, kPaper);
    for (int x = 0; x < bar; ++x) {
        const DisplayColor color = bar_color(scale, (x + 0.5) / bar);
        fill(canvas, {margin + x, top + margin, margin + x + 1, top + margin + 8 * zoom}, color);
    }
    // Under the bar: its ends' numbers, and the middle's where it fits between them.
    const std::string middle = number_text(value_at(scale, 0.5));
    const std::string high = number_text(value_at(scale, 1.0));
    const int y = top + 2 * margin + 8 * zoom;
    const int high_x = margin + bar - width_of(high);
    const int middle_x = margin + (bar - width_of(middle)) / 2;
    const int low_end = margin + draw_text(canvas, margin, y, line, number_text(scale.low));
    draw_text(canvas, high_x, y, line, high);
    if (low_end < middle_x && middle_x + width_of(middle) < high_x)
        draw_text(canvas, middle_x, y, line, middle);
    draw_text(canvas, bar + 3 * margin, top + margin, line, unit);
}

}  // namespace kilolux
