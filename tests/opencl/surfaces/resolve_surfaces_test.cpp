// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/resolve_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/formats/mips.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/build_mips.h"
#include "host/stages/surfaces/count_texels.h"
#include "host/stages/surfaces/decode_gbuffer.h"
#include "host/stages/surfaces/raster_triangles.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/mips.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr uint kResolvedWidth = 21, kResolvedHeight = 5;

// A view with square pixels of 0.1 at depth 1.
View small_view() {
    View view{};
    view.ray = {0.1f, -0.05f * kResolvedWidth, -0.1f, 0.05f * kResolvedHeight};
    view.depth = {10.0f, 0.0f, 0.0f, 0.0f};
    view.width = kResolvedWidth;
    view.height = kResolvedHeight;
    view.stride = 32;
    view.view_from_world_x = {1, 0, 0, 0};
    view.view_from_world_y = {0, 1, 0, 0};
    view.view_from_world_z = {0, 0, 1, 0};
    return view;
}

SurfaceMaterial quad_material() {
    SurfaceMaterial out{};
    out.row.base_color = {1.0f, 0.5f, 1.0f, 1.0f};
    out.row.factors = {0.25f, 0.75f, 1.0f, 1.0f};
    for (uint& texture : out.textures) texture = SURFACE_ABSENT;
    out.textures[USE_BASE_COLOR] = out.textures[USE_NORMAL] = 0;
    out.lookup_use = USE_BASE_COLOR;
    out.lookup_shared = 1u << USE_BASE_COLOR | 1u << USE_NORMAL;
    out.flags = MATERIAL_MASKED;
    out.row.emissive_cutoff.w = 0.5f;  // texels' alpha is 1
    return out;
}

// Owns the buffers that SurfaceBuffers refer to.
class QuadScene {
 public:
    // `repeats` of the texture along each edge.
    explicit QuadScene(const Gpu& gpu, float repeats = 1.0f,
                       const SurfaceMaterial& material = quad_material())
        : gpu_(gpu) {
        // Position, normal, tangent, texcoords, colour; a rectangle at depth 2 that leaves the left
        // columns. The second texcoords are turned; the colour's alpha falls from left to right.
        constexpr float kEdge = 1.6f;
        std::vector<float> vertices;
        for (const auto& [x, y, u, v] :
             {std::array{-kEdge, -9.0f, 0.0f, 1.0f}, std::array{9.0f, -9.0f, 1.0f, 1.0f},
              std::array{9.0f, 9.0f, 1.0f, 0.0f}, std::array{-kEdge, 9.0f, 0.0f, 0.0f}}) {
            const std::array row = {x,           y,           -2.0f, 0.0f, 0.0f,        1.0f,
                                    1.0f,        0.0f,        0.0f,  1.0f, u * repeats, v * repeats,
                                    v * repeats, u * repeats, 1.0f,  1.0f, 1.0f,        1.0f - u};
            vertices.insert(vertices.end(), row.begin(), row.end());
        }
        MeshRow mesh{};
        mesh.vertex_floats = 18;
        mesh.normal = 3;
        mesh.tangent = 6;
        mesh.texcoord0 = 10;
        mesh.texcoord1 = 12;
        mesh.color = 14;
        InstanceRow instance{};
        for (int i = 0; i < 3; ++i) {
            float* row = &instance.view_from_object[i].x;
            row[i] = 1.0f;
            (&instance.normal_from_object[i].x)[i] = 1.0f;
        }
        instance.normal_from_object[0].w = 1.0f;
        TextureRow texture{};
        place_mips(texture, 5, 3, 0);
        std::vector<std::uint64_t> image;
        for (uint i = 0; i < 5 * 3; ++i) {
            image.push_back(make_texel(257 * 17 * i, 257 * 128, 257 * (255 - 17 * i), 65535));
        }
        const auto texels = texels_.reserve(mip_texels(5, 3));
        BuildMips(gpu, default_tuning(gpu.info)).enqueue(image, texture, texels);
        put(vertices_, vertices, buffers.vertices);
        put(indices_, std::vector<uint>{0, 1, 2, 0, 2, 3}, buffers.indices);
        put(meshes_, std::vector{mesh}, buffers.meshes);
        InstanceRow end{};
        end.first_triangle = 2;
        put(instances_, std::vector{instance, end}, buffers.instances);
        put(blocks_, std::vector<uint>{0, 0}, buffers.instance_blocks);
        put(materials_, std::vector{material}, buffers.materials);
        put(textures_, std::vector{texture}, buffers.textures);
        buffers.texels = texels;
    }

    SurfaceBuffers buffers;

