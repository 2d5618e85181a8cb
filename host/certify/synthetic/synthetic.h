// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host/certify/synthetic/vec3d.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"

namespace kilolux {

/// A camera in the terms of a lens: what make_view() turns into coefficients.
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

View make_view(const ViewShape& shape);

/// Depth buffer value of depth z [m] at the centre of pixel (x, y).
float depth01_of(const View& view, uint x, uint y, double z);

Vec3d view_from_world(const View& view, Vec3d v);
Vec3d world_from_view(const View& view, Vec3d v);

/// Depth z [m] of a pixel; NaN: background.
using DepthOf = std::function<double(uint x, uint y)>;

DepthOf noise_depth(double z0, double z1, double background, std::uint32_t seed);
DepthOf checkerboard_depth(double near, double far);
DepthOf slanted_depth(double near, double far, uint width);
DepthOf no_depth();

/// A G-buffer in host memory whose attributes are noise; the columns that pad a row look drawn.
struct Synthetic {
    View view{};
    GBufferLayout layout{};
    std::vector<std::byte> bytes;

    template <typename T>
    T* plane(uint index) {
        return reinterpret_cast<T*>(bytes.data() + layout.offset_bytes[index]);
    }
};

/// `features` says which planes there are. Normals face the camera for half of the pixels.
Synthetic make_synthetic(const View& view, const KernelFeatures& features, const DepthOf& depth,
                         std::uint32_t seed = 1);

GBuffer upload_gbuffer(const Gpu& gpu, const Synthetic& image);

}  // namespace kilolux
