// SPDX-License-Identifier: Apache-2.0
// Sizes and offsets of every shared struct: the device's own answer against C++.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <string>

#include "host/base/source.h"
#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "host/gpu/flow.h"
#include "kernels/shared/lights/light_drift.h"
#include "kernels/shared/surface_scene.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Measure {
    std::string expression;  // in OpenCL C
    std::size_t expected;
};

#define SIZE_OF(Type) \
    Measure { "sizeof(" #Type ")", sizeof(Type) }
#define OFFSET_OF(Type, member) \
    Measure { "OFFSET_OF(" #Type ", " #member ")", offsetof(Type, member) }

std::vector<Measure> light_measures() {
    return {SIZE_OF(Light),
            OFFSET_OF(Light, position_range),
            OFFSET_OF(Light, color_scale),
            OFFSET_OF(Light, axis_cos),
            SIZE_OF(ShadeLight),
            OFFSET_OF(ShadeLight, position_inv_range2),
            OFFSET_OF(ShadeLight, color_scale),
            OFFSET_OF(ShadeLight, axis_cos),
            SIZE_OF(DirectionalLight),
            OFFSET_OF(DirectionalLight, to_light),
            OFFSET_OF(DirectionalLight, color),
            SIZE_OF(AimedProfile),
            OFFSET_OF(AimedProfile, side)};
}

std::vector<Measure> surface_measures() {
    return {SIZE_OF(WorldLight),
            OFFSET_OF(WorldLight, light),
            OFFSET_OF(WorldLight, position_low),
            SIZE_OF(LightDrift),
            OFFSET_OF(LightDrift, rate_low),
            SIZE_OF(DriftBox),
            OFFSET_OF(DriftBox, rate_low),
            SIZE_OF(LightSwarm),
            OFFSET_OF(LightSwarm, intensity),
            OFFSET_OF(LightSwarm, gain),
            OFFSET_OF(LightSwarm, boxes),
            SIZE_OF(DriftTime),
            OFFSET_OF(DriftTime, rest_high),
            SIZE_OF(RasterRow),
            OFFSET_OF(RasterRow, plane),
            OFFSET_OF(RasterRow, columns),
            SIZE_OF(MeshRow),
            OFFSET_OF(MeshRow, material),
            OFFSET_OF(MeshRow, color),
            SIZE_OF(InstanceRow),
            OFFSET_OF(InstanceRow, normal_from_object),
            OFFSET_OF(InstanceRow, eye_high),
            OFFSET_OF(InstanceRow, first_triangle),
            OFFSET_OF(InstanceRow, is_similarity),
            SIZE_OF(SurfaceMaterial),
            OFFSET_OF(SurfaceMaterial, textures),
            OFFSET_OF(SurfaceMaterial, flags),
            OFFSET_OF(SurfaceMaterial, lookup_use),
            SIZE_OF(TextureRow),
            OFFSET_OF(TextureRow, filters),
            OFFSET_OF(TextureRow, first_texel),
            OFFSET_OF(TextureRow, level_offset)};
}

std::vector<Measure> view_measures() {
    return {SIZE_OF(View),
            OFFSET_OF(View, ray),
            OFFSET_OF(View, depth),
            OFFSET_OF(View, width),
            OFFSET_OF(View, height),
            OFFSET_OF(View, stride),
            OFFSET_OF(View, orthographic),
            OFFSET_OF(View, view_from_world_x),
            OFFSET_OF(View, view_from_world_y),
            OFFSET_OF(View, view_from_world_z),
            OFFSET_OF(View, camera_position),
            OFFSET_OF(View, first_row),
            SIZE_OF(GBufferLayout),
            OFFSET_OF(GBufferLayout, offset_bytes),
            OFFSET_OF(GBufferLayout, layout),
            OFFSET_OF(GBufferLayout, emissive_scale),
            OFFSET_OF(GBufferLayout, bytes_per_pixel)};
}

std::vector<Measure> cluster_measures() {
    return {SIZE_OF(ClusterGrid),
            OFFSET_OF(ClusterGrid, tiles_x),
            OFFSET_OF(ClusterGrid, tiles_y),
            OFFSET_OF(ClusterGrid, slices),
            OFFSET_OF(ClusterGrid, slices_per_octave),
            OFFSET_OF(ClusterGrid, tile_width),
            OFFSET_OF(ClusterGrid, tile_height),
            OFFSET_OF(ClusterGrid, z_first_bits),
            OFFSET_OF(ClusterGrid, cluster_count),
            OFFSET_OF(ClusterGrid, position_pad),
            SIZE_OF(LightExtent),
            OFFSET_OF(LightExtent, slices),
            OFFSET_OF(LightExtent, columns),
            OFFSET_OF(LightExtent, rows),
            SIZE_OF(ActiveCluster),
            OFFSET_OF(ActiveCluster, min_x),
            OFFSET_OF(ActiveCluster, min_y),
            OFFSET_OF(ActiveCluster, min_z),
            OFFSET_OF(ActiveCluster, slice),
            OFFSET_OF(ActiveCluster, max_x),
            OFFSET_OF(ActiveCluster, max_y),
            OFFSET_OF(ActiveCluster, max_z),
            OFFSET_OF(ActiveCluster, pixel_count),
            OFFSET_OF(ActiveCluster, list_begin),
            OFFSET_OF(ActiveCluster, list_count)};
}

constexpr std::string_view kLayoutHeaders[] = {
    "kernels/shared/light_profile.h", "kernels/shared/cluster_grid.h",
    "kernels/shared/clusters.h",      "kernels/shared/gbuffer.h",
    "kernels/shared/light.h",         "kernels/shared/lights/light_drift.h",
    "kernels/shared/surface_scene.h", "kernels/shared/view.h"};

void expect_equal(const std::vector<Measure>& measures) {
    const Gpu gpu = test_gpu();
    std::string text =
        "#define OFFSET_OF(Type, member) ((size_t)((uintptr_t)&((Type*)0)->member))\n"
        "kernel void probe(global uint* out) {\n";
    for (std::size_t i = 0; i < measures.size(); ++i) {
        text += "    out[" + std::to_string(i) + "] = (uint)" + measures[i].expression + ";\n";
    }
    text += "}\n";
    const auto found = run_probe<uint>(gpu, {kLayoutHeaders, text}, 1, measures.size());
    for (std::size_t i = 0; i < measures.size(); ++i) {
        EXPECT_EQ(found[i], measures[i].expected) << measures[i].expression;
    }
}

TEST(Layout, LightsAgreeWithTheDevice) { expect_equal(light_measures()); }

TEST(Layout, SurfacesAgreeWithTheDevice) { expect_equal(surface_measures()); }

TEST(Layout, ViewAndGBufferAgreeWithTheDevice) { expect_equal(view_measures()); }

TEST(Layout, ClustersAgreeWithTheDevice) { expect_equal(cluster_measures()); }

TEST(Layout, StructsPassedByValueArriveWhole) {
    Gpu gpu = test_gpu();
    const cl::Program program =
        build_probe(
            gpu, kLayoutHeaders,
            "kernel void echo(View view, ClusterGrid grid, GBufferLayout layout, global View* v,\n"
            "                 global ClusterGrid* g, global GBufferLayout* l) {\n"
            "    *v = view;\n    *g = grid;\n    *l = layout;\n}\n")
            .built();
    const auto fill = [](auto value, uint first) {
        auto* words = reinterpret_cast<uint*>(&value);
        for (uint i = 0; i < sizeof(value) / 4; ++i) words[i] = 0x3f800000u + first + i;
        return value;
    };
    const View view = fill(View{}, 100);
    const ClusterGrid grid = fill(ClusterGrid{}, 200);
    const GBufferLayout layout = fill(GBufferLayout{}, 300);
    const cl::Buffer v = new_buffer(gpu, std::vector<View>(1));
    const cl::Buffer g = new_buffer(gpu, std::vector<ClusterGrid>(1));
    const cl::Buffer l = new_buffer(gpu, std::vector<GBufferLayout>(1));
    cl::KernelFunctor<View, ClusterGrid, GBufferLayout, cl::Buffer, cl::Buffer, cl::Buffer>(
        program, "echo")(cl::EnqueueArgs(gpu.queue, cl::NDRange(1), cl::NDRange(1)), view, grid,
                         layout, v, g, l);
    const auto same = [](const auto& a, const auto& b) {
        return std::memcmp(&a, &b, sizeof(a)) == 0;
    };
    EXPECT_TRUE(same(download<View>(gpu, v, 1).front(), view));
    EXPECT_TRUE(same(download<ClusterGrid>(gpu, g, 1).front(), grid));
    EXPECT_TRUE(same(download<GBufferLayout>(gpu, l, 1).front(), layout));
}

}  // namespace
}  // namespace kilolux
