// SPDX-License-Identifier: Apache-2.0
// Decoded planes against double, layout by layout.
#include "host/stages/surfaces/decode_gbuffer.h"

#include <gtest/gtest.h>

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/formats/half.h"
#include "host/certify/synthetic/host_lists.h"
#include "host/certify/synthetic/synthetic.h"
#include "tests/support/full.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

// Three roundings of z and two of a position, u = 6e-8 each.
constexpr double kDepthTolerance = 2.5e-7;
constexpr double kPositionTolerance = 5e-7;

KernelFeatures features_of(uint layout) {
    KernelFeatures features;
    features.gbuffer = layout;
    features.material = features.metallic = features.occlusion = features.specular = true;
    return features;
}

double expected_depth(const View& view, Synthetic& image, uint x, uint y) {
    const double depth01 = image.plane<float>(PLANE_DEPTH)[y * view.stride + x];
    const double q =
        depth01 * view.depth.x + (x + 0.5) * view.depth.y + (y + 0.5) * view.depth.z + view.depth.w;
    return view.orthographic != 0 ? q : 1 / q;
}

glm::dvec3 position_on_ray(const View& view, uint x, uint y, double z) {
    const double s = view.orthographic != 0 ? 1 : z;
    return {((x + 0.5) * view.ray.x + view.ray.y) * s, ((y + 0.5) * view.ray.z + view.ray.w) * s,
            -z};
}

template <typename Visit>
void for_drawn(Synthetic& image, const Visit& visit) {
    const View& view = image.view;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            if (image.plane<float>(PLANE_DEPTH)[y * view.stride + x] > 0.0f) visit(x, y);
        }
    }
}

std::vector<ViewShape> decoded_shapes() {
    std::vector<ViewShape> all(4);
    all[0].width = 83;
    all[1].shift_x = 0.5;
    all[1].oblique_x = 0.2;
    all[1].oblique_y = -0.1;
    all[2].orthographic = true;
    all[2].half_x = 30;
    all[3].width = all[3].height = 1;
    return all;
}

TEST(DecodeGBuffer, DepthAndPositionLieOnThePixelsRay) {
    const Gpu gpu = test_gpu();
    for (const ViewShape& shape : decoded_shapes()) {
        const View view = make_view(shape);
        Synthetic image = make_synthetic(view, {}, noise_depth(0.3, 4.0, 0.2, 3));
        const Planes planes = decode(gpu, {}, upload_gbuffer(gpu, image));
        const double extent = std::abs(view.ray.y) + std::abs(view.ray.w) + 1;
        for_drawn(image, [&](uint x, uint y) {
            const double z = expected_depth(view, image, x, y);
            // Orthographic z is near zero where its terms cancel: there their size is the unit.
            const double size = view.orthographic != 0 ? 200.0 : z;
            EXPECT_NEAR(planes.at(SURFACE_DEPTH, x, y), z, kDepthTolerance * size);
            const glm::dvec3 p = position_on_ray(view, x, y, planes.at(SURFACE_DEPTH, x, y));
            const double tolerance =
                kPositionTolerance * extent * (view.orthographic != 0 ? 1.0 : z);
            EXPECT_LE(length(planes.vector(SURFACE_POSITION, x, y) - p), tolerance);
        });
    }
}

TEST(DecodeGBuffer, BackgroundAndPaddingAreZero) {
    const Gpu gpu = test_gpu();
    const View view = make_view(ViewShape{17, 31});
    const KernelFeatures features = features_of(GBUFFER_PACKED);
    const Planes planes =
        decode(gpu, features, upload_gbuffer(gpu, make_synthetic(view, features, no_depth())));
    for (const float value : planes.values) ASSERT_EQ(value, 0.0f);
}

