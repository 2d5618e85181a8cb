// SPDX-License-Identifier: Apache-2.0
// Coarse lists against the exact overlap of spheres and cells of the frustum, in float64.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host/certify/cases.h"

namespace kilolux {
namespace {

struct Plane {
    glm::dvec3 normal;  // unit, outwards
    double offset;
};

// The planes of a cluster: four sides through the camera, two ends. Not of the first slice, which
// begins at the camera, nor of the last, which has no end.
using ClusterPlanes = std::array<Plane, 6>;

Plane side(glm::dvec3 a, glm::dvec3 b, glm::dvec3 inside) {
    const glm::dvec3 n = glm::normalize(glm::cross(a, b));
    return {glm::dot(n, inside) > 0 ? -n : n, 0.0};
}

ClusterPlanes planes_of_cluster(const View& view, const ClusterGrid& grid, uint column, uint row,
                                uint slice) {
    const auto ray = [&](double px, double py) { return position_at(view, px, py, 1.0); };
    const double x0 = column * grid.tile_width;
    const double x1 = x0 + grid.tile_width;
    const double y0 = row * grid.tile_height;
    const double y1 = y0 + grid.tile_height;
    const glm::dvec3 inside = ray((x0 + x1) / 2, (y0 + y1) / 2);
    return {side(ray(x0, y0), ray(x0, y1), inside),
            side(ray(x1, y0), ray(x1, y1), inside),
            side(ray(x0, y0), ray(x1, y0), inside),
            side(ray(x0, y1), ray(x1, y1), inside),
            Plane{{0, 0, 1}, -depth_of_slice(grid, slice)},
            Plane{{0, 0, -1}, depth_of_slice(grid, slice + 1)}};
}

bool is_inside(const ClusterPlanes& cell, glm::dvec3 p, double slack) {
    return std::all_of(cell.begin(), cell.end(), [&](const Plane& plane) {
        return dot(plane.normal, p) - plane.offset <= slack;
    });
}

glm::dvec3 on_plane(const Plane& a, glm::dvec3 p) {
    return p - a.normal * (dot(a.normal, p) - a.offset);
}

// The point nearest to p on the line where two planes meet; none if they are parallel.
std::optional<glm::dvec3> on_line(const Plane& a, const Plane& b, glm::dvec3 p) {
    const double c = dot(a.normal, b.normal);
    const double det = 1.0 - c * c;
    if (det < 1e-12) return std::nullopt;
    const double da = dot(a.normal, p) - a.offset;
    const double db = dot(b.normal, p) - b.offset;
    return p - a.normal * ((da - c * db) / det) - b.normal * ((db - c * da) / det);
}

std::optional<glm::dvec3> corner(const Plane& a, const Plane& b, const Plane& c) {
    const glm::dvec3 bc = cross(b.normal, c.normal);
    const double det = dot(a.normal, bc);
    if (std::abs(det) < 1e-12) return std::nullopt;
    return (bc * a.offset + cross(c.normal, a.normal) * b.offset +
            cross(a.normal, b.normal) * c.offset) *
           (1.0 / det);
}

// Distance of p to the cell. The nearest point is the projection of p on a face, edge or corner, so
// it is the nearest of those projections that lie in the cell.
double distance_to(const ClusterPlanes& cell, glm::dvec3 p) {
    const double slack = 1e-9 * (1.0 + length(p));
    if (is_inside(cell, p, 0.0)) return 0.0;
    double least = 1e300;
    const auto consider = [&](const std::optional<glm::dvec3>& q) {
        if (q && is_inside(cell, *q, slack)) least = std::min(least, length(*q - p));
    };
    for (std::size_t a = 0; a < 6; ++a) {
        consider(on_plane(cell[a], p));
        for (std::size_t b = a + 1; b < 6; ++b) {
            consider(on_line(cell[a], cell[b], p));
            for (std::size_t c = b + 1; c < 6; ++c) consider(corner(cell[a], cell[b], cell[c]));
        }
    }
    return least;
}

// The size of a cell: the longer of its depth and its width at the far end.
double size_of(const View& view, const ClusterGrid& grid, uint slice) {
    const double near = depth_of_slice(grid, slice);
    const double far = depth_of_slice(grid, slice + 1);
    return std::max({far - near, far * grid.tile_width * std::abs(view.ray.x),
                     far * grid.tile_height * std::abs(view.ray.z)});
}

struct Overlap {
    std::uint64_t missed = 0, pairs = 0;
    std::uint64_t listed_large = 0, true_large = 0;  // spheres at least as large as the cell
    std::uint64_t listed_small = 0, true_small = 0;
};

struct CoarseResult {
    ClusterGrid grid{};
    HostLists lists;
    std::vector<ShadeLight> lights;  // view space
};

void count_cell(Overlap& sum, const LightingCase& input, const CoarseResult& result, uint index) {
    const ClusterGrid& grid = result.grid;
    const uint slice = index / grid.tiles_x / grid.tiles_y;
    const ClusterPlanes cell = planes_of_cluster(input.image.view, grid, index % grid.tiles_x,
                                                 index / grid.tiles_x % grid.tiles_y, slice);
    const double size = size_of(input.image.view, grid, slice);
    const auto list = result.lists.coarse_of(index);
    for (uint light = 0; light < input.lights.size(); ++light) {
        const glm::dvec3 center = xyz(result.lights[light].position_inv_range2);
        const double range = input.lights[light].position_range.w;
        const bool touches = distance_to(cell, center) < range;
        const bool listed = std::binary_search(list.begin(), list.end(), light);
        ++sum.pairs;
        sum.missed += touches && !listed ? 1 : 0;
        (range >= size ? sum.true_large : sum.true_small) += touches ? 1 : 0;
        (range >= size ? sum.listed_large : sum.listed_small) += listed ? 1 : 0;
    }
}

}  // namespace

void try_false_positives(const Gpu& gpu, Findings& findings) {
    LightingCase input = noise_case(square_pixels(160, 96), noise_depth(0.5, 50.0, 0, 4));
    input.request = {10, 6, 4, 0.5f, 50.0f, 0.0f};
    input.lights = random_lights(
        input.image.view, {.count = 160, .range_min = 0.1, .range_max = 10.0, .spread = 1.0});
    // Every cell is checked, also those without pixels, which blended surfaces read.
    const ListedLights lists =
        list_everywhere(gpu, default_tuning(gpu.info), input.features, upload(gpu, input));
    const CoarseResult result{lists.grid, download_lists(gpu, input.features, lists),
                              download<ShadeLight>(gpu, lists.lights.lights, input.lights.size())};
    Overlap sum;
    const uint cells = result.grid.tiles_x * result.grid.tiles_y;
    for (uint index = cells; index < result.grid.cluster_count - cells; ++index) {
        count_cell(sum, input, result, index);
    }
    findings.none("missed by float64 overlap", sum.missed, sum.pairs);
    findings.at_least("overlaps", sum.true_large + sum.true_small, 5000);
    const auto ratio = [](std::uint64_t a, std::uint64_t b) {
        return static_cast<double>(a) / static_cast<double>(b);
    };
    findings.at_most("listed / overlapping, r >= cell", ratio(sum.listed_large, sum.true_large),
                     1.3);
    findings.report("listed / overlapping, r < cell", ratio(sum.listed_small, sum.true_small));
}

}  // namespace kilolux
