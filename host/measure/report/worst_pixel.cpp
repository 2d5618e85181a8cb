// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/worst_pixel.h"

#include <cstdio>
#include <functional>
#include <string>

#include "host/measure/metrics/false_color.h"

namespace kilolux {
namespace {

constexpr int kZoom = 6;               // pixels of the sheet a pixel of the picture
constexpr int kHalf = 16;              // pixels of the picture beside the worst one
constexpr int kCrop = 2 * kHalf + 1;   // of the picture
constexpr int kPanel = kZoom * kCrop;  // of the sheet
constexpr int kGap = 6;                // between panels
constexpr int kHead = 22;              // room for a line of text
constexpr int kBar = 40;               // the scale with its numbers
constexpr FalseColorScale kScale = {1e-8, 1.0, true};
constexpr DisplayColor kFrame = {255, 64, 64};
constexpr DisplayColor kOutside = {40, 40, 40};

// Upper left corner of the crop: the worst pixel in the middle, if there is room.
struct Crop {
    int x = 0;
    int y = 0;
};

using PixelColor = std::function<DisplayColor(int x, int y)>;

void draw_panel(Canvas& canvas, int left, int top, const PixelColor& color) {
    for (int y = 0; y < kPanel; ++y) {
        for (int x = 0; x < kPanel; ++x) {
            canvas.set(left + x, top + y, color(x / kZoom, y / kZoom));
        }
    }
}

void draw_frame(Canvas& canvas, int left, int top) {
    const int first = kHalf * kZoom - 1, last = (kHalf + 1) * kZoom;
    for (int i = first; i <= last; ++i) {
        for (const auto& [x, y] : {std::pair{i, first}, {i, last}, {first, i}, {last, i}}) {
            canvas.set(left + x, top + y, kFrame);
        }
    }
}

// The colour of a picture's pixel, or of what lies outside.
PixelColor codes_at(const std::vector<std::uint8_t>& rgba, const RgbImage& size, Crop crop) {
    return [&rgba, &size, crop](int x, int y) -> DisplayColor {
        const int px = crop.x + x, py = crop.y + y;
        if (px < 0 || py < 0 || px >= size.width || py >= size.height) return kOutside;
        const auto i = 4 * static_cast<std::size_t>(py * size.width + px);
        return {rgba[i], rgba[i + 1], rgba[i + 2]};
    };
}

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1E", value);
    return text;
}

void draw_row(Canvas& canvas, int top, const std::string& name, const ReportRow& row,
              const ComparedReference& reference, const PictureErrors& errors) {
    const ErrorDistribution& worst = errors.hdr.relative;
    const Crop crop{worst.x - kHalf, worst.y - kHalf};
    const auto error_codes = false_color(pixel_errors(row.picture, reference.picture), kScale);
    const std::string text = name + ": WORST " + short_number(worst.max) + " AT " +
                             std::to_string(worst.x) + "." + std::to_string(worst.y) +
                             "  PICTURE - REFERENCE - ERROR";
    draw_text(canvas, kGap, top + 7, 1, text);
    int left = kGap;
    for (const auto* codes : {&row.display, &reference.display, &error_codes}) {
        draw_panel(canvas, left, top + kHead, codes_at(*codes, row.picture, crop));
        draw_frame(canvas, left, top + kHead);
        left += kPanel + kGap;
    }
}

void draw_scale(Canvas& canvas, int top) {
    const int width = canvas.width - 2 * kGap;
    for (int x = 0; x < width; ++x) {
        const SrgbCode color = viridis(static_cast<double>(x) / (width - 1));
        for (int y = 0; y < 12; ++y) canvas.set(kGap + x, top + y, color);
    }
    for (int decade = -8; decade <= 0; decade += 2) {
        const std::string text = "1E" + std::to_string(decade);
        const int x = (decade + 8) * width / 8 - (decade == 0 ? 18 : 0);
        draw_text(canvas, kGap + x, top + 18, 1, text);
    }
}

}  // namespace

Canvas worst_pixel_sheet(const ReportRow& row, const ReportReferences::All& references) {
    constexpr int kRow = kHead + kPanel + kGap;
    Canvas canvas = make_canvas(3 * kPanel + 4 * kGap, 3 * kRow + kBar);
    draw_row(canvas, 0, "R1", row, references.kernels, row.kernels);
    draw_row(canvas, kRow, "R2", row, references.surfaces, row.surfaces);
    draw_row(canvas, 2 * kRow, "R3", row, references.unbounded, row.unbounded);
    draw_scale(canvas, 3 * kRow);
    return canvas;
}

}  // namespace kilolux