double srgb_value(uint code) {
    const double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

glm::dvec3 srgb_color(uint rgba) {
    return {srgb_value(rgba & 255), srgb_value(rgba >> 8 & 255), srgb_value(rgba >> 16 & 255)};
}

glm::dvec3 octahedral_normal(uint packed) {
    const double u = (packed & 0xffff) / 65535.0 * 2 - 1;
    const double v = (packed >> 16) / 65535.0 * 2 - 1;
    const double z = 1 - std::abs(u) - std::abs(v);
    if (z >= 0) return glm::normalize(glm::dvec3(u, v, z));
    return glm::normalize(glm::dvec3((1 - std::abs(v)) * (u >= 0 ? 1 : -1),
                                     (1 - std::abs(u)) * (v >= 0 ? 1 : -1), z));
}

// Attributes that `packed` and `normal-xy` have in common.
void expect_packed_attributes(Synthetic& image, const Planes& planes, uint x, uint y) {
    const uint i = y * image.view.stride + x;
    const uint albedo = image.plane<uint>(PLANE_ALBEDO)[i];
    const uint material = image.plane<uint>(PLANE_MATERIAL)[i];
    ASSERT_LE(length(planes.vector(SURFACE_ALBEDO, x, y) - srgb_color(albedo)), 1e-7);
    ASSERT_LE(length(planes.vector(SURFACE_EMISSIVE, x, y) - srgb_color(material) * 2.5), 5e-7);
    ASSERT_NEAR(planes.at(SURFACE_ROUGHNESS, x, y), (albedo >> 24) / 255.0, 1e-7);
    ASSERT_NEAR(planes.at(SURFACE_METALLIC, x, y), (material >> 24) / 255.0, 1e-7);
    ASSERT_NEAR(planes.at(SURFACE_OCCLUSION, x, y),
                image.plane<unsigned char>(PLANE_OCCLUSION)[i] / 255.0, 1e-7);
    const uint specular = image.plane<uint>(PLANE_SPECULAR)[i];
    const auto reflectance = [specular](uint shift) {
        const double root = (specular >> shift & 255u) / 255.0;
        return root * root;
    };
    const glm::dvec3 expected{reflectance(0), reflectance(8), reflectance(16)};
    ASSERT_LE(length(planes.vector(SURFACE_SPECULAR, x, y) - expected), 3e-7);
    ASSERT_NEAR(planes.at(SURFACE_SPECULAR_F90, x, y), (specular >> 24) / 255.0, 1e-7);
}

TEST(DecodeGBuffer, PackedAttributesAtLaneWidths) {
    for (const int lanes : lane_widths()) {
        const Gpu gpu = test_gpu(lanes);
        const KernelFeatures features = features_of(GBUFFER_PACKED);
        Synthetic image =
            make_synthetic(make_view(ViewShape{83, 31}), features, noise_depth(0.3, 60.0, 0.2, 3));
        // Axes, seams and corners of the octahedron, which noise seldom meets.
        const uint codes[] = {0u,          0xffffu,     0xffff0000u, 0xffffffffu,
                              0x7fff7fffu, 0x80008000u, 0x7fffffffu, 0x80000000u};
        for (uint i = 0; i < std::size(codes); ++i) image.plane<uint>(PLANE_NORMAL)[i] = codes[i];
        const Planes planes = decode(gpu, features, upload_gbuffer(gpu, image));
        for_drawn(image, [&](uint x, uint y) {
            expect_packed_attributes(image, planes, x, y);
            const glm::dvec3 expected =
                octahedral_normal(image.plane<uint>(PLANE_NORMAL)[y * image.view.stride + x]);
            ASSERT_LE(length(planes.vector(SURFACE_NORMAL, x, y) - expected), 5e-7)
                << x << ", " << y;
        });
    }
}

TEST(DecodeGBuffer, NormalXyRebuildsZ) {
    const Gpu gpu = test_gpu();
    const KernelFeatures features = features_of(GBUFFER_NORMAL_XY);
    Synthetic image =
        make_synthetic(make_view(ViewShape{83, 31}), features, noise_depth(0.3, 60.0, 0.2, 3));
    const Planes planes = decode(gpu, features, upload_gbuffer(gpu, image));
    for_drawn(image, [&](uint x, uint y) {
        expect_packed_attributes(image, planes, x, y);
        const uint packed = image.plane<uint>(PLANE_NORMAL)[y * image.view.stride + x];
        const double u = (packed & 0xffff) / 65535.0 * 2 - 1;
        const double v = (packed >> 16) / 65535.0 * 2 - 1;
        const glm::dvec3 found = planes.vector(SURFACE_NORMAL, x, y);
        EXPECT_NEAR(found.x, u, 2e-7);
        EXPECT_NEAR(found.y, v, 2e-7);
        // The square, since the root magnifies rounding at the rim.
        EXPECT_NEAR(found.z * found.z, std::max(1 - u * u - v * v, 0.0), 1e-6);
    });
}

TEST(DecodeGBuffer, FullLayoutIsReadAsItIs) {
    const Gpu gpu = test_gpu();
    const KernelFeatures features = features_of(GBUFFER_FULL);
    Synthetic image =
        make_synthetic(make_view(ViewShape{83, 31}), features, noise_depth(0.3, 60.0, 0.2, 3));
    const Planes planes = decode(gpu, features, upload_gbuffer(gpu, image));
    const std::pair<uint, uint> pairs[] = {
        {SURFACE_POSITION, PLANE_POSITION_X},      {SURFACE_NORMAL, PLANE_NORMAL_X},
        {SURFACE_ALBEDO, PLANE_ALBEDO_R},          {SURFACE_ROUGHNESS, PLANE_ROUGHNESS},
        {SURFACE_METALLIC, PLANE_METALLIC},        {SURFACE_EMISSIVE, PLANE_EMISSIVE_R},
        {SURFACE_OCCLUSION, PLANE_OCCLUSION_F},    {SURFACE_SPECULAR, PLANE_SPECULAR_R},
        {SURFACE_SPECULAR_F90, PLANE_SPECULAR_F90}};
    for_drawn(image, [&](uint x, uint y) {
        for (const auto& [surface, plane] : pairs) {
            EXPECT_EQ(planes.at(surface, x, y),
                      image.plane<float>(plane)[y * image.view.stride + x])
                << "plane " << plane;
        }
    });
}

TEST(DecodeGBuffer, HalfLayoutTurnsWorldIntoViewSpace) {
    const Gpu gpu = test_gpu();
    const KernelFeatures features = features_of(GBUFFER_HALF);
    Synthetic image =
        make_synthetic(make_view(ViewShape{83, 31}), features, noise_depth(0.3, 60.0, 0.2, 3));
    const Planes planes = decode(gpu, features, upload_gbuffer(gpu, image));
    const float4 camera = image.view.camera_position;
    for_drawn(image, [&](uint x, uint y) {
        const uint i = y * image.view.stride + x;
        const auto vector = [&](uint plane) {
            return glm::dvec3{half_value(image.plane<std::uint16_t>(plane)[i]),
                              half_value(image.plane<std::uint16_t>(plane + 1)[i]),
                              half_value(image.plane<std::uint16_t>(plane + 2)[i])};
        };
        const glm::dvec3 p = view_from_world(
            image.view, vector(PLANE_POSITION_X) - glm::dvec3{camera.x, camera.y, camera.z});
        const glm::dvec3 n = glm::normalize(view_from_world(image.view, vector(PLANE_NORMAL_X)));
        EXPECT_LE(length(planes.vector(SURFACE_POSITION, x, y) - p), 5e-7 * (length(p) + 1));
        EXPECT_LE(length(planes.vector(SURFACE_NORMAL, x, y) - n), 1e-6);
        const uint albedo = image.plane<uint>(PLANE_ALBEDO)[i];
        EXPECT_NEAR(planes.at(SURFACE_ALBEDO, x, y), (albedo & 255) / 255.0, 1e-7);
    });
}

// Another program's normals may be zero; light must not become a NaN of them.
TEST(DecodeGBuffer, HalfNormalsWithoutALengthStayZero) {
    const Gpu gpu = test_gpu();
    const KernelFeatures features = features_of(GBUFFER_HALF);
    Synthetic image =
        make_synthetic(make_view(ViewShape{17, 5}), features, noise_depth(0.3, 60.0, 0.2, 3));
    for (const uint i : {0u, 1u, 2u}) {
        std::uint16_t* plane = image.plane<std::uint16_t>(PLANE_NORMAL_X + i);
        std::fill(plane, plane + image.view.stride * image.view.height, std::uint16_t{0});
    }
    const Planes planes = decode(gpu, features, upload_gbuffer(gpu, image));
    for_drawn(image, [&](uint x, uint y) {
        EXPECT_EQ(planes.vector(SURFACE_NORMAL, x, y), glm::dvec3(0.0)) << x << ", " << y;
    });
}

}  // namespace
}  // namespace kilolux
