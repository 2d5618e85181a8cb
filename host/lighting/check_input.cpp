// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/check_input.h"

#include "host/base/error.h"
#include "host/base/formats/gbuffer_layout.h"
#include "host/gpu/program.h"

namespace kilolux {
namespace {

void check_size(const char* name, const cl::Buffer& buffer, std::uint64_t needed,
                const std::string& what) {
    if (needed == 0) return;
    const std::uint64_t bytes =
        buffer() == nullptr ? 0
                            : in_stage("lighting", [&] { return buffer.getInfo<CL_MEM_SIZE>(); });
    if (bytes >= needed) return;
    throw Error(std::string("lighting: ") + name + ": a buffer of " + std::to_string(bytes) +
                " bytes; " + what + " take " + std::to_string(needed));
}

}  // namespace

void check_input(const GBuffer& gbuffer) {
    const View& view = gbuffer.view;
    if (view.width > view.stride || view.stride % FINE_TILE != 0) {
        throw Error("lighting: G-buffer: width " + std::to_string(view.width) + ", stride " +
                    std::to_string(view.stride) + "; a stride is the width rounded up to " +
                    std::to_string(FINE_TILE));
    }
    check_size("G-buffer", gbuffer.bytes, gbuffer_bytes(gbuffer.layout, view.stride, view.height),
               "planes of " + std::to_string(view.stride) + " x " + std::to_string(view.height));
}

void check_input(const LightInput& lights) {
    const std::uint64_t rows = std::uint64_t{lights.count} + lights.node_count;
    check_size("lights", lights.lights, rows * sizeof(Light), std::to_string(rows) + " rows");
    check_size("directional lights", lights.directional,
               lights.directional_count * sizeof(DirectionalLight),
               std::to_string(lights.directional_count) + " rows");
    check_size("light tree", lights.nodes, lights.node_count * sizeof(TreeNode),
               std::to_string(lights.node_count) + " nodes");
    const auto check_extras = [&](const char* name, const auto& array) {
        if (!array) return;
        using Row = typename std::decay_t<decltype(*array)>::value_type;
        check_size(name, *array, rows * sizeof(Row), std::to_string(rows) + " rows");
    };
    check_extras("light profiles", lights.extras.profiles);
    check_extras("light shapes", lights.extras.shapes);
    if (lights.extras.groups) {
        check_size("light groups", *lights.extras.groups, rows + lights.directional_count,
                   std::to_string(rows) + " rows and directional lights");
    }
}

void check_input(const ClusterGrid& grid, const View& view) {
    const auto reaches = [](uint tiles, uint size, std::uint64_t pixels) {
        return size >= FINE_TILE && std::uint64_t{tiles} * size >= pixels;
    };
    const std::uint64_t columns = std::uint64_t{view.first_column} + view.width;
    // Layers may have rows without pixels below the grid.
    const std::uint64_t rows =
        std::uint64_t{view.first_row} + (view.layer_mask != 0 ? 1 : view.height);
    const std::uint64_t clusters = std::uint64_t{grid.tiles_x} * grid.tiles_y * grid.slices;
    const bool has_slices = grid.slices_per_octave > 0 && clusters == grid.cluster_count;
    if (has_slices && reaches(grid.tiles_x, grid.tile_width, columns) &&
        reaches(grid.tiles_y, grid.tile_height, rows))
        return;
    const auto product = [](std::uint64_t a, std::uint64_t b) {
        return std::to_string(a) + " x " + std::to_string(b);
    };
    throw Error("lighting: cluster grid: " + product(grid.tiles_x, grid.tiles_y) + " tiles of " +
                product(grid.tile_width, grid.tile_height) + " pixels in " +
                std::to_string(grid.slices) + " slices, " + std::to_string(grid.cluster_count) +
                " clusters; it does not hold a picture of " + product(columns, rows));
}

void check_input(const ShadowInput& shadows, const View& view) {
    check_size("shadow nodes", shadows.casters.nodes.buffer(), sizeof(ShadowNode),
               "a root and its boxes");
    const std::uint64_t pixels = std::uint64_t{view.stride} * view.height;
    check_size("shadow origins", shadows.origins.buffer(), 4 * pixels * sizeof(float),
               "4 planes of " + std::to_string(pixels) + " pixels");
}

}  // namespace kilolux