 private:
    template <typename T>
    void put(GrowingArray<T>& array, const std::vector<T>& values, DeviceArray<T>& out) {
        out = array.reserve(values.size());
        upload<T>(gpu_, out, values);
    }

    Gpu gpu_;
    GrowingArray<float> vertices_{gpu_, "test"};
    GrowingArray<uint> indices_{gpu_, "test"};
    GrowingArray<MeshRow> meshes_{gpu_, "test"};
    GrowingArray<InstanceRow> instances_{gpu_, "test"};
    GrowingArray<uint> blocks_{gpu_, "test"};
    GrowingArray<SurfaceMaterial> materials_{gpu_, "test"};
    GrowingArray<TextureRow> textures_{gpu_, "test"};
    GrowingArray<std::uint64_t> texels_{gpu_, "test"};
};

SurfaceFeatures quad_features(int anisotropy) {
    SurfaceFeatures surfaces;
    surfaces.texture_uses = 1u << USE_BASE_COLOR | 1u << USE_NORMAL;
    surfaces.texcoord0 = surfaces.tangents = true;
    surfaces.anisotropy = anisotropy;
    return surfaces;
}

// Its two triangles by turns, from column 3 on.
std::vector<uint> quad_ids(const View& view) {
    std::vector<uint> ids(std::size_t{view.stride} * view.height, 0);
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 3; x < view.width; ++x) ids[y * view.stride + x] = 1 + (x + y) % 2;
    }
    return ids;
}

// A G-buffer of the quad on the device.
struct Resolved {
    KernelFeatures features;
    GBuffer gbuffer;
};

Resolved resolve_quad(const Gpu& gpu, uint layout, const SurfaceFeatures& surfaces,
                      const SurfaceMaterial& material = quad_material()) {
    const View view = small_view();
    Resolved out;
    out.features.gbuffer = layout;
    out.features.material = out.features.metallic = true;
    out.features.occlusion = out.features.specular = true;
    GBufferNeeds needs;
    static_cast<SceneFeatures&>(needs) = out.features;
    needs.layout = layout;
    const QuadScene scene(gpu, 1.0f, material);
    const std::vector<uint> ids = quad_ids(view);
    GrowingArray<uint> device_ids(gpu, "test");
    upload<uint>(gpu, device_ids.reserve(ids.size()), ids);
    ResolveSurfaces resolve(gpu, default_tuning(gpu.info), out.features, surfaces);
    StageTimer timer;
    const GBufferLayout planes = make_gbuffer_layout(needs, view.stride, view.height);
    out.gbuffer = resolve.enqueue(device_ids.get(), scene.buffers, planes, view, timer);
    gpu.queue.finish();
    return out;
}

// The planes as shading sees them.
std::vector<float> decoded(const Gpu& gpu, const Resolved& quad) {
    DecodeGBuffer decode(gpu, default_tuning(gpu.info), quad.features);
    StageTimer timer;
    const View& view = quad.gbuffer.view;
    return download<float>(gpu, decode.enqueue(quad.gbuffer, timer),
                           SURFACE_PLANES * view.stride * view.height);
}

// The planes of a layout, as bytes.
std::vector<std::byte> resolved(const Gpu& gpu, uint layout, int anisotropy) {
    const GBuffer out = resolve_quad(gpu, layout, quad_features(anisotropy)).gbuffer;
    const std::size_t pixels = std::size_t{out.view.stride} * out.view.height;
    std::vector<std::byte> bytes = download(gpu, out.bytes);
    // The gaps between planes are undefined.
    std::vector<std::byte> kept;
    for (uint plane = 0; plane < PLANE_COUNT; ++plane) {
        if (out.layout.offset_bytes[plane] == PLANE_ABSENT) continue;
        const auto first =
            bytes.begin() + static_cast<std::ptrdiff_t>(out.layout.offset_bytes[plane]);
        kept.insert(
            kept.end(), first,
            first + static_cast<std::ptrdiff_t>(plane_element_bytes(layout, plane) * pixels));
    }
    return kept;
}

TEST(ResolveSurfaces, LaneWidthsGiveTheSameBits) {
    if (!test_gpu().info.is_cpu) GTEST_SKIP() << "promised on CPUs";
    for (uint layout = GBUFFER_PACKED; layout <= GBUFFER_OCT_2X4; ++layout) {
        const auto one = resolved(test_gpu(1), layout, 1);
        for (const int lanes : lane_widths()) {
            EXPECT_EQ(resolved(test_gpu(lanes), layout, 1), one) << layout << ' ' << lanes;
        }
    }
    EXPECT_EQ(resolved(test_gpu(16), GBUFFER_PACKED, 8), resolved(test_gpu(1), GBUFFER_PACKED, 8));
}

