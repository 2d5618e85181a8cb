// SPDX-License-Identifier: Apache-2.0
#include "host/base/formats/gbuffer_layout.h"

#include <algorithm>
#include <array>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"packed", "full", "half", "normal-xy",
                                                    "oct-2x4"};

using N = GBufferNeeds;

// The planes after the former row's up to `last`, with elements of the same size.
struct PlaneRow {
    uint last;                   // PLANE_*
    std::array<uint, 5> bytes;   // of an element by layout; 0: the layout has none
    bool N::*feature = nullptr;  // without which they are left out
};

constexpr PlaneRow kPlanes[] = {
    // packed, full, half, normal-xy, oct-2x4
    {PLANE_DEPTH, {4, 4, 4, 4, 4}},
    {PLANE_NORMAL, {4, 0, 0, 4, 0}},
    {PLANE_ALBEDO, {4, 0, 4, 4, 0}},
    {PLANE_MATERIAL, {4, 0, 4, 4, 4}, &N::material},
    {PLANE_OCCLUSION, {1, 0, 1, 1, 1}, &N::occlusion},
    {PLANE_NORMAL_Z, {0, 4, 2, 0, 0}},
    {PLANE_ROUGHNESS, {0, 4, 0, 0, 0}},
    {PLANE_EMISSIVE_B, {0, 4, 0, 0, 0}, &N::material},
    {PLANE_OCCLUSION_F, {0, 4, 0, 0, 0}, &N::occlusion},
    {PLANE_ROW_1, {0, 0, 0, 0, 16}},
    {PLANE_SPECULAR, {4, 0, 4, 4, 4}, &N::specular},
    {PLANE_SPECULAR_F90, {0, 4, 0, 0, 0}, &N::specular},
    {PLANE_COAT, {4, 0, 4, 4, 4}, &N::clearcoat},
    {PLANE_COAT_NORMAL, {4, 0, 4, 4, 4}, &N::coat_normals},
    {PLANE_COAT_ROUGHNESS, {0, 4, 0, 0, 0}, &N::clearcoat},
    {PLANE_COAT_NORMAL_Z, {0, 4, 0, 0, 0}, &N::coat_normals},
    {PLANE_SHEEN, {4, 0, 4, 4, 4}, &N::sheen},
    {PLANE_SHEEN_ROUGHNESS, {0, 4, 0, 0, 0}, &N::sheen},
    {PLANE_ANISOTROPY, {4, 0, 4, 4, 4}, &N::anisotropy},
    {PLANE_ANISOTROPY_F, {0, 4, 0, 0, 0}, &N::anisotropy},
    {PLANE_TRANSMISSION, {4, 0, 4, 4, 4}, &N::transmission},
    {PLANE_TRANSMISSION_F, {0, 4, 0, 0, 0}, &N::transmission},
};

static_assert(std::ranges::is_sorted(kPlanes, {}, &PlaneRow::last) &&
              std::end(kPlanes)[-1].last == PLANE_COUNT - 1);  // for row_of()

const PlaneRow& row_of(uint plane) {
    return *std::ranges::find_if(kPlanes, [&](const PlaneRow& row) { return plane <= row.last; });
}

bool has_plane(const GBufferNeeds& needs, uint plane) {
    const auto feature = row_of(plane).feature;
    return (!feature || needs.*feature) && plane_element_bytes(needs.layout, plane) > 0;
}

}  // namespace

uint plane_element_bytes(uint layout, uint plane) { return row_of(plane).bytes.at(layout); }

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

GBufferLayout full_gbuffer_layout(const SceneFeatures& features, uint stride, uint height) {
    GBufferNeeds needs;
    static_cast<SceneFeatures&>(needs) = features;
    needs.layout = GBUFFER_FULL;
    return make_gbuffer_layout(needs, stride, height);
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
