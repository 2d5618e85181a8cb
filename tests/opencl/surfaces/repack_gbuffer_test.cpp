// SPDX-License-Identifier: Apache-2.0
// Other renderers' depth, normals and albedo in every format, from buffers and from images, against
// the host's packing; and radiance back.
#include "host/stages/surfaces/repack_gbuffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "host/base/error.h"
#include "host/base/formats/half.h"
#include "host/base/formats/srgb.h"
#include "host/certify/synthetic/random.h"
#include "host/stages/picture/pack_radiance.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr uint kWidth = 37, kHeight = 11, kPitch = 41;

struct Pixel {
    float depth = 0.0f;  // of the depth buffer: 1 is background
    float4 normal{};     // world
    float4 albedo{};     // linear; w: roughness
};

// Standard depth, so that the plane holds 1 - d; the camera looks along +X from (3, 2, 1).
MatrixView some_view() {
    return make_view(
        ViewMatrices{.view = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, -1, -2, 3, 1},
                     .projection = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -1, 0, 0, -0.1001, 0},
                     .width = kWidth,
                     .height = kHeight});
}

std::vector<Pixel> some_pixels() {
    Random random(7);
    std::vector<Pixel> pixels(std::size_t{kPitch} * kHeight);
    const auto unit = [&] { return static_cast<float>(random.unit()); };
    for (Pixel& p : pixels) {
        p.depth = random.unit() < 0.2 ? 1.0f : unit();
        p.normal = {2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1, 0};
        p.albedo = {unit(), unit() * 0.1f, unit() * 0.001f, unit()};
    }
    return pixels;
}

uint code_of(double v, double largest) { return static_cast<uint>(std::lround(v * largest)); }

FV3 normalized(const float4& n) {
    const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    return fv3(n.x / length, n.y / length, n.z / length);
}

uint depth_word(DepthFormat format, float d) {
    if (format == DepthFormat::float32) return float_bits(d);
    const uint code = code_of(d, 0xffffff);
    return format == DepthFormat::lower_24 ? code | 0xab000000u : code << 8 | 0xabu;
}

uint normal_word(NormalFormat format, const float4& v) {
    const FV3 n = normalized(v);
    if (format == NormalFormat::rgba8) {
        return code_of(n.x * 0.5 + 0.5, 255) | code_of(n.y * 0.5 + 0.5, 255) << 8 |
               code_of(n.z * 0.5 + 0.5, 255) << 16;
    }
    const FV3 o = octahedral_encode(n);
    return code_of(o.x * 0.5 + 0.5, 65535) | code_of(o.y * 0.5 + 0.5, 65535) << 16;
}

uint albedo_word(const float4& c) {
    return code_of(linear_to_srgb(c.x), 255) | code_of(linear_to_srgb(c.y), 255) << 8 |
           code_of(linear_to_srgb(c.z), 255) << 16 | code_of(c.w, 255) << 24;
}

// The buffers that a renderer with this format would have.
SourceGBuffer source_of(const Gpu& gpu, const SourceFormat& format,
                        const std::vector<Pixel>& pixels) {
    std::vector<uint> depth, normal, albedo;
    std::vector<float4> wide_normal;
    std::vector<std::uint16_t> half_albedo;
    for (const Pixel& p : pixels) {
        depth.push_back(depth_word(format.depth, p.depth));
        normal.push_back(normal_word(format.normal, p.normal));
        wide_normal.push_back(p.normal);
        albedo.push_back(albedo_word(p.albedo));
        for (const float v : {p.albedo.x, p.albedo.y, p.albedo.z, p.albedo.w})
            half_albedo.push_back(half_bits_clamped(v));
    }
    SourceGBuffer out;
    out.depth = new_buffer(gpu, depth);
    out.normal = format.normal == NormalFormat::float4 ? new_buffer(gpu, wide_normal)
                                                       : new_buffer(gpu, normal);
    out.albedo = format.albedo == AlbedoFormat::half4 ? new_buffer(gpu, half_albedo)
                                                      : new_buffer(gpu, albedo);
    out.pitch = kPitch;
    return out;
}