TEST(ResolveSurfaces, InterpolatesAndLeavesTheBackground) {
    const std::vector<float> planes =
        decoded(test_gpu(), resolve_quad(test_gpu(), GBUFFER_FULL, quad_features(1)));
    const View view = small_view();
    const std::size_t plane = std::size_t{view.stride} * view.height;
    const auto at = [&](std::size_t index, uint x, uint y) {
        return planes[index * plane + y * view.stride + x];
    };
    for (uint y = 0; y < kResolvedHeight; ++y) {
        EXPECT_EQ(at(SURFACE_DEPTH, 2, y), 0.0f);
        EXPECT_NEAR(at(SURFACE_DEPTH, 12, y), 2.0f, 1e-6f);
        EXPECT_NEAR(at(SURFACE_POSITION, 12, y), 2.0f * 0.1f * (12.5f - 0.5f * kResolvedWidth),
                    1e-6f);
        EXPECT_NEAR(at(SURFACE_ALBEDO + 1, 12, y), 0.5f * 128.0f / 255.0f, 1e-6f);
        EXPECT_EQ(at(SURFACE_ROUGHNESS, 12, y), 0.75f);
        EXPECT_EQ(at(SURFACE_METALLIC, 12, y), 0.25f);
        const float nx = at(SURFACE_NORMAL, 12, y);
        const float nz = at(SURFACE_NORMAL + 2, 12, y);
        const float red = at(SURFACE_ALBEDO, 12, y);
        const float blue = at(SURFACE_ALBEDO + 2, 12, y);
        EXPECT_NEAR(nx / nz, (2 * red - 1) / (2 * blue - 1), 1e-4f);
    }
}

// A plane of the quad's surfaces, or three, without what lies beside the picture.
std::vector<float> plane_of(const std::vector<float>& planes, std::size_t first, int count) {
    const View view = small_view();
    std::vector<float> out;
    for (std::size_t y = first * kResolvedHeight;
         y < (first + static_cast<std::size_t>(count)) * kResolvedHeight; ++y) {
        const auto row = planes.begin() + static_cast<std::ptrdiff_t>(y * view.stride);
        out.insert(out.end(), row, row + kResolvedWidth);
    }
    return out;
}

TEST(ResolveSurfaces, EachTextureIsReadAtItsOwnTexcoords) {
    const Gpu gpu = test_gpu();
    SurfaceFeatures features = quad_features(1);
    const auto planes_with = [&](uint flags) {
        SurfaceMaterial material = quad_material();
        material.lookup_shared = 0u;
        material.flags = flags;
        return decoded(gpu, resolve_quad(gpu, GBUFFER_FULL, features, material));
    };
    const std::vector<float> first = planes_with(0u);
    features.texcoord1 = true;
    const auto same = [&](const std::vector<float>& planes, std::size_t plane) {
        return plane_of(planes, plane, 3) == plane_of(first, plane, 3);
    };
    EXPECT_EQ(planes_with(0u), first);
    const std::vector<float> turned_normal = planes_with(1u << USE_NORMAL);
    EXPECT_TRUE(same(turned_normal, SURFACE_ALBEDO));
    EXPECT_FALSE(same(turned_normal, SURFACE_NORMAL));
    const std::vector<float> turned_colour = planes_with(1u << USE_BASE_COLOR);
    EXPECT_FALSE(same(turned_colour, SURFACE_ALBEDO));
    EXPECT_TRUE(same(turned_colour, SURFACE_NORMAL));
}

// The texture's alpha is 1 everywhere.
TEST(ResolveSurfaces, TheWeightOfSpecularIsItsTexturesAlpha) {
    const Gpu gpu = test_gpu();
    SurfaceFeatures features = quad_features(1);
    features.texture_uses |= 1u << USE_SPECULAR;
    SurfaceMaterial material = quad_material();
    material.textures[USE_SPECULAR] = 0;
    material.row.specular.w = 0.75f;
    const std::vector<float> f90 = plane_of(
        decoded(gpu, resolve_quad(gpu, GBUFFER_FULL, features, material)), SURFACE_SPECULAR_F90, 1);
    for (std::size_t i = 0; i < f90.size(); ++i) {
        ASSERT_EQ(f90[i], i % kResolvedWidth < 3 ? 0.0f : 0.75f) << i;
    }
}

