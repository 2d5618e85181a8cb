// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <random>

#include "host/certify/synthetic/host_lists.h"
#include "host/stages/shading/shade.h"
#include "kernels/shared/gbuffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {

inline constexpr int kTriangles = 20;

/// A node whose children lie nowhere.
inline ShadowNode empty_node() {
    ShadowNode node{};
    for (int i = 0; i < SHADOW_WIDTH; ++i) {
        node.low_x[i] = node.low_y[i] = node.low_z[i] = SHADOW_NOWHERE;
        node.high_x[i] = node.high_y[i] = node.high_z[i] = -SHADOW_NOWHERE;
    }
    return node;
}

inline void set_child(ShadowNode& node, int i, uint child) {
    node.low_x[i] = node.low_y[i] = node.low_z[i] = -100.0f;
    node.high_x[i] = node.high_y[i] = node.high_z[i] = 100.0f;
    node.child[i] = child;
}

/// Buffers of zeros; a test replaces those that it needs.
inline ShadowCasters no_casters(const Gpu& gpu) {
    const std::vector<uint> none(64, 0);
    ShadowCasters out;
    out.nodes = new_buffer(gpu, none);
    out.triangles = new_buffer(gpu, none);
    out.masked = new_buffer(gpu, none);
    out.tinting = new_buffer(gpu, none);
    out.materials = new_buffer(gpu, none);
    out.textures = new_buffer(gpu, none);
    out.texels = new_buffer(gpu, none);
    return out;
}

/// Triangles before a camera that looks down -Z, below a root with two nodes.
inline ShadowCasters random_casters(const Gpu& gpu) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> across(-8.0f, 8.0f), depth(-40.0f, -3.0f);
    std::vector<float> triangles;
    for (int i = 0; i < kTriangles; ++i) {
        const float x = across(random), y = across(random), z = depth(random);
        for (int corner = 0; corner < 3; ++corner) {
            triangles.push_back(x + 0.5f * across(random));
            triangles.push_back(y + 0.5f * across(random));
            triangles.push_back(z + 0.5f * across(random));
        }
    }
    std::vector<ShadowNode> nodes(3, empty_node());
    set_child(nodes[0], 0, 1);
    set_child(nodes[0], 5, 2);
    for (int i = 0; i < kTriangles; ++i) {
        set_child(nodes[static_cast<std::size_t>(1 + i % 2)], i / 2,
                  SHADOW_LEAF | static_cast<uint>(i));
    }
    ShadowCasters out = no_casters(gpu);
    out.nodes = new_buffer(gpu, nodes);
    out.triangles = new_buffer(gpu, triangles);
    return out;
}

/// The surfaces' points themselves, a little before them.
inline DeviceArray<float> origins_of(const Gpu& gpu, const KernelFeatures& features,
                                     const GBuffer& gbuffer) {
    const std::vector<float> planes = decode(gpu, features, gbuffer).values;
    const std::size_t size = std::size_t{gbuffer.view.stride} * gbuffer.view.height;
    std::vector<float> origins(4 * size);
    for (std::size_t i = 0; i < size; ++i) {
        const auto at = [&](std::size_t plane) { return planes[plane * size + i]; };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origins[axis * size + i] =
                at(SURFACE_POSITION + axis) + 1e-3f * at(SURFACE_NORMAL + axis);
        }
        const FV3 code = octahedral_encode(
            fv3(at(SURFACE_NORMAL), at(SURFACE_NORMAL + 1), at(SURFACE_NORMAL + 2)));
        const auto x = static_cast<uint>(code.x * 32767.5f + 32767.5f);
        const auto y = static_cast<uint>(code.y * 32767.5f + 32767.5f);
        origins[3 * size + i] = std::bit_cast<float>(x | y << 16);
    }
    return new_buffer(gpu, origins);
}

inline ShadowView unmoved_view() {
    ShadowView view{};
    view.shadow_from_view[0] = {1, 0, 0, 0};
    view.shadow_from_view[1] = {0, 1, 0, 0};
    view.shadow_from_view[2] = {0, 0, 1, 0};
    view.extent = 100.0f;
    return view;
}

/// Overwrites the entries of `order` that bin_pixels leaves undefined in tiles that are partly
/// outside the picture.
inline void spoil_order(const Gpu& gpu, const View& view, const ActiveClusters& clusters) {
    std::vector<std::uint8_t> order = download(gpu, clusters.order);
    const uint tiles_x = fine_tiles_x(view);
    for (uint tile = 0; tile < clusters.tile_count; ++tile) {
        const uint rows = std::min<uint>(FINE_TILE, view.height - tile / tiles_x * FINE_TILE);
        for (uint i = rows * FINE_TILE; i < FINE_TILE_PIXELS; ++i) {
            order[tile * FINE_TILE_PIXELS + i] = 255;
        }
    }
    upload<std::uint8_t>(gpu, clusters.order, order);
}

}  // namespace kilolux
