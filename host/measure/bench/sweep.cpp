// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/sweep.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/formats/gbuffer_layout.h"
#include "host/base/text.h"
#include "kernels/shared/cluster_grid.h"

namespace kilolux {
namespace {

constexpr std::size_t kMostValues = 10000;
constexpr std::string_view kRendererNames[] = {"deferred", "forward-plus", "forward",
                                               "deferred-all"};

// The values of one piece; empty: it is malformed.
std::vector<std::uint64_t> piece_values(std::string_view piece) {
    const auto parts = split(piece, ':');
    const auto first = count_of(parts[0]);
    if (!first || (parts.size() != 1 && parts.size() != 3)) return {};
    std::vector<std::uint64_t> values = {*first};
    if (parts.size() == 1) return values;
    const bool geometric = parts[2].starts_with('*');
    const auto last = count_of(parts[1]);
    const auto step = count_of(parts[2].substr(geometric ? 1 : 0));
    if (!last || !step || *first > *last || *step < (geometric ? 2u : 1u)) return {};
    if (geometric && *first == 0) return {};
    // The next value itself may be beyond 2^64.
    const auto has_next = [&](std::uint64_t value) {
        return geometric ? value <= *last / *step : *step <= *last - value;
    };
    while (values.size() <= kMostValues && has_next(values.back())) {
        values.push_back(geometric ? values.back() * *step : values.back() + *step);
    }
    return values;
}

}  // namespace

std::string renderer_name(RendererKind renderer) {
    return std::string(kRendererNames[static_cast<std::size_t>(renderer)]);
}

RendererKind renderer_of_name(std::string_view name) {
    const auto* found = std::ranges::find(kRendererNames, name);
    if (found == std::end(kRendererNames)) throw Error(fmt::format("'{}' is no renderer", name));
    return static_cast<RendererKind>(found - std::begin(kRendererNames));
}

std::vector<std::uint64_t> parse_count_sweep(const std::string& option, std::string_view text,
                                             std::uint64_t min, std::uint64_t max) {
    const std::string seen = fmt::format("{}: '{}' ", option, text);
    std::vector<std::uint64_t> values;
    for (const std::string_view piece : split(text, ',')) {
        const auto found = piece_values(piece);
        if (found.empty()) {
            throw UsageError(seen +
                             "is no list of whole numbers N, ranges FROM:TO:STEP and "
                             "FROM:TO:*FACTOR, FROM <= TO");
        }
        for (const std::uint64_t value : found) {
            if (value < min || value > max) {
                throw UsageError(
                    fmt::format("{}has {}, must be from {} to {}", seen, value, min, max));
            }
            if (std::find(values.begin(), values.end(), value) == values.end()) {
                values.push_back(value);
            }
        }
        if (values.size() > kMostValues) {
            throw UsageError(fmt::format("{}has more than {} values", seen, kMostValues));
        }
    }
    return values;
}

std::vector<SweepPoint> sweep_points(const SweepAxes& axes) {
    std::vector<SweepPoint> points = {SweepPoint{}};
    // Each axis multiplies the points so far by its values.
    const auto cross = [&points](const auto& values, auto field, const auto& skip) {
        std::vector<SweepPoint> more;
        for (const SweepPoint& point : points) {
            for (const auto& value : values) {
                if (skip(point) && value != values.front()) continue;
                more.push_back(point);
                more.back().*field = value;
            }
        }
        points = std::move(more);
    };
    const auto never = [](const SweepPoint&) { return false; };
    cross(axes.renderers, &SweepPoint::renderer, never);
    cross(axes.gbuffers, &SweepPoint::gbuffer, never);
    cross(axes.resolutions, &SweepPoint::resolution, never);
    cross(axes.grids, &SweepPoint::grid,
          [](const SweepPoint& point) { return !has_clusters(point.renderer); });
    cross(axes.lanes, &SweepPoint::lanes, never);
    cross(axes.lights, &SweepPoint::lights, never);
    return points;
}

RenderSettings settings_at(RenderSettings base, const SweepPoint& point) {
    base.renderer = point.renderer;
    base.width = point.resolution[0];
    base.height = point.resolution[1];
    base.lights.count = point.lights;
    base.grid.tiles_x = point.grid[0];
    base.grid.tiles_y = point.grid[1];
    base.grid.slices_per_octave = point.grid[2];
    base.kernels.lanes = point.lanes;
    base.gbuffer = point.gbuffer;
    return base;
}

bool has_clusters(RendererKind renderer) {
    return renderer == RendererKind::deferred || renderer == RendererKind::forward_plus;
}

SweepFields fields_of(const SweepPoint& p) {
    const auto text = [](int value) { return value == 0 ? "auto" : fmt::to_string(value); };
    return {{"renderer", renderer_name(p.renderer)},
            {"resolution", fmt::format("{}x{}", p.resolution[0], p.resolution[1])},
            {"lights", fmt::to_string(p.lights)},
            {"grid", fmt::format("{}x{}x{}", p.grid[0], p.grid[1], p.grid[2])},
            {"lanes", text(p.lanes)},
            {"gbuffer", gbuffer_layout_name(p.gbuffer)}};
}

std::string point_text(const SweepPoint& point) {
    std::vector<std::string> parts;
    for (const auto& [field, text] : fields_of(point)) parts.push_back(field + " " + text);
    return joined(parts);
}

std::string field_text(const SweepPoint& point, const std::string& field) {
    const SweepFields fields = fields_of(point);
    return std::ranges::find(fields, field, &SweepFields::value_type::first)->second;
}

std::vector<std::string> varying_fields(const std::vector<SweepPoint>& points) {
    std::vector<std::string> names;
    for (const auto& [name, text] : fields_of(SweepPoint{})) {
        const auto differs = [&points, field = name](const SweepPoint& point) {
            return field_text(point, field) != field_text(points.front(), field);
        };
        if (std::ranges::any_of(points, differs)) names.push_back(name);
    }
    return names;
}

std::string grid_explanation(const SweepPoint& asked, const std::array<std::uint32_t, 3>& grid) {
    const auto& [tiles_x, tiles_y, slices] = asked.grid;
    if (grid[0] == 0) return "";
    return fmt::format(
        "grid {},{},{} of {}x{} pixels is {}x{}x{} clusters: tile edges are multiples of {} "
        "pixels, and the depth has {} slices at {} for each doubling",
        tiles_x, tiles_y, slices, asked.resolution[0], asked.resolution[1], grid[0], grid[1],
        grid[2], FINE_TILE, grid[2], slices);
}

}  // namespace kilolux
