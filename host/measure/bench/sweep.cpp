// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include "host/base/error.h"
#include "host/base/gbuffer_layout.h"
#include "host/base/text.h"
#include "host/measure/bench/renderer_names.h"
#include "kernels/shared/cluster_grid.h"

namespace kilolux {
namespace {

constexpr std::size_t kMostValues = 10000;

std::optional<std::uint64_t> count_of(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// A range's step: added, or multiplied by.
struct Step {
    std::uint64_t amount = 0;
    bool factor = false;

    // The value after `value`; none beyond `last`.
    std::optional<std::uint64_t> next(std::uint64_t value, std::uint64_t last) const {
        const bool beyond = factor ? value > last / amount : amount > last - value;
        if (beyond) return std::nullopt;
        return factor ? value * amount : value + amount;
    }
};

std::optional<Step> step_of(std::string_view text) {
    const bool factor = text.starts_with('*');
    const auto amount = count_of(factor ? text.substr(1) : text);
    if (!amount || *amount < (factor ? 2u : 1u)) return std::nullopt;
    return Step{*amount, factor};
}

// The values of one piece; empty: it is malformed.
std::vector<std::uint64_t> piece_values(std::string_view piece) {
    const auto parts = split(piece, ':');
    if (parts.size() == 1) {
        const auto value = count_of(parts[0]);
        return value ? std::vector{*value} : std::vector<std::uint64_t>{};
    }
    if (parts.size() != 3) return {};
    const auto first = count_of(parts[0]);
    const auto last = count_of(parts[1]);
    const auto step = step_of(parts[2]);
    if (!first || !last || !step || *first > *last || (step->factor && *first == 0)) return {};
    std::vector<std::uint64_t> values;
    std::optional<std::uint64_t> value = first;
    while (value && values.size() <= kMostValues) {
        values.push_back(*value);
        value = step->next(*value, *last);
    }
    return values;
}

}  // namespace

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
    cross(axes.group_heights, &SweepPoint::group_height, never);
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
    base.kernels.group_height = point.group_height;
    base.gbuffer = point.gbuffer;
    return base;
}

bool has_clusters(RendererKind renderer) {
    return renderer == RendererKind::deferred || renderer == RendererKind::forward_plus;
}

std::vector<std::pair<std::string, std::string>> fields_of(const SweepPoint& p) {
    const auto text = [](int value) { return value == 0 ? "auto" : fmt::to_string(value); };
    return {{"renderer", renderer_name(p.renderer)},
            {"resolution", fmt::format("{}x{}", p.resolution[0], p.resolution[1])},
            {"lights", fmt::to_string(p.lights)},
            {"grid", fmt::format("{}x{}x{}", p.grid[0], p.grid[1], p.grid[2])},
            {"lanes", text(p.lanes)},
            {"group height", text(p.group_height)},
            {"gbuffer", gbuffer_layout_name(p.gbuffer)}};
}

std::vector<std::string> varying_fields(const std::vector<SweepPoint>& points) {
    const auto fields = fields_of(SweepPoint{});
    std::vector<std::set<std::string>> seen(fields.size());
    for (const SweepPoint& point : points) {
        const auto texts = fields_of(point);
        for (std::size_t i = 0; i < texts.size(); ++i) seen[i].insert(texts[i].second);
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (seen[i].size() > 1) names.push_back(fields[i].first);
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
