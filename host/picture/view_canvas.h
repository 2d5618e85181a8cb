// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

using DisplayColor = std::array<std::uint8_t, 3>;  // sRGB codes

/// An opaque display picture, 4 bytes a pixel, row 0 on top.
struct Canvas {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;

    /// Does nothing outside the picture.
    void set(int x, int y, const DisplayColor& color);
};

/// A black picture.
Canvas make_canvas(int width, int height);

/// The heat map's colour at t in [0, 1], clamped: black over violet and orange to pale yellow, of
/// steadily rising lightness, so that order survives grey print and colour blindness. Linear
/// between nine colours of matplotlib's inferno (Smith and van der Walt 2015, CC0).
DisplayColor heat_color(double t);

/// A colour for a number, unlike those of the numbers beside it.
DisplayColor id_color(std::uint32_t id);

/// The values at the ends of a heat map.
struct HeatScale {
    double low = 0.0;
    double high = 1.0;         // > low
    bool logarithmic = false;  // low > 0
    std::string_view unit;     // beside the bar
    bool steps = false;        // logarithmic, in even colours between 1, 2, 5, 10, 20 and so on
};

/// From 0 to 1; of a scale in steps the middle of the value's step.
double position_on(const HeatScale& scale, double value);

/// The number of the step from 1, 2 or 5 times a power of ten that a value > 0 is in.
int round_step(double value);

/// Whether position_on() of a scale in steps was in one step and in the one beside it.
bool are_neighbour_steps(const HeatScale& scale, double a, double b);

/// Four powers of ten in steps, up to the end of the step that `most` is in.
HeatScale scale_in_steps(double most, std::string_view unit);

/// Bar with numbers in the lower left corner; pictures under 128 x 48 pixels get none.
void draw_legend(Canvas& canvas, const HeatScale& scale);

/// `values`, one per pixel, in the heat map's colours; NaN is green.
Canvas heat_map(std::span<const double> values, int width, int height, const HeatScale& scale);

/// White text on black, by text_mask(): upper left corner at (x, y), lines of `size` pixels.
/// Returns its width [pixel].
int draw_text(Canvas& canvas, int x, int y, int size, const std::string& text);

}  // namespace kilolux
