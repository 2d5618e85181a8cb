// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_values.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/base/formats/color_text.h"
#include "host/base/formats/srgb.h"
#include "host/base/suggest.h"
#include "present/cli/sequence.h"

namespace kilolux {
namespace {

[[noreturn]] void refuse(const std::string& option, std::string_view text,
                         const std::string& wanted) {
    throw UsageError(fmt::format("{}: '{}' is not {}", option, text, wanted));
}

constexpr const char* kOrAuto[] = {"", "'auto' or "};

std::string range_text(const NumberRange& range) {
    const bool bounded_above = range.max < NumberRange{}.max;
    if (range.min == NumberRange{}.min && !bounded_above) return "a finite number";
    if (!bounded_above) {
        return fmt::format("a finite number {} {:g}", range.open ? "above" : "of at least",
                           range.min);
    }
    if (range.open) return fmt::format("a number between {:g} and {:g}", range.min, range.max);
    return fmt::format("a number from {:g} to {:g}", range.min, range.max);
}

std::string range_text(const CountRange& range) {
    return fmt::format("a whole number from {} to {}", range.min, range.max);
}

std::vector<double> parse_numbers(const std::string& option, std::string_view text,
                                  std::string_view form) {
    const auto wanted = split(form, ',').size();
    std::vector<double> values;
    for (const std::string_view part : split(text, ',')) {
        const auto value = signed_number_of<double>(part);
        if (!value || !std::isfinite(*value)) break;
        values.push_back(*value);
    }
    if (values.size() != wanted || split(text, ',').size() != wanted) {
        refuse(option, text, fmt::format("{} finite numbers {}", wanted, form));
    }
    return values;
}

// Two non-negative whole numbers around `separator`.
std::optional<std::pair<int, int>> int_pair(std::string_view text, char separator) {
    const auto parts = split(text, separator);
    if (parts.size() != 2) return std::nullopt;
    const auto first = signed_number_of<int>(parts[0]);
    const auto second = signed_number_of<int>(parts[1]);
    if (!first || !second || *first < 0 || *second < 0) return std::nullopt;
    return std::pair{*first, *second};
}

// "7", "A:B", "A-B" or "A-BxSTEP".
std::optional<FrameRange> frame_range(std::string_view text) {
    FrameRange out;
    const std::size_t step = text.find('x');
    if (step != std::string_view::npos) {
        const auto number = signed_number_of<int>(text.substr(step + 1));
        if (!number || *number < 1) return std::nullopt;
        out.step = *number;
        text = text.substr(0, step);
    } else if (const auto frame = signed_number_of<int>(text); frame && *frame >= 0) {
        return FrameRange{*frame, *frame};
    }
    const auto ends = int_pair(text, text.find(':') == std::string_view::npos ? '-' : ':');
    if (!ends || ends->first > ends->second) return std::nullopt;
    out.first = ends->first;
    out.last = ends->second - (ends->second - ends->first) % out.step;
    return out;
}

std::string text_of_range(const FrameRange& range) {
    if (range.size() == 1) return fmt::to_string(range.first);
    const std::string ends = fmt::format("{}-{}", range.first, range.last);
    return range.step == 1 ? ends : fmt::format("{}x{}", ends, range.step);
}

}  // namespace

bool contains(const NumberRange& range, double value) {
    if (!std::isfinite(value)) return false;
    return range.open ? value > range.min && value < range.max
                      : value >= range.min && value <= range.max;
}

bool contains(const CountRange& range, double value) {
    return value >= static_cast<double>(range.min) && value <= static_cast<double>(range.max);
}

double parse_number(const std::string& option, std::string_view text, const NumberRange& range,
                    bool or_auto) {
    if (or_auto && text == "auto") return 0.0;
    const auto value = signed_number_of<double>(text);
    if (!value || !contains(range, *value))
        refuse(option, text, kOrAuto[or_auto] + range_text(range));
    return *value;
}

std::uint64_t parse_count(const std::string& option, std::string_view text, const CountRange& range,
                          bool or_auto) {
    if (or_auto && text == "auto") return 0;
    const auto value = count_of(without_plus(text));
    if (!value || *value < range.min || *value > range.max)
        refuse(option, text, kOrAuto[or_auto] + range_text(range));
    return *value;
}

std::uint64_t parse_bytes(const std::string& option, std::string_view text) {
    constexpr std::string_view kUnits = "KMGT";
    if (text == "auto") return 0;
    std::string_view digits = text;
    const std::size_t unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
    if (unit != std::string_view::npos) digits.remove_suffix(1);
    const int shift = unit == std::string_view::npos ? 0 : 10 * (static_cast<int>(unit) + 1);
    const auto value = signed_number_of<std::uint64_t>(digits);
    if (!value || *value == 0 || *value > (~std::uint64_t{0} >> shift)) {
        refuse(option, text, "'auto' or a size such as 512M or 4G");
    }
    return *value << shift;
}

std::vector<int> parse_counts(const std::string& option, std::string_view text,
                              std::string_view form, const CountRange& range) {
    std::vector<int> values;
    const auto parts = split(text, ',');
    const std::size_t wanted = split(form, ',').size();
    for (const std::string_view part : parts) {
        const auto value = signed_number_of<std::uint64_t>(part);
        if (value && *value >= range.min && *value <= range.max)
            values.push_back(static_cast<int>(*value));
    }
    if (values.size() != wanted || parts.size() != wanted) {
        refuse(option, text, fmt::format("{}, each {}", form, range_text(range)));
    }
    return values;
}

BackgroundChoice parse_background(const std::string& option, std::string_view text) {
    using Kind = BackgroundChoice::Kind;
    if (text == "auto") return {};
    if (text == "none") return {Kind::none};
    if (const auto shown = hex_color(text)) return {Kind::color, *shown, true};
    if (const auto light = rgb_color(text)) return {Kind::color, *light};
    refuse(option, text,
           "'auto', 'none', or a colour: R,G,B as linear light, each at least 0, or #RRGGBB as "
           "the display shows it");
}

std::pair<int, int> parse_resolution(const std::string& option, std::string_view text) {
    const auto size = int_pair(text, text.find('x') == std::string_view::npos ? ',' : 'x');
    if (!size || !contains(kEdgeRange, size->first) || !contains(kEdgeRange, size->second)) {
        refuse(option, text, "W,H or WxH, each a whole number from 1 to 65536");
    }
    return *size;
}

std::array<int, 3> parse_grid(const std::string& option, std::string_view text) {
    const auto v = parse_counts(option, text, "X,Y,SLICES_PER_OCTAVE", kTilesRange);
    parse_count(option + ": slices per octave", text_of(v[2]), kSlicesRange);
    return {v[0], v[1], v[2]};
}

int parse_lanes(const std::string& option, std::string_view text) {
    const std::size_t place = parse_name(option, text, {"auto", "1", "2", "4", "8", "16"});
    return place == 0 ? 0 : 1 << (place - 1);
}

glm::dvec3 parse_vector(const std::string& option, std::string_view text) {
    const auto v = parse_numbers(option, text, "X,Y,Z");
    return {v[0], v[1], v[2]};
}

Box parse_box(const std::string& option, std::string_view text) {
    const auto v = parse_numbers(option, text, "x0,y0,z0,x1,y1,z1");
    const Box box{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (glm::any(glm::lessThan(box.max, box.min))) {
        refuse(option, text, "a box: x0 <= x1, y0 <= y1 and z0 <= z1 must hold");
    }
    return box;
}

FrameList parse_frames(const std::string& option, std::string_view text) {
    std::vector<FrameRange> ranges;
    for (const std::string_view part : split(text, ',')) {
        const auto range = frame_range(part);
        if (!range) {
            refuse(option, text,
                   "A:B, the first and the last frame, 0 <= A <= B, or a list of frames and of "
                   "ranges A-B and A-BxSTEP: 1-99x2,105");
        }
        ranges.push_back(*range);
    }
    try {
        return FrameList(std::move(ranges));
    } catch (const Error& error) {
        refuse(option, text, std::string("in ascending order: ") + error.what());
    }
}

PixelRect parse_crop(const std::string& option, std::string_view text) {
    constexpr CountRange kPlaces{0, 65536};
    const auto v = parse_counts(option, text, "X,Y,W,H", kPlaces);
    if (v[2] == 0 || v[3] == 0) refuse(option, text, "X,Y,W,H with W and H above 0");
    return {v[0], v[1], v[2], v[3]};
}

TileGrid parse_tiles(const std::string& option, std::string_view text) {
    constexpr int kMost = 256;
    const auto counts = int_pair(text, 'x');
    if (!counts || counts->first < 1 || counts->second < 1 || counts->first > kMost ||
        counts->second > kMost) {
        refuse(option, text, "CxR, columns and rows of tiles, each from 1 to 256");
    }
    return {counts->first, counts->second};
}

Shard parse_shard(const std::string& option, std::string_view text) {
    if (text == "auto") return shard_of_task(option);
    if (text.starts_with("auto/")) {
        const auto count = signed_number_of<int>(text.substr(5));
        if (count && *count > 0) return shard_of_task(option, *count);
    }
    const auto parts = int_pair(text, '/');
    if (!parts || parts->first >= parts->second) {
        refuse(option, text,
               "I/N, shard I of N, 0 <= I < N (the first of four is 0/4), nor auto or auto/N");
    }
    return {parts->first, parts->second};
}

std::size_t parse_name(const std::string& option, std::string_view text,
                       const std::vector<std::string>& names) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    throw UsageError(fmt::format("{}: '{}' is none of {}{}", option, text, joined(names),
                                 did_you_mean(text, names)));
}

std::vector<std::string> parse_name_list(const std::string& option, std::string_view text,
                                         const std::vector<std::string>& names) {
    std::vector<std::string> out;
    if (text.empty() || text == "none") return out;
    for (const std::string_view part : split(text, ',')) {
        const std::string& name = names[parse_name(option, part, names)];
        if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    }
    return out;
}

std::vector<std::string> parse_list(const std::string& option, std::string_view text) {
    std::vector<std::string> out;
    for (const std::string_view part : split(text, ',')) {
        if (trim(part).empty()) refuse(option, text, "a list of names, separated by commas");
        out.emplace_back(trim(part));
    }
    return out;
}

LineWidth parse_line_width(const std::string& option, std::string_view text) {
    const bool percent = text.ends_with('%');
    std::string_view number = text;
    if (percent) number.remove_suffix(1);
    const double value = signed_number_of<double>(number).value_or(0.0);
    if (!contains(kAboveZeroRange, value)) {
        refuse(option, text, "metres above 0, or a share of the scene's size such as 0.2%");
    }
    return {percent ? value / 100.0 : value, !percent};
}

std::string text_of(const LineWidth& width) {
    return width.metres ? text_of(width.value) : text_of(100.0 * width.value) + "%";
}
std::string text_of(const std::vector<std::string>& words) { return joined(words, ","); }
std::string text_of(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }
std::string text_of(const BackgroundChoice& choice) {
    using Kind = BackgroundChoice::Kind;
    if (choice.kind == Kind::environment) return "auto";
    if (choice.kind == Kind::none) return "none";
    if (!choice.as_shown) return text_of(glm::dvec3(choice.color));
    const auto code = [&choice](int channel) {
        return std::lround(255.0 * linear_to_srgb(choice.color[channel]));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", code(0), code(1), code(2));
}
std::string text_of(const FrameList& frames) {
    if (frames.ranges().size() == 1 && frames.ranges().front().step == 1)
        return fmt::format("{}:{}", frames.first(), frames.last());
    std::string out;
    for (const FrameRange& range : frames.ranges())
        out += (out.empty() ? "" : ",") + text_of_range(range);
    return out;
}
std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); }
std::string text_of(const PixelRect& rect) {
    return fmt::format("{},{},{},{}", rect.x, rect.y, rect.width, rect.height);
}
std::string text_of(const TileGrid& tiles) {
    return fmt::format("{}x{}", tiles.columns, tiles.rows);
}
std::string text_of(const Box& box) {
    return box.empty() ? "" : text_of(box.min) + "," + text_of(box.max);
}

}  // namespace kilolux