struct HalfPlanes {
    std::vector<float> depth;
    std::vector<uint> normal, albedo;
};

HalfPlanes repacked(const Gpu& gpu, const SourceFormat& format, const SourceGBuffer& source) {
    RepackGBuffer stage(gpu, default_tuning(gpu.info), format);
    StageTimer timer;
    const GBuffer out = stage.enqueue(source, some_view(), timer);
    const std::vector<std::byte> bytes = download(gpu, out.bytes);
    const std::size_t count = std::size_t{out.view.stride} * kHeight;
    HalfPlanes planes{std::vector<float>(count), std::vector<uint>(count),
                      std::vector<uint>(count)};
    const auto copy = [&](void* to, uint plane) {
        std::memcpy(to, &bytes[out.layout.offset_bytes[plane]], count * 4);
    };
    copy(planes.depth.data(), PLANE_DEPTH);
    copy(planes.normal.data(), PLANE_NORMAL);
    copy(planes.albedo.data(), PLANE_ALBEDO);
    return planes;
}

// The angle between a packed normal and the pixel's, which the view turns [rad].
double normal_error(uint word, const Pixel& p, bool is_world) {
    const auto snorm = [](uint code) { return static_cast<float>(code) / 65535.0f * 2.0f - 1.0f; };
    const FV3 got = octahedral_decode(snorm(word & 0xffffu), snorm(word >> 16));
    const FV3 n = normalized(p.normal);
    const FV3 expected = is_world ? fv3(n.z, n.y, -n.x) : n;
    const FV3 off = sub3(got, expected);
    return std::sqrt(static_cast<double>(dot3(off, off)));
}

double albedo_error(uint got, uint expected) {
    double worst = 0.0;
    for (int shift = 0; shift < 32; shift += 8) {
        const auto channel = [shift](uint v) { return static_cast<double>(v >> shift & 255u); };
        worst = std::max(worst, std::abs(channel(got) - channel(expected)));
    }
    return worst;
}

// `albedo_codes`: how many codes the albedo may be off.
void expect_planes(const HalfPlanes& planes, const std::vector<Pixel>& pixels,
                   const SourceFormat& format, double albedo_codes) {
    // Of 16 octahedral bits 6.6e-5, twice where the source has them, too.
    const double angle = format.normal == NormalFormat::rgba8    ? 0.008
                         : format.normal == NormalFormat::float4 ? 7e-5
                                                                 : 1.4e-4;
    const double depth = format.depth == DepthFormat::float32 ? 0.0 : 1.0 / 0x1000000;
    const uint stride = some_view().view.stride;
    for (uint y = 0; y < kHeight; ++y) {
        for (uint x = 0; x < stride; ++x) {
            const std::size_t at = std::size_t{y} * stride + x;
            const Pixel p = x < kWidth ? pixels[std::size_t{y} * kPitch + x] : Pixel{1.0f, {}, {}};
            ASSERT_NEAR(planes.depth[at], 1.0f - p.depth, depth) << x << ", " << y;
            if (p.depth == 1.0f) {
                ASSERT_EQ(planes.normal[at] | planes.albedo[at], 0u) << "background";
                continue;
            }
            ASSERT_LE(normal_error(planes.normal[at], p, format.world_normals), angle)
                << x << ", " << y;
            ASSERT_LE(albedo_error(planes.albedo[at], albedo_word(p.albedo)), albedo_codes)
                << x << ", " << y;
        }
    }
}

