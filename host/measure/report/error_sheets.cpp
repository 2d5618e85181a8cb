// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/error_sheets.h"

#include <fmt/core.h>

#include "host/picture/view_font.h"

namespace kilolux {
namespace {

constexpr int kZoom = 6;              // of the worst pixels' neighbourhoods
constexpr int kHalf = 16;             // pixels on each side of the worst one
constexpr int kCrop = 2 * kHalf + 1;  // [pixel of the picture]
constexpr int kMapWidth = 320;        // smaller error maps are magnified [pixel]
constexpr int kGap = 6;               // between panels
constexpr int kSheetLine = 14;        // of text
constexpr int kLegend = 48;
constexpr int kColumn = kGlyphWidth + 1;
constexpr HeatScale kScale = {.low = 1e-8, .high = 1.0, .logarithmic = true, .unit = {}};
constexpr DisplayColor kFrame = {255, 64, 64};
constexpr DisplayColor kOutside = {40, 40, 40};

// A picture's display codes, 4 per pixel.
struct Codes {
    std::span<const std::uint8_t> rgba;
    int width, height;
};

// A reference with the row's errors against it.
struct Comparison {
    const char* name;
    const ComparedReference& reference;
    const PictureErrors& errors;
};

std::array<Comparison, 3> comparisons(const ReportRow& row,
                                      const ReportReferences::All& references) {
    return {{{"R1", references.kernels, row.kernels},
             {"R2", references.surfaces, row.surfaces},
             {"R3", references.unbounded, row.unbounded}}};
}

struct Region {
    int x, y, width, height;
};

// Words of `text` in lines of at most `columns` characters.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
    std::vector<std::string> lines(1);
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, std::min(end - begin, columns));
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > columns) {
            lines.emplace_back();
        }
        lines.back() += (lines.back().empty() ? "" : " ") + word;
        begin = end + 1;
    }
    return lines;
}

// A sheet of `width` x `height` pixels below the title; `top`: where the panels begin.
struct Sheet {
    Canvas canvas;
    int top = kGap;
};

Sheet make_sheet(int width, int height, const std::string& setting, const std::string& caption) {
    const auto columns = static_cast<std::size_t>((width - 2 * kGap) / kColumn);
    std::vector<std::string> lines = wrapped(setting, columns);
    for (std::string& line : wrapped(caption, columns)) lines.push_back(std::move(line));
    const int title = static_cast<int>(lines.size()) * kSheetLine + kGap;
    Sheet sheet{make_canvas(width, title + height + kLegend), kGap};
    for (const std::string& line : lines) {
        draw_text(sheet.canvas, kGap, sheet.top, 1, line);
        sheet.top += kSheetLine;
    }
    return sheet;
}