// The ids of the quad's triangles, drawn in OpenCL.
std::vector<uint> drawn_ids(const Gpu& gpu, int group, bool vertex_alpha = false,
                            const SurfaceMaterial& material = quad_material()) {
    const View view = small_view();
    Tuning tuning = default_tuning(gpu.info);
    tuning.raster_group = group;
    tuning.raster_tile_width = tuning.raster_tile_height = 16;
    tuning.cull_chunks = 2;
    SurfaceFeatures features;
    features.texture_uses = 1u << USE_BASE_COLOR;
    features.texcoord0 = features.masks = true;
    features.vertex_color = vertex_alpha;
    const QuadScene scene(gpu, 1.0f, material);
    BinTriangles bin(gpu, tuning);
    RasterTriangles raster(gpu, tuning, features);
    StageTimer timer;
    const TriangleLists lists = bin.enqueue(scene.buffers, 2, view, timer);
    EXPECT_TRUE(bin.fits(bin.pairs()));
    std::vector<uint> ids = download(gpu, raster.enqueue(scene.buffers, lists, view, timer));
    for (uint y = 0; y < view.height; ++y) {
        std::fill_n(ids.begin() + y * view.stride + view.width, view.stride - view.width, 0u);
    }
    return ids;
}

// The colours' alpha falls by a tenth until x = -0.54 m, which is at pixel 7.8.
TEST(ResolveSurfaces, MasksUseTheVerticesAlpha) {
    SurfaceMaterial material = quad_material();
    material.row.emissive_cutoff.w = 0.9f;
    for (const int group : {1, 32}) {
        const std::vector<uint> ids = drawn_ids(test_gpu(1), group, true, material);
        for (uint y = 0; y < kResolvedHeight; ++y) {
            for (uint x = 3; x < kResolvedWidth; ++x) {
                EXPECT_EQ(ids[y * 32 + x] != 0, x < 8) << x << ' ' << y << ", group " << group;
            }
        }
    }
}

// Number of texels of every pixel of the quad: all are equal.
uint texels_of_quad(int lanes, float repeats, int anisotropy) {
    const Gpu gpu = test_gpu(lanes);
    const View view = small_view();
    const QuadScene scene(gpu, repeats);
    const std::vector<uint> ids = drawn_ids(gpu, 1);
    GrowingArray<uint> device_ids(gpu, "test");
    upload<uint>(gpu, device_ids.reserve(ids.size()), ids);
    CountTexels count(gpu, default_tuning(gpu.info), quad_features(anisotropy));
    StageTimer timer;
    const std::vector<uint> counts =
        download(gpu, count.enqueue(device_ids.get(), scene.buffers, view, timer));
    const uint expected = counts[kResolvedWidth - 1];
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            const std::size_t i = y * view.stride + x;
            EXPECT_EQ(counts[i], ids[i] == 0 ? 0u : expected) << x << ' ' << y;
        }
    }
    return expected;
}

// A pixel is 0.094 * repeats texels wide and 0.033 * repeats high. Both uses read one texture.
TEST(CountTexels, CountsLevelsAndSamples) {
    for (const int lanes : {1, 2, 16}) {
        EXPECT_EQ(texels_of_quad(lanes, 1.0f, 1), 4u) << "magnified";
        EXPECT_EQ(texels_of_quad(lanes, 20.0f, 1), 8u) << "between two mip levels";
        EXPECT_EQ(texels_of_quad(lanes, 20.0f, 8), 12u) << "three samples of the finest";
        EXPECT_EQ(texels_of_quad(lanes, 40.0f, 8), 24u) << "three samples between two";
    }
}

}  // namespace

TEST(EveryKernel, Triangles) {
    const std::vector<uint> ids = drawn_ids(test_gpu(1), 1);
    // The quad's left edge is at -1.6 / 2, at pixel 2.5: that column's centres lie on it.
    for (uint y = 0; y < kResolvedHeight; ++y) {
        EXPECT_EQ(ids[y * 32 + 1], 0u);
        for (uint x = 3; x < kResolvedWidth; ++x)
            EXPECT_TRUE(ids[y * 32 + x] == 1 || ids[y * 32 + x] == 2);
    }
    EXPECT_EQ(drawn_ids(test_gpu(4), 1), ids);
    EXPECT_EQ(drawn_ids(test_gpu(1), 32), ids);
}

// Under oclgrind, with the other kernels.
TEST(EveryKernel, Surfaces) {
    for (const int lanes : {1, 4}) {
        texels_of_quad(lanes, 20.0f, 1);
        for (uint layout = GBUFFER_PACKED; layout <= GBUFFER_OCT_2X4; ++layout) {
            EXPECT_FALSE(resolved(test_gpu(lanes), layout, lanes).empty());
        }
    }
}

}  // namespace kilolux
