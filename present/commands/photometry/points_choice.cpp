// SPDX-License-Identifier: Apache-2.0
#include "present/commands/photometry/points_choice.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "host/base/byte_order_mark.h"
#include "host/base/error.h"
#include "host/base/system/read_text.h"
#include "host/base/text.h"

namespace kilolux {
namespace {

constexpr double kMostPoints = 134217728.0;  // 2^27: 10 GB, of JSON a multiple
constexpr std::string_view kPointColumns = "x,y,z,nx,ny,nz";

[[noreturn]] void refuse_plane(const std::string& option, std::string_view text,
                               const std::string& why) {
    throw UsageError(fmt::format("{}: '{}' {}", option, text, why));
}

std::vector<double> plane_numbers(const std::string& option, std::string_view text) {
    std::vector<double> out;
    for (const std::string_view part : split(text, ',')) {
        const auto value = number_of<double>(trim(part));
        if (!value || !std::isfinite(*value)) {
            refuse_plane(option, text, fmt::format("has '{}', must be a finite number", part));
        }
        out.push_back(*value);
    }
    return out;
}

// False for what is not finite, too.
bool is_near_enough(const glm::dvec3& point) { return glm::length(point) < kFarthestPoint; }

std::string far_point(const glm::dvec3& p) {
    return fmt::format("has a point at {:g},{:g},{:g}, must be nearer than {:g} m to the origin",
                       p.x, p.y, p.z, kFarthestPoint);
}

// Whether a line has names of columns instead of a point.
bool are_names(std::string_view line) {
    const char first = lower(line.substr(0, 1))[0];
    const bool is_word = ('a' <= first && first <= 'z') || first == '"' || first == '_';
    return is_word && !number_of<double>(trim(split(line, ',')[0]));
}

// "x,y,nx" of "x [m], y [m], nx".
std::string names_without_units(std::string_view line) {
    std::vector<std::string> out;
    for (const std::string_view field : split(line, ',')) {
        const std::string_view name = trim(field);
        out.emplace_back(name.substr(0, name.find(' ')));
    }
    return joined(out, ",");
}

MeasuringPoint point_of_line(std::string_view line, const std::string& where) {
    const std::vector<std::string_view> fields = split(line, ',');
    if (fields.size() != 6) {
        throw Error(
            fmt::format("{}: has {} fields, must have 6: {}", where, fields.size(), kPointColumns));
    }
    const std::vector<std::string_view> names = split(kPointColumns, ',');
    double values[6] = {};
    for (std::size_t i = 0; i < 6; ++i) {
        const std::string_view field = trim(fields[i]);
        const auto value = number_of<double>(field.starts_with('+') ? field.substr(1) : field);
        if (!value || !std::isfinite(*value)) {
            throw Error(fmt::format("{}: {} is '{}', must be a finite number", where, names[i],
                                    field.substr(0, 40)));
        }
        values[i] = *value;
    }
    const glm::dvec3 position(values[0], values[1], values[2]);
    if (!is_near_enough(position)) throw Error(fmt::format("{}: {}", where, far_point(position)));
    const glm::dvec3 normal(values[3], values[4], values[5]);
    const double length = glm::length(normal);
    if (!(length > 0.0 && std::isfinite(length))) {
        throw Error(fmt::format("{}: the normal is {},{},{}, must have a direction", where,
                                normal.x, normal.y, normal.z));
    }
    return {position, normal / length};
}

}  // namespace

MeasuringGrid parse_plane(const std::string& option, std::string_view text) {
    const std::vector<double> n = plane_numbers(option, text);
    MeasuringGrid out;
    if (n.size() == 7) {
        if (!(n[0] < n[2] && n[1] < n[3])) {
            refuse_plane(option, text, "must have X0 < X1 and Z0 < Z1");
        }
        out = {{n[0], n[4], n[3]}, {n[2] - n[0], 0.0, 0.0}, {0.0, 0.0, n[1] - n[3]}};
    } else if (n.size() == 11) {
        out = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
    } else {
        refuse_plane(option, text,
                     fmt::format("has {} numbers, must have 7 or 11: {}", n.size(), kPlaneSyntax));
    }
    for (const glm::dvec3& corner :
         {out.origin, out.origin + out.u, out.origin + out.v, out.origin + out.u + out.v}) {
        if (!is_near_enough(corner)) refuse_plane(option, text, far_point(corner));
    }
    if (!(glm::length(glm::cross(out.u, out.v)) > 0.0)) {
        refuse_plane(option, text, "has edges in one line, so no normal");
    }
    for (const double count : {n[n.size() - 2], n.back()}) {
        if (count == std::floor(count) && count >= 1.0 && count <= kMostPoints) continue;
        refuse_plane(
            option, text,
            fmt::format("has {} points along an edge, must be a whole number from 1 on", count));
    }
    if (n[n.size() - 2] * n.back() > kMostPoints) {
        refuse_plane(option, text, fmt::format("has more than {} points", kMostPoints));
    }
    out.columns = static_cast<std::uint64_t>(n[n.size() - 2]);
    out.rows = static_cast<std::uint64_t>(n.back());
    return out;
}

std::string text_of(const MeasuringGrid& plane) {
    if (plane.columns == 0) return "";
    const auto& [o, u, v, columns, rows] = plane;
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{}", o.x, o.y, o.z, u.x, u.y, u.z, v.x, v.y,
                       v.z, columns, rows);
}

std::vector<MeasuringPoint> points_of(const MeasuringGrid& plane) {
    std::vector<MeasuringPoint> out;
    out.reserve(plane.columns * plane.rows);
    // + 0: no component is -0.
    const glm::dvec3 normal = glm::normalize(glm::cross(plane.u, plane.v)) + glm::dvec3(0.0);
    for (std::uint64_t row = 0; row < plane.rows; ++row) {
        const double t = (static_cast<double>(row) + 0.5) / static_cast<double>(plane.rows);
        for (std::uint64_t column = 0; column < plane.columns; ++column) {
            const double s =
                (static_cast<double>(column) + 0.5) / static_cast<double>(plane.columns);
            out.push_back({plane.origin + s * plane.u + t * plane.v, normal});
        }
    }
    return out;
}

std::vector<MeasuringPoint> read_points(const std::filesystem::path& file) {
    const std::string text = read_text(file);
    std::vector<MeasuringPoint> out;
    std::string_view left = without_byte_order_mark(text);
    bool is_first = true;
    for (std::size_t number = 1; !left.empty(); ++number) {
        const std::size_t end = std::min(left.find('\n'), left.size());
        const std::string_view line = trim(left.substr(0, end));
        left.remove_prefix(std::min(end + 1, left.size()));
        if (line.empty() || line.front() == '#') continue;
        const std::string where = fmt::format("{}: line {}", file.string(), number);
        if (!std::exchange(is_first, false) || !are_names(line)) {
            out.push_back(point_of_line(line, where));
        } else if (lower(names_without_units(line)) != kPointColumns) {
            throw Error(fmt::format("{}: the columns are '{}', must be {}", where,
                                    line.substr(0, 80), kPointColumns));
        }
    }
    if (out.empty()) throw Error(file.string() + ": has no points");
    return out;
}

}  // namespace kilolux
