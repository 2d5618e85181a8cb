// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/gbuffer.h"

namespace kilolux {

enum class SurfaceKind : std::uint8_t {
    background,  // nothing was hit: the pixel is 0
    lit,
    unlit,  // the pixel is its emissive radiance
};

/// A pixel's surface, in double: a decoded G-buffer pixel or the hit of a cast ray.
struct SurfaceSample {
    glm::dvec3 position{0.0};          // [m], view space
    glm::dvec3 normal{0.0, 0.0, 1.0};  // unit, view space
#define SAMPLE_VECTOR(has, member, decoded, plane, value) glm::dvec3 member{value};
#define SAMPLE_SCALAR(has, member, decoded, plane, value) double member = value;
    SURFACE_VALUES(SAMPLE_VECTOR, SAMPLE_SCALAR)
#undef SAMPLE_VECTOR
#undef SAMPLE_SCALAR
    double coverage = 1.0;  // the share of what is behind that it covers: its material's alpha
    bool blended = false;   // whether anything behind is seen through it
    SurfaceKind kind = SurfaceKind::background;
    std::uint32_t instance = 0;  // of the scene, where a ray hit
    std::uint32_t triangle = 0;  // of the instance's mesh
};

/// Row 0 on top.
struct SurfaceSamples {
    int width = 0;                      // [pixel]
    int height = 0;                     // [pixel]
    std::vector<SurfaceSample> pixels;  // width * height
    SurfaceSample& at(int x, int y) { return pixels[index(x, y)]; }
    const SurfaceSample& at(int x, int y) const { return pixels[index(x, y)]; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

/// All background.
inline SurfaceSamples make_surface_samples(int width, int height) {
    SurfaceSamples out{.width = width, .height = height, .pixels = {}};
    out.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return out;
}

}  // namespace kilolux
