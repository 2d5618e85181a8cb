// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/synthetic.h"

#include <cmath>
#include <limits>

#include "host/base/gbuffer_layout.h"
#include "host/base/half.h"
#include "host/certify/synthetic/probe.h"

namespace kilolux {
namespace {

constexpr double kBackground = std::numeric_limits<double>::quiet_NaN();

float4 row_of(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f};
}

void set_rotation(View& view, bool rotated) {
    const Vec3d forward = rotated ? normalized({0.36, -0.48, -0.8}) : Vec3d{0, 0, -1};
    const Vec3d right = normalized(cross(forward, rotated ? Vec3d{0.1, 1, 0} : Vec3d{0, 1, 0}));
    view.view_from_world_x = row_of(right);
    view.view_from_world_y = row_of(cross(right, forward));
    view.view_from_world_z = row_of(forward * -1.0);
}

// A hash of a pixel in [0, 1).
double pixel_noise(uint x, uint y, std::uint32_t seed) {
    std::uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return (h ^ (h >> 15)) / 4294967296.0;
}

void fill_depth(Synthetic& image, const DepthOf& depth) {
    const View& view = image.view;
    auto* plane = image.plane<float>(PLANE_DEPTH);
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.stride; ++x) {
            const double z = x < view.width ? depth(x, y) : 1.0;
            plane[y * view.stride + x] = std::isnan(z) ? 0.0f : depth01_of(view, x, y, z);
        }
    }
}

// World position in halves, as GBUFFER_HALF keeps them, or view position in floats.
void fill_position(Synthetic& image, uint pixel, Vec3d p) {
    if (image.layout.layout == GBUFFER_FULL) {
        image.plane<float>(PLANE_POSITION_X)[pixel] = static_cast<float>(p.x);
        image.plane<float>(PLANE_POSITION_Y)[pixel] = static_cast<float>(p.y);
        image.plane<float>(PLANE_POSITION_Z)[pixel] = static_cast<float>(p.z);
        return;
    }
    const float4 camera = image.view.camera_position;
    const Vec3d world = world_from_view(image.view, p) + Vec3d{camera.x, camera.y, camera.z};
    image.plane<std::uint16_t>(PLANE_POSITION_X)[pixel] = half_bits_clamped(world.x);
    image.plane<std::uint16_t>(PLANE_POSITION_Y)[pixel] = half_bits_clamped(world.y);
    image.plane<std::uint16_t>(PLANE_POSITION_Z)[pixel] = half_bits_clamped(world.z);
}

void fill_normal(Synthetic& image, uint pixel, Vec3d n) {
    for (uint axis = 0; axis < 3; ++axis) {
        const double value = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
        if (image.layout.layout == GBUFFER_FULL) {
            image.plane<float>(PLANE_NORMAL_X + axis)[pixel] = static_cast<float>(value);
        } else {
            image.plane<std::uint16_t>(PLANE_NORMAL_X + axis)[pixel] = half_bits_clamped(value);
        }
    }
}

// Positions, normals and float attributes of the layouts that store them.
void fill_floats(Synthetic& image, const DepthOf& depth, Random& random) {
    const View& view = image.view;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.stride; ++x) {
            const uint pixel = y * view.stride + x;
            const double z = x < view.width ? depth(x, y) : 1.0;
            const double s = view.orthographic != 0 ? 1.0 : z;
            const Vec3d p{((x + 0.5) * view.ray.x + view.ray.y) * s,
                          ((y + 0.5) * view.ray.z + view.ray.w) * s, -z};
            fill_position(image, pixel, std::isnan(z) ? Vec3d{} : p);
            fill_normal(image, pixel, random.direction());
            if (image.layout.layout != GBUFFER_FULL) continue;
            for (uint plane = PLANE_ALBEDO_R; plane < PLANE_COUNT; ++plane) {
                if (image.layout.offset_bytes[plane] == PLANE_ABSENT) continue;
                image.plane<float>(plane)[pixel] = static_cast<float>(random.unit());
            }
        }
    }
}

}  // namespace

