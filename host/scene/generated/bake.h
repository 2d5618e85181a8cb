// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// A material at one point of its texture.
struct Texel {
    glm::dvec3 color{0.5};   // sRGB-encoded base colour, 0..1
    double height = 0.0;     // [m] above the surface
    double roughness = 1.0;  // perceptual, 0..1
};

/// The images of a material; those left out have no pixels.
struct SurfaceImages {
    std::string name;
    Image base_color;  // sRGB
    Image normal;      // linear, tangent space, +Y up in the image
    Image roughness;   // linear; G roughness, B metallic = 0
};

/// Which images to make of a texel function.
struct BakeOptions {
    std::string name;
    int size = 512;       // [pixel], both ways
    double metres = 1.0;  // that the texture covers
    bool base_color = true;
    bool normal = false;
    bool roughness = false;
};

/// Evaluates `texel` at the centres of size x size pixels, (u, v) in [0, 1), v downwards. When the
/// function has period 1 in both, the images tile, the normal map included.
SurfaceImages bake(const BakeOptions& options,
                   const std::function<Texel(double u, double v)>& texel);

/// Tangent-space normal map of a tiling height field [m] of size x size, `metres` wide.
Image normal_map(const std::string& name, const std::vector<float>& heights, int size,
                 double metres);

}  // namespace kilolux
