// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/render/settings.h"

namespace kilolux {

/// Whole numbers of a sweep, in the order written, each once: a list of numbers "500", ranges
/// "500:5000:500" (from, to, step) and geometric ranges "256:8192:*2". `to` is included if a step
/// reaches it. Throws UsageError with `option` and the text for anything else, for more than 10000
/// values, or for a number outside [min, max].
std::vector<std::uint64_t> parse_count_sweep(const std::string& option, std::string_view text,
                                             std::uint64_t min, std::uint64_t max);

/// The name of a renderer on the command line and in files, and back; throws Error for an unknown
/// name.
std::string renderer_name(RendererKind renderer);
RendererKind renderer_of_name(std::string_view name);

/// What one measurement of a sweep varies.
struct SweepPoint {
    RendererKind renderer = RendererKind::deferred;
    std::array<int, 2> resolution = {1920, 1080};  // [pixel]
    std::uint64_t lights = 5000;                   // generated ones
    std::array<int, 3> grid = {16, 9, 4};          // tiles x, tiles y, slices per octave
    int lanes = 0;                                 // 0: the tuning's
    uint gbuffer = GBUFFER_PACKED;
    bool operator==(const SweepPoint&) const = default;
};

/// The values of each axis; none may be empty.
struct SweepAxes {
    std::vector<RendererKind> renderers = {SweepPoint{}.renderer};
    std::vector<std::array<int, 2>> resolutions = {SweepPoint{}.resolution};
    std::vector<std::uint64_t> lights = {SweepPoint{}.lights};
    std::vector<std::array<int, 3>> grids = {SweepPoint{}.grid};
    std::vector<int> lanes = {0};
    std::vector<uint> gbuffers = {GBUFFER_PACKED};
};

/// Every combination, renderers outermost. A renderer without clusters gets the first grid only.
std::vector<SweepPoint> sweep_points(const SweepAxes& axes);

/// `base` with the point's values.
RenderSettings settings_at(RenderSettings base, const SweepPoint& point);

/// Whether a renderer finds each pixel's lights by clusters; else it evaluates all of them.
bool has_clusters(RendererKind renderer);

/// Names and texts of a point's fields: renderer, resolution, lights, grid, lanes, gbuffer.
using SweepFields = std::vector<std::pair<std::string, std::string>>;
SweepFields fields_of(const SweepPoint& point);

/// The fields with their texts: "renderer deferred, resolution 1920x1080, ...".
std::string point_text(const SweepPoint& point);

/// The text of one field.
std::string field_text(const SweepPoint& point, const std::string& field);

/// Names of the fields in which the points differ, in fields_of()'s order.
std::vector<std::string> varying_fields(const std::vector<SweepPoint>& points);

/// Why the grid of a frame is not the one asked for; empty if it is.
std::string grid_explanation(const SweepPoint& asked, const std::array<std::uint32_t, 3>& grid);

}  // namespace kilolux