View make_view(const ViewShape& s) {
    View view{};
    view.width = s.width;
    view.height = s.height;
    view.stride = (s.width + 15) / 16 * 16;
    view.orthographic = s.orthographic ? 1 : 0;
    view.ray = {
        static_cast<float>(2 * s.half_x / s.width), static_cast<float>(s.shift_x - s.half_x),
        static_cast<float>(-2 * s.half_y / s.height), static_cast<float>(s.shift_y + s.half_y)};
    view.depth = {static_cast<float>(s.orthographic ? s.near - s.far : 1 / s.near),
                  static_cast<float>(s.oblique_x / s.width),
                  static_cast<float>(s.oblique_y / s.height),
                  static_cast<float>(s.orthographic ? s.far : 0.0)};
    view.camera_position = {0.25f, -0.5f, 0.125f, 0.0f};
    set_rotation(view, s.rotated);
    return view;
}

float depth01_of(const View& view, uint x, uint y, double z) {
    const double q = view.orthographic != 0 ? z : 1.0 / z;
    const double rest = (x + 0.5) * view.depth.y + (y + 0.5) * view.depth.z + view.depth.w;
    return static_cast<float>((q - rest) / view.depth.x);
}

Vec3d view_from_world(const View& view, Vec3d v) {
    const float4 x = view.view_from_world_x;
    const float4 y = view.view_from_world_y;
    const float4 z = view.view_from_world_z;
    return {x.x * v.x + x.y * v.y + x.z * v.z, y.x * v.x + y.y * v.y + y.z * v.z,
            z.x * v.x + z.y * v.y + z.z * v.z};
}

Vec3d world_from_view(const View& view, Vec3d v) {
    const float4 x = view.view_from_world_x;
    const float4 y = view.view_from_world_y;
    const float4 z = view.view_from_world_z;
    return {x.x * v.x + y.x * v.y + z.x * v.z, x.y * v.x + y.y * v.y + z.y * v.z,
            x.z * v.x + y.z * v.y + z.z * v.z};
}

DepthOf noise_depth(double z0, double z1, double background, std::uint32_t seed) {
    return [=](uint x, uint y) {
        if (pixel_noise(x, y, seed) < background) return kBackground;
        const double t = pixel_noise(x, y, seed + 1);
        return z0 > 0 ? z0 * std::pow(z1 / z0, t) : z0 + (z1 - z0) * t;
    };
}

DepthOf checkerboard_depth(double near, double far) {
    return [=](uint x, uint y) { return (x + y) % 2 == 0 ? near : far; };
}

DepthOf slanted_depth(double near, double far, uint width) {
    return
        [=](uint x, uint y) { return near + (far - near) * (x + 0.37 * (y % 8)) / (width + 3.0); };
}

DepthOf no_depth() {
    return [](uint, uint) { return kBackground; };
}

Synthetic make_synthetic(const View& view, const KernelFeatures& features, const DepthOf& depth,
                         std::uint32_t seed) {
    GBufferNeeds needs;
    static_cast<SceneFeatures&>(needs) = features;
    needs.layout = features.gbuffer;
    needs.emissive_scale = 2.5f;
    Synthetic image{view, make_gbuffer_layout(needs, view.stride, view.height), {}};
    image.bytes.resize(gbuffer_bytes(image.layout, view.stride, view.height));
    Random random(seed);
    for (std::byte& b : image.bytes) b = static_cast<std::byte>(random.bits() >> 24);
    fill_depth(image, depth);
    const bool stores_positions =
        features.gbuffer == GBUFFER_FULL || features.gbuffer == GBUFFER_HALF;
    if (stores_positions) fill_floats(image, depth, random);
    return image;
}

GBuffer upload_gbuffer(const Gpu& gpu, const Synthetic& image) {
    return {new_buffer(gpu, image.bytes), image.layout, image.view};
}

}  // namespace kilolux