TEST(RepackGBuffer, TakesEveryFormat) {
    const Gpu gpu = test_gpu();
    const std::vector<Pixel> pixels = some_pixels();
    for (const DepthFormat depth :
         {DepthFormat::float32, DepthFormat::lower_24, DepthFormat::upper_24}) {
        for (const NormalFormat normal :
             {NormalFormat::rgba8, NormalFormat::octahedral16, NormalFormat::float4}) {
            const bool is_world = depth != DepthFormat::lower_24;
            const SourceFormat format{
                depth, normal,
                normal == NormalFormat::float4 ? AlbedoFormat::half4 : AlbedoFormat::srgb8,
                is_world};
            // A half's rounding is up to half a code.
            expect_planes(repacked(gpu, format, source_of(gpu, format, pixels)), pixels, format,
                          format.albedo == AlbedoFormat::half4 ? 1.0 : 0.0);
        }
    }
}

TEST(RepackGBuffer, OneRoughnessForAll) {
    const Gpu gpu = test_gpu();
    const std::vector<Pixel> pixels = some_pixels();
    SourceGBuffer source = source_of(gpu, {}, pixels);
    source.roughness = 0.2f;
    const HalfPlanes planes = repacked(gpu, {}, source);
    for (std::size_t i = 0; i < kWidth; ++i) {
        if (pixels[i].depth < 1.0f) {
            EXPECT_EQ(planes.albedo[i] >> 24, 51u);
        }
    }
}

template <typename T>
cl::Image2D image_of(const Gpu& gpu, cl::ImageFormat format, std::vector<T> texels) {
    return {gpu.context, CL_MEM_COPY_HOST_PTR, format, kPitch, kHeight, 0, texels.data()};
}

TEST(RepackGBuffer, TakesImages) {
    const Gpu gpu = test_gpu();
    if (!gpu.device.getInfo<CL_DEVICE_IMAGE_SUPPORT>()) GTEST_SKIP() << "no images";
    const std::vector<Pixel> pixels = some_pixels();
    // Of the channels that every device has: CL_RGBA.
    std::vector<float4> depth;
    std::vector<std::uint16_t> normal;
    std::vector<uint> albedo;
    for (const Pixel& p : pixels) {
        depth.push_back({p.depth, 0, 0, 0});
        const uint n = normal_word(NormalFormat::octahedral16, p.normal);
        for (const uint v : {n & 0xffffu, n >> 16, 0u, 0u})
            normal.push_back(static_cast<std::uint16_t>(v));
        albedo.push_back(albedo_word(p.albedo));
    }
    const SourceFormat format{.normal = NormalFormat::octahedral16, .images = true};
    SourceGBuffer source;
    source.depth = image_of(gpu, {CL_RGBA, CL_FLOAT}, depth);
    source.normal = image_of(gpu, {CL_RGBA, CL_UNORM_INT16}, normal);
    source.albedo = image_of(gpu, {CL_RGBA, CL_UNORM_INT8}, albedo);
    expect_planes(repacked(gpu, format, source), pixels, format, 0.0);
    source.depth = cl::Image2D(gpu.context, CL_MEM_READ_ONLY, {CL_RGBA, CL_FLOAT}, kWidth - 1, 11);
    EXPECT_THROW(repacked(gpu, format, source), Error);
}

TEST(RepackGBuffer, RefusesWhatIsTooSmallOrOfAnotherKind) {
    const Gpu gpu = test_gpu();
    const auto message = [&](auto change) -> std::string {
        SourceGBuffer source = source_of(gpu, {}, some_pixels());
        change(source);
        try {
            repacked(gpu, {}, source);
            return "nothing";
        } catch (const Error& error) {
            return error.what();
        }
    };
    EXPECT_EQ(message([](SourceGBuffer&) {}), "nothing");
    EXPECT_EQ(message([](SourceGBuffer& s) { s.depth = {}; }),
              "repack_gbuffer: depth: there is none");
    EXPECT_EQ(message([](SourceGBuffer& s) { s.pitch = 36; }),
              "repack_gbuffer: depth: its pitch is 36 pixels, the picture is 37 wide");
    EXPECT_EQ(message([&](SourceGBuffer& s) {
                  s.albedo = cl::Buffer(gpu.context, CL_MEM_READ_ONLY, std::size_t{1784});
              }),
              "repack_gbuffer: albedo: has 1784 bytes, needs 1788");
    if (!gpu.device.getInfo<CL_DEVICE_IMAGE_SUPPORT>()) return;
    EXPECT_EQ(
        message([&](SourceGBuffer& s) {
            s.normal = cl::Image2D(gpu.context, CL_MEM_READ_ONLY, {CL_RGBA, CL_FLOAT}, 64, 64);
        }),
        "repack_gbuffer: normals: is no buffer");
}

