// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/synthetic.h"

#include <cmath>
#include <limits>

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/formats/half.h"
#include "host/certify/synthetic/probe.h"
#include "host/stages/surfaces/decode_gbuffer.h"

namespace kilolux {
namespace {

constexpr double kBackground = std::numeric_limits<double>::quiet_NaN();

float4 row_of(const glm::dvec3& v, double w = 0.0) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

void set_rotation(View& view, bool rotated) {
    const glm::dvec3 forward =
        glm::normalize(rotated ? glm::dvec3(0.36, -0.48, -0.8) : glm::dvec3(0, 0, -1));
    const glm::dvec3 right =
        glm::normalize(glm::cross(forward, glm::dvec3(rotated ? 0.1 : 0.0, 1, 0)));
    view.view_from_world_x = row_of(right);
    view.view_from_world_y = row_of(glm::cross(right, forward));
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

// Positions, normals and attributes of the layouts that store them: view positions in GBUFFER_FULL,
// world positions in GBUFFER_HALF.
void fill_values(Synthetic& image, const DepthOf& depth, Random& random) {
    const View& view = image.view;
    const bool full = image.layout.layout == GBUFFER_FULL;
    const glm::dvec3 camera = xyz(view.camera_position);
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.stride; ++x) {
            const std::size_t pixel = std::size_t{y} * view.stride + x;
            const double z = x < view.width ? depth(x, y) : 1.0;
            glm::dvec3 p(0.0);
            if (!std::isnan(z)) p = position_at(view, x + 0.5, y + 0.5, z);
            if (!full) p = world_from_view(view, p) + camera;
            image.put(PLANE_POSITION_X, pixel, p);
            const glm::dvec3 normal = random.direction();
            image.put(PLANE_NORMAL_X, pixel, normal);
            if (!full) continue;
            for (uint plane = PLANE_ALBEDO_R; plane < PLANE_COUNT; ++plane) {
                const bool stored = image.layout.offset_bytes[plane] != PLANE_ABSENT;
                if (stored) image.put(plane, pixel, random.unit());
            }
            const auto turn = [&](uint plane, const glm::dvec3& direction) {
                if (image.layout.offset_bytes[plane] == PLANE_ABSENT) return;
                image.put(plane, pixel, direction);
            };
            turn(PLANE_COAT_NORMAL_X, random.direction());
            turn(PLANE_TANGENT_X, glm::normalize(glm::cross(normal, random.direction())));
        }
    }
}

}  // namespace

void Synthetic::put(uint plane_index, std::size_t pixel, double value) {
    if (layout.layout == GBUFFER_HALF) {
        plane<std::uint16_t>(plane_index)[pixel] = half_bits_clamped(value);
    } else {
        plane<float>(plane_index)[pixel] = static_cast<float>(value);
    }
}

void Synthetic::put(uint first_plane, std::size_t pixel, const glm::dvec3& value) {
    for (int c = 0; c < 3; ++c) put(first_plane + static_cast<uint>(c), pixel, value[c]);
}

bool Synthetic::shows_surface(uint x, uint y) const {
    const std::byte* depth = bytes.data() + layout.offset_bytes[PLANE_DEPTH];
    return reinterpret_cast<const float*>(depth)[std::size_t{y} * view.stride + x] > 0.0f;
}

std::vector<uint> Synthetic::surface_pixels() const {
    std::vector<uint> pixels;
    for (uint i = 0; i < view.width * view.height; ++i) {
        if (shows_surface(i % view.width, i / view.width)) pixels.push_back(i);
    }
    return pixels;
}

ViewShape square_pixels(uint width, uint height) {
    ViewShape shape{width, height};
    shape.half_y = shape.half_x * height / width;
    return shape;
}

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

glm::dvec3 position_at(const View& view, double px, double py, double z) {
    const double s = view.orthographic != 0 ? 1.0 : z;
    return {(px * view.ray.x + view.ray.y) * s, (py * view.ray.z + view.ray.w) * s, -z};
}

glm::dvec3 view_from_world(const View& view, const glm::dvec3& v) {
    return {glm::dot(xyz(view.view_from_world_x), v), glm::dot(xyz(view.view_from_world_y), v),
            glm::dot(xyz(view.view_from_world_z), v)};
}

glm::dvec3 world_from_view(const View& view, const glm::dvec3& v) {
    return xyz(view.view_from_world_x) * v.x + xyz(view.view_from_world_y) * v.y +
           xyz(view.view_from_world_z) * v.z;
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
    if (features.gbuffer == GBUFFER_FULL || features.gbuffer == GBUFFER_HALF) {
        fill_values(image, depth, random);
    }
    return image;
}

GBuffer upload_gbuffer(const Gpu& gpu, const Synthetic& image) {
    return {new_buffer(gpu, image.bytes), image.layout, image.view};
}

Planes decode(const Gpu& gpu, const KernelFeatures& features, const GBuffer& gbuffer) {
    StageTimer timer;
    DecodeGBuffer stage(gpu, default_tuning(gpu.info), features);
    const cl::Buffer planes = stage.enqueue(gbuffer, timer);
    const View& view = gbuffer.view;
    return {view,
            download<float>(gpu, planes, std::size_t{SURFACE_PLANES} * view.stride * view.height)};
}

Light point_light(const glm::dvec3& position, double range, const glm::dvec3& intensity) {
    return point_light_rows(row_of(position, range), row_of(intensity, 0.0));
}

Light spot_light(const Light& point, glm::dvec3 axis, double inner, double outer) {
    Light light = point;
    const double cos_out = std::cos(outer);
    light.color_scale.w = static_cast<float>(1.0 / std::max(0.001, std::cos(inner) - cos_out));
    light.axis_cos = row_of(axis, cos_out);
    return light;
}

std::vector<Light> random_lights(const View& view, const RandomLightOptions& mix) {
    Random random(mix.seed);
    std::vector<Light> lights;
    const bool orthographic = view.orthographic != 0;
    while (lights.size() < mix.count) {
        const double z = orthographic ? random.uniform(mix.z_near, mix.z_far)
                                      : random.log_uniform(mix.z_near, mix.z_far);
        const double px = view.width * (0.5 + random.uniform(-0.5, 0.5) * mix.spread);
        const double py = view.height * (0.5 + random.uniform(-0.5, 0.5) * mix.spread);
        const glm::dvec3 intensity{random.uniform(0, 10), random.uniform(0, 10),
                                   random.uniform(0, 10)};
        const double range = random.log_uniform(mix.range_min, mix.range_max);
        const glm::dvec3 p = world_from_view(view, position_at(view, px, py, z));
        const Light point = point_light(p, range, intensity);
        const double outer = random.uniform(0.05, 1.57);
        const bool spot = random.unit() < mix.spots;
        lights.push_back(spot ? spot_light(point, random.direction(), outer * random.unit(), outer)
                              : point);
    }
    return lights;
}

LightInput upload_lights(const Gpu& gpu, const std::vector<Light>& lights,
                         const std::vector<DirectionalLight>& directional) {
    return {new_buffer(gpu, lights), static_cast<uint>(lights.size()), new_buffer(gpu, directional),
            static_cast<uint>(directional.size())};
}

}  // namespace kilolux
