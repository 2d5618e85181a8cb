// SPDX-License-Identifier: Apache-2.0
#include "host/base/formats/gbuffer_layout.h"

#include <algorithm>
#include <array>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"packed", "full", "half", "normal-xy",
                                                    "oct-2x4"};

bool is_material_plane(uint plane) {
    return plane == PLANE_MATERIAL || (plane >= PLANE_METALLIC && plane <= PLANE_EMISSIVE_B);
}

bool is_occlusion_plane(uint plane) {
    return plane == PLANE_OCCLUSION || plane == PLANE_OCCLUSION_F;
}

bool is_specular_plane(uint plane) {
    return plane >= PLANE_SPECULAR && plane <= PLANE_SPECULAR_F90;
}

bool has_plane(const GBufferNeeds& needs, uint plane) {
    if (is_material_plane(plane) && !needs.material) return false;
    if (is_occlusion_plane(plane) && !needs.occlusion) return false;
    if (is_specular_plane(plane) && !needs.specular) return false;
    return plane_element_bytes(needs.layout, plane) > 0;
}

// Bytes of the element of a plane of the float32 layout, by component.
uint float_plane_bytes(uint plane) {
    const bool specular = plane >= PLANE_SPECULAR_R && plane <= PLANE_SPECULAR_F90;
    return specular || (plane >= PLANE_POSITION_X && plane <= PLANE_OCCLUSION_F) ? 4 : 0;
}

uint packed_plane_bytes(uint plane) {
    if (plane == PLANE_OCCLUSION) return 1;
    return plane <= PLANE_MATERIAL || plane == PLANE_SPECULAR ? 4 : 0;
}

// rgba16f position and normal; albedo and the optional planes as in `packed`.
uint half_plane_bytes(uint plane) {
    if (plane >= PLANE_POSITION_X && plane <= PLANE_NORMAL_Z) return 2;
    return plane == PLANE_NORMAL ? 0 : packed_plane_bytes(plane);
}

// Two rows of four floats; the optional planes as in `packed`.
uint oct_2x4_plane_bytes(uint plane) {
    if (plane == PLANE_ROW_0 || plane == PLANE_ROW_1) return 16;
    const bool optional =
        plane == PLANE_MATERIAL || plane == PLANE_OCCLUSION || plane == PLANE_SPECULAR;
    return optional ? packed_plane_bytes(plane) : 0;
}

}  // namespace

uint plane_element_bytes(uint layout, uint plane) {
    if (plane == PLANE_DEPTH) return 4;
    switch (layout) {
        case GBUFFER_FULL:
            return float_plane_bytes(plane);
        case GBUFFER_HALF:
            return half_plane_bytes(plane);
        case GBUFFER_OCT_2X4:
            return oct_2x4_plane_bytes(plane);
        default:
            return packed_plane_bytes(plane);
    }
}

GBufferLayout make_gbuffer_layout(const GBufferNeeds& needs, uint stride, uint height) {
    GBufferLayout out{};
    out.layout = needs.layout;
    out.emissive_scale = needs.emissive_scale;
    std::size_t offset = 0;
    for (uint plane = 0; plane < PLANE_COUNT; ++plane) {
        out.offset_bytes[plane] = PLANE_ABSENT;
        if (!has_plane(needs, plane)) continue;
        const uint bytes = plane_element_bytes(needs.layout, plane);
        out.offset_bytes[plane] = static_cast<uint>(offset);
        out.bytes_per_pixel += bytes;
        offset += (std::size_t{bytes} * stride * height + 255) / 256 * 256;
        if (offset > 0xfffffff0u) {
            throw Error("G-buffer of " + std::to_string(stride) + "x" + std::to_string(height) +
                        " pixels needs more than 4 GiB; render a smaller resolution");
        }
    }
    return out;
}

std::size_t gbuffer_bytes(const GBufferLayout& layout, uint stride, uint height) {
    std::size_t end = 0;
    for (uint plane = 0; plane < PLANE_COUNT; ++plane) {
        if (layout.offset_bytes[plane] == PLANE_ABSENT) continue;
        const std::size_t bytes = plane_element_bytes(layout.layout, plane);
        const std::size_t size = (bytes * stride * height + 255) / 256 * 256;
        end = std::max(end, layout.offset_bytes[plane] + size);
    }
    return end;
}

std::string gbuffer_layout_name(uint layout) { return std::string(kNames.at(layout)); }

uint parse_gbuffer_layout(std::string_view name) {
    for (uint i = 0; i < kNames.size(); ++i) {
        if (kNames[i] == name) return i;
    }
    std::string names;
    for (const std::string_view known : kNames)
        names += (names.empty() ? "" : ", ") + std::string(known);
    throw UsageError("--gbuffer: '" + std::string(name) + "' is none of " + names);
}

}  // namespace kilolux