struct SomeRadiance {
    std::vector<float> planes;
    Radiance radiance;
};

SomeRadiance some_radiance(const Gpu& gpu) {
    SomeRadiance out;
    out.radiance.view = some_view().view;
    const std::size_t count = std::size_t{3} * out.radiance.view.stride * kHeight;
    for (std::size_t i = 0; i < count; ++i)
        out.planes.push_back(0.25f * static_cast<float>(i % 999));
    out.planes[0] = 1e6f;
    out.radiance.planes = new_buffer(gpu, out.planes);
    return out;
}

// Calls expect(pixel, channel, value) for all of them.
template <typename Expect>
void each_value(const SomeRadiance& from, uint pitch, const Expect& expect) {
    const uint stride = from.radiance.view.stride;
    for (uint y = 0; y < kHeight; ++y) {
        for (uint x = 0; x < kWidth; ++x) {
            const std::size_t pixel = std::size_t{y} * pitch + x;
            for (std::size_t c = 0; c < 3; ++c) {
                expect(4 * pixel + c, from.planes[c * stride * kHeight + y * stride + x]);
            }
            expect(4 * pixel + 3, 1.0f);
        }
    }
}

TEST(PackRadiance, GivesFloatsHalvesAndImages) {
    const Gpu gpu = test_gpu();
    const SomeRadiance from = some_radiance(gpu);
    StageTimer timer;
    const auto pack = [&](RadianceFormat format, const cl::Memory& to, uint pitch) {
        PackRadiance(gpu, default_tuning(gpu.info), format)
            .enqueue(from.radiance, to, pitch, timer);
    };
    const std::size_t values = std::size_t{4} * kPitch * kHeight;
    const cl::Buffer floats = new_buffer(gpu, std::vector<float>(values, -1.0f));
    pack(RadianceFormat::float4, floats, kPitch);
    const auto float_values = download<float>(gpu, floats, values);
    each_value(from, kPitch, [&](std::size_t i, float v) { ASSERT_EQ(float_values[i], v); });
    EXPECT_EQ(float_values[4 * kWidth], -1.0f) << "beyond the width";

    const cl::Buffer halves = new_buffer(gpu, std::vector<std::uint16_t>(values));
    pack(RadianceFormat::half4, halves, 0);
    const auto half_values = download<std::uint16_t>(gpu, halves, values);
    each_value(from, kWidth, [&](std::size_t i, float v) {
        ASSERT_EQ(half_values[i], half_bits_clamped(std::min(v, 65504.0f)));
    });
    EXPECT_THROW(pack(RadianceFormat::float4, halves, 0), Error) << "too small";

    if (!gpu.device.getInfo<CL_DEVICE_IMAGE_SUPPORT>()) return;
    const cl::Image2D image(gpu.context, CL_MEM_WRITE_ONLY, {CL_RGBA, CL_FLOAT}, kWidth, kHeight);
    pack(RadianceFormat::image, image, 0);
    std::vector<float> texels(std::size_t{4} * kWidth * kHeight);
    gpu.queue.enqueueReadImage(image, CL_TRUE, {0, 0, 0}, {kWidth, kHeight, 1}, 0, 0,
                               texels.data());
    each_value(from, kWidth, [&](std::size_t i, float v) { ASSERT_EQ(texels[i], v); });
    EXPECT_THROW(pack(RadianceFormat::image, floats, 0), Error) << "is no image";
}

}  // namespace
}  // namespace kilolux
