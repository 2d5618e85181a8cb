// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host/certify/synthetic/random.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "kernels/shared/gbuffer.h"

namespace kilolux {

inline glm::dvec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

/// A camera by its lens; make_view() computes the coefficients.
struct ViewShape {
    uint width = 64;
    uint height = 48;
    double half_x = 0.8;  // half the image at z = 1; orthographic: [m]
    double half_y = 0.6;
    double shift_x = 0.0;  // of the image's centre, likewise
    double shift_y = 0.0;
    double near = 0.1;       // [m]
    double far = 100.0;      // [m], orthographic only: perspective depth reaches to infinity
    double oblique_x = 0.0;  // 1/z grows by this over the image's width
    double oblique_y = 0.0;
    bool orthographic = false;
    bool rotated = true;  // else view space and camera-relative world space are one
};

/// A shape whose pixels are square.
ViewShape square_pixels(uint width, uint height);

View make_view(const ViewShape& shape);

/// The point of view space at depth z [m] and pixel position (px, py), pixel centres at 0.5.
glm::dvec3 position_at(const View& view, double px, double py, double z);

/// Depth buffer value of depth z [m] at the centre of pixel (x, y).
float depth01_of(const View& view, uint x, uint y, double z);

/// Directions, and camera-relative positions.
glm::dvec3 view_from_world(const View& view, const glm::dvec3& v);
glm::dvec3 world_from_view(const View& view, const glm::dvec3& v);

/// Depth z [m] of a pixel; NaN: background.
using DepthOf = std::function<double(uint x, uint y)>;

DepthOf noise_depth(double z0, double z1, double background, std::uint32_t seed);
DepthOf checkerboard_depth(double near, double far);
DepthOf slanted_depth(double near, double far, uint width);
DepthOf no_depth();

/// A G-buffer in host memory. Columns that pad a row look drawn.
struct Synthetic {
    View view{};
    GBufferLayout layout{};
    std::vector<std::byte> bytes;

    template <typename T>
    T* plane(uint index) {
        return reinterpret_cast<T*>(bytes.data() + layout.offset_bytes[index]);
    }
    /// Stores a value in a plane of floats, or of halves in GBUFFER_HALF.
    void put(uint plane_index, std::size_t pixel, double value);
    void put(uint first_plane, std::size_t pixel, const glm::dvec3& value);
    /// Whether the pixel shows a surface.
    bool shows_surface(uint x, uint y) const;
    /// y * width + x of the pixels that show a surface.
    std::vector<uint> surface_pixels() const;
};

/// Attributes are noise; `features` says which planes there are. Half of the normals face the
/// camera.
Synthetic make_synthetic(const View& view, const KernelFeatures& features, const DepthOf& depth,
                         std::uint32_t seed = 1);

GBuffer upload_gbuffer(const Gpu& gpu, const Synthetic& image);

/// Decoded planes on the host.
struct Planes {
    View view{};
    std::vector<float> values;

    float at(uint plane, uint x, uint y) const {
        const std::size_t size = std::size_t{view.stride} * view.height;
        return values[plane * size + std::size_t{y} * view.stride + x];
    }
    glm::dvec3 vector(uint plane, uint x, uint y) const {
        return {at(plane, x, y), at(plane + 1, x, y), at(plane + 2, x, y)};
    }
};

Planes decode(const Gpu& gpu, const KernelFeatures& features, const GBuffer& gbuffer);

/// A point light of `range` [m] at a camera-relative world position.
Light point_light(const glm::dvec3& position, double range,
                  const glm::dvec3& intensity = {1, 1, 1});

/// A spot light towards unit `axis` with half angles [rad].
Light spot_light(const Light& point, glm::dvec3 axis, double inner, double outer);

/// How random_lights() draws.
struct RandomLightOptions {
    std::uint32_t count = 100;
    double z_near = 0.2;  // depths of the lights, log-uniform [m]
    double z_far = 60.0;
    double range_min = 0.05;  // log-uniform [m]
    double range_max = 5.0;
    double spots = 0.0;   // share of spot lights
    double spread = 1.3;  // 1: as wide as the image
    std::uint32_t seed = 7;
};

/// Lights in and around the frustum of a perspective view (or the box of an orthographic one).
std::vector<Light> random_lights(const View& view, const RandomLightOptions& mix);

LightInput upload_lights(const Gpu& gpu, const std::vector<Light>& lights,
                         const std::vector<DirectionalLight>& directional = {});

}  // namespace kilolux