void draw_region(Canvas& canvas, int left, int top, int zoom, const Codes& codes,
                 const Region& region) {
    for (int y = 0; y < region.height * zoom; ++y) {
        for (int x = 0; x < region.width * zoom; ++x) {
            const int px = region.x + x / zoom, py = region.y + y / zoom;
            DisplayColor color = kOutside;
            if (px >= 0 && py >= 0 && px < codes.width && py < codes.height) {
                const auto i = 4 * static_cast<std::size_t>(py * codes.width + px);
                color = {codes.rgba[i], codes.rgba[i + 1], codes.rgba[i + 2]};
            }
            canvas.set(left + x, top + y, color);
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

void draw_legend_bar(Canvas& canvas) {
    const int top = canvas.height - kLegend + kGap;
    const int width = canvas.width - 2 * kGap;
    for (int x = 0; x < width; ++x) {
        const DisplayColor color = heat_color(static_cast<double>(x) / (width - 1));
        for (int y = 0; y < 10; ++y) canvas.set(kGap + x, top + y, color);
    }
    for (int decade = -8; decade <= 0; decade += 2) {
        const std::string text = decade == 0 ? "1" : fmt::format("1e{}", decade);
        const int x = (decade + 8) * width / 8;
        const int shift = decade == 0 ? static_cast<int>(text.size()) * kColumn : 0;
        draw_text(canvas, kGap + x - shift, top + 14, 1, text);
    }
    draw_text(canvas, kGap, top + 26, 1, "relative error of the worst channel, NaN is green");
}

std::vector<std::uint8_t> error_codes(const ReportRow& row, const ReferencePicture& reference) {
    const auto errors = pixel_errors(row.picture, reference.radiance, &reference.scale);
    return heat_map(errors, row.picture.width, row.picture.height, kScale).rgba;
}

void draw_worst(Sheet& sheet, const ReportRow& row, const Comparison& against) {
    const ErrorDistribution& worst = against.errors.hdr.relative;
    draw_text(sheet.canvas, kGap, sheet.top, 1,
              fmt::format("{}: {:.1e} at {}. picture - reference - error", against.name, worst.max,
                          pixel_text(worst)));
    sheet.top += kSheetLine;
    const auto map = error_codes(row, against.reference.picture);
    int left = kGap;
    for (const auto* codes : {&row.display, &against.reference.display, &map}) {
        draw_region(sheet.canvas, left, sheet.top, kZoom,
                    {*codes, row.picture.width, row.picture.height},
                    {worst.x - kHalf, worst.y - kHalf, kCrop, kCrop});
        draw_frame(sheet.canvas, left, sheet.top);
        left += kZoom * kCrop + kGap;
    }
    sheet.top += kZoom * kCrop + kGap;
}

// Whole pictures of one size, two beside each other.
class PanelSheet {
 public:
    PanelSheet(const RgbImage& size, int panels, const std::string& name,
               const std::string& caption)
        : whole_{0, 0, size.width, size.height},
          zoom_((kMapWidth + size.width - 1) / size.width),
          sheet_(
              make_sheet(2 * width() + 3 * kGap, (panels + 1) / 2 * row_height(), name, caption)) {}

    void draw(const std::string& title, const std::vector<std::uint8_t>& codes) {
        const int left = kGap + panel_ % 2 * (width() + kGap);
        const int top = sheet_.top + panel_ / 2 * row_height();
        draw_text(sheet_.canvas, left, top, 1, title);
        draw_region(sheet_.canvas, left, top + kSheetLine, zoom_,
                    {codes, whole_.width, whole_.height}, whole_);
        ++panel_;
    }
    Canvas finish() {
        draw_legend_bar(sheet_.canvas);
        return std::move(sheet_.canvas);
    }

 private:
    int width() const { return zoom_ * whole_.width; }
    int row_height() const { return kSheetLine + zoom_ * whole_.height + kGap; }

    Region whole_;
    int zoom_;
    Sheet sheet_;
    int panel_ = 0;
};

std::string told_text(const ReportRow& row) {
    if (!row.told) return "";
    return fmt::format(", tells {} {:.1e}",
                       row.told->kind == ErrorTold::bound ? "bound" : "standard error",
                       row.told->told);
}

}  // namespace

Canvas worst_pixel_sheet(const ReportRow& row, const ReportReferences::All& references,
                         const std::string& caption) {
    constexpr int kPanel = kZoom * kCrop;
    Sheet sheet = make_sheet(3 * kPanel + 4 * kGap, 3 * (kSheetLine + kPanel + kGap),
                             row.setting.name, caption);
    for (const Comparison& against : comparisons(row, references)) draw_worst(sheet, row, against);
    draw_legend_bar(sheet.canvas);
    return std::move(sheet.canvas);
}

Canvas error_map_sheet(const ReportRow& row, const ReportReferences::All& references,
                       const std::string& caption) {
    PanelSheet sheet(row.picture, 4, row.setting.name, caption);
    sheet.draw("picture", row.display);
    for (const auto& [name, reference, errors] : comparisons(row, references)) {
        const HdrMetrics& h = errors.hdr;
        sheet.draw(fmt::format("{}: max {:.1e} at {}, RMSE {:.1e}", name, h.relative.max,
                               pixel_text(h.relative), h.rmse),
                   error_codes(row, reference.picture));
    }
    return sheet.finish();
}

Canvas cut_off_sheet(const std::vector<ReportRow>& rows, const ComparedReference& unbounded,
                     const std::string& caption) {
    std::vector<const ReportRow*> shown;
    for (const ReportRow& row : rows) {
        if (compares_cut_offs(row.setting.axis)) shown.push_back(&row);
    }
    PanelSheet sheet(unbounded.picture.radiance, 2 * static_cast<int>(shown.size()),
                     "lights without a range: picture and error against R3", caption);
    for (const ReportRow* row : shown) {
        sheet.draw(row->setting.name, row->display);
        sheet.draw(fmt::format("{:.3g} ms, RMSE {:.1e}{}", row->speed.frame_ms.median,
                               row->unbounded.hdr.rmse, told_text(*row)),
                   error_codes(*row, unbounded.picture));
    }
    return sheet.finish();
}

}  // namespace kilolux
