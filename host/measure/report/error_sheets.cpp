// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/error_sheets.h"

#include <fmt/core.h>

#include "host/images/images.h"

namespace kilolux {
namespace {

constexpr int kMapWidth = 320;  // smaller error maps are magnified [pixel]
constexpr int kGap = 6;         // between panels
constexpr int kSheetLine = 14;  // of text [pixel]
constexpr int kLegend = 48;
constexpr HeatScale kScale = {.low = 1e-8, .high = 1.0, .logarithmic = true, .unit = {}};

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
        const int shift = decade == 0 ? text_mask(text, kSheetLine).width : 0;
        draw_text(canvas, kGap + x - shift, top + 12, kSheetLine, text);
    }
    draw_text(canvas, kGap, top + 26, kSheetLine,
              "relative error of the worst channel, NaN is green");
}

std::vector<std::uint8_t> error_codes(const ReportRow& row, const ReferencePicture& reference) {
    const auto errors = pixel_errors(row.picture, reference.radiance, &reference.scale);
    return heat_map(errors, row.picture.width, row.picture.height, kScale).rgba;
}

// Whole pictures of one size, two beside each other, below a title and above the legend.
class PanelSheet {
 public:
    PanelSheet(const RgbImage& size, int panels, const std::string& name,
               const std::string& caption)
        : size_(size), zoom_((kMapWidth + size.width - 1) / size.width) {
        const int sheet_width = 2 * width() + 3 * kGap;
        const auto columns = static_cast<std::size_t>(10 * (sheet_width - 2 * kGap) /
                                                      text_mask("0123456789", kSheetLine).width);
        std::vector<std::string> lines = wrapped(name, columns);
        for (std::string& line : wrapped(caption, columns)) lines.push_back(std::move(line));
        top_ = kGap + static_cast<int>(lines.size()) * kSheetLine;
        canvas_ = make_canvas(sheet_width, top_ + (panels + 1) / 2 * row_height() + kLegend);
        int y = kGap;
        for (const std::string& line : lines) {
            draw_text(canvas_, kGap, y, kSheetLine, line);
            y += kSheetLine;
        }
    }

    // Display codes, 4 per pixel.
    void draw(const std::string& title, const std::vector<std::uint8_t>& codes) {
        const int left = kGap + panel_ % 2 * (width() + kGap);
        const int top = top_ + panel_ / 2 * row_height();
        draw_text(canvas_, left, top, kSheetLine, title);
        for (int y = 0; y < zoom_ * size_.height; ++y) {
            for (int x = 0; x < width(); ++x) {
                const auto i = 4 * static_cast<std::size_t>(y / zoom_ * size_.width + x / zoom_);
                canvas_.set(left + x, top + kSheetLine + y, {codes[i], codes[i + 1], codes[i + 2]});
            }
        }
        ++panel_;
    }

    Canvas finish() {
        draw_legend_bar(canvas_);
        return std::move(canvas_);
    }

 private:
    int width() const { return zoom_ * size_.width; }
    int row_height() const { return kSheetLine + zoom_ * size_.height + kGap; }

    const RgbImage& size_;
    int zoom_;
    int top_ = 0;
    Canvas canvas_;
    int panel_ = 0;
};

std::string estimate_text(const ReportRow& row) {
    if (!row.estimate) return "";
    return fmt::format(", estimated {} {:.1e}",
                       row.estimate->kind == EstimateKind::bound ? "bound" : "standard error",
                       row.estimate->estimated);
}

}  // namespace

Canvas error_map_sheet(const ReportRow& row, const ReportReferences::All& references,
                       const std::string& caption) {
    PanelSheet sheet(row.picture, 4, row.setting.name, caption);
    sheet.draw("picture", row.display);
    const auto draw = [&](const char* name, const ComparedReference& reference,
                          const PictureErrors& errors) {
        const ErrorDistribution& worst = errors.hdr.relative;
        sheet.draw(fmt::format("{}: max {:.1e} at {}, RMSE {:.1e}", name, worst.max,
                               pixel_text(worst), errors.hdr.rmse),
                   error_codes(row, reference.picture));
    };
    draw("R1", references.kernels, row.kernels);
    draw("R2", references.surfaces, row.surfaces);
    draw("R3", references.unbounded, row.unbounded);
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
        sheet.draw(fmt::format("{:.3g} ms, RMSE {:.1e}{}", row->speed.frame_ms,
                               row->unbounded.hdr.rmse, estimate_text(*row)),
                   error_codes(*row, unbounded.picture));
    }
    return sheet.finish();
}

}  // namespace kilolux
