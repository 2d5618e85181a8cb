// SPDX-License-Identifier: Apache-2.0
// Prints host/measure/reference/area/ggx_area_error.md: the program `ggx_area_error`, built on
// demand.
#include <cstdio>

#include "tests/measure/area/fit/error_table.h"

namespace kilolux {
namespace {

constexpr std::size_t kRows = kTableRoughness.size() * kTableCosines.size();

// [kRows][sizes], rows by roughness, then n.v.
using Cells = std::vector<std::array<CellErrors, kTableSizes.size()>>;

Cells all_cells(AreaKind kind) {
    Cells cells(kRows);
    for (std::size_t row = 0; row < kRows; ++row) {
        for (std::size_t s = 0; s < kTableSizes.size(); ++s) {
            const std::size_t r = row / kTableCosines.size(), v = row % kTableCosines.size();
            const RoundLobe lobe = table_lobe(kTableRoughness[r], kTableCosines[v]);
            cells[row][s] = cell_errors(kind, lobe, kTableSizes[s], cell_number(r, v, s));
        }
    }
    return cells;
}

void print_head(const char* title, const char* columns, const char* line) {
    std::printf("\n## %s\n\n%s", title, columns);
    for (const double size : kTableSizes) std::printf(" %g |", size);
    std::printf("\n%s", line);
    for (std::size_t i = 0; i < kTableSizes.size(); ++i) std::printf("---|");
    std::printf("\n");
}

void print_table(const char* title, const Cells& cells, AreaError CellErrors::*error) {
    print_head(title, "| roughness | n.v |", "|---|---|");
    for (std::size_t row = 0; row < kRows; ++row) {
        std::printf("| %g | %g |", kTableRoughness[row / kTableCosines.size()],
                    kTableCosines[row % kTableCosines.size()]);
        for (const CellErrors& cell : cells[row]) {
            std::printf(" %s |", percent_pair(cell.*error).c_str());
        }
        std::printf("\n");
    }
}

void print_means(const char* name, const Cells& cells) {
    std::printf("| %s |", name);
    for (std::size_t s = 0; s < kTableSizes.size(); ++s) {
        double of_itself = 0.0, of_even = 0.0;
        for (const auto& row : cells) {
            of_itself += row[s].of_itself.mean / kRows;
            of_even += row[s].of_even.mean / kRows;
        }
        std::printf(" %.1f, %.1f |", 100.0 * of_itself, 100.0 * of_even);
    }
    std::printf("\n");
}

void print_all() {
    std::printf(
        "# Errors of the specular light of area lights\n\n"
        "GGX light of f0 = 0.04 by `kernels/shared/area/ggx_area.h` against float64 integrals of "
        "the BRDF.\nColumns: width of the light over its distance; the solid angle is about its "
        "square below 1.\nEach cell: mean / largest error [%%] of %d lights of random outline and "
        "tilt. A sixth is centred at\nthe mirror direction, a sixth within 1.5 rad of it, the "
        "others "
        "within three times the width of\nlobe and light. Lights may be cut by the horizon. The "
        "program is `ggx_area_error`\n(tests/measure/area/fit); tests/measure/area/"
        "ggx_area_test.cpp compares.\n",
        kTableLights);
    const Cells rectangles = all_cells(AreaKind::rectangle);
    print_table(kOfItself, rectangles, &CellErrors::of_itself);
    print_table("Rectangles: relative to the light plus that of a diffuse surface of the albedo",
                rectangles, &CellErrors::of_even);
    print_head("Means of all cells, by shape", "| shape |", "|---|");
    print_means("rectangle", rectangles);
    print_means("disk", all_cells(AreaKind::disk));
    print_means("sphere", all_cells(AreaKind::sphere));
    print_means("triangle", all_cells(AreaKind::triangle));
    std::printf(
        "\nBoth errors [%%]: relative to the light itself, and to that plus the diffuse "
        "light.\n");
}

}  // namespace
}  // namespace kilolux

int main() { kilolux::print_all(); }
