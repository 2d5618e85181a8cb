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
    if (lights.profiles.lights) {
        check_size("light profiles", *lights.profiles.lights, rows * sizeof(AimedProfile),
                   std::to_string(rows) + " rows");
    }
}

}  // namespace kilolux
