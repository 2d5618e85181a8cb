// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/gpu/tuning/tuning_store.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace kilolux {

/// A G-buffer's surfaces in host memory, row 0 on top; `pixels` = width * height values, or three
/// times as many for vectors and colours.
struct HostSurfaces {
    int width = 0;                 // [pixel]
    int height = 0;                // [pixel]
    std::vector<float> depth;      // distance along the view direction [m]; <= 0: background
    std::vector<float> normal;     // 3: unit, world axes
    std::vector<float> albedo;     // 3: linear Rec. 709
    std::vector<float> roughness;  // perceptual
    std::vector<float> metallic;   // empty: none
    std::vector<float> emissive;   // 3: radiance; empty: none
};

/// The OpenCL half alone: lights surfaces that the caller has.
class GBufferLighting {
 public:
    /// `device`: as --device; `shading`: "lambert", "blinn-phong", "pbr".
    GBufferLighting(const std::string& device, const std::string& shading);

    struct Lit {
        std::vector<float> radiance;  // 3 * width * height
        std::vector<uint> evaluated;  // lights of each pixel's list; 0 for background
        std::vector<uint> covering;   // those whose range covers the pixel
    };
    /// Throws Error for sizes that do not fit, and as the stages do.
    Lit light(const HostSurfaces& surfaces, const Camera& camera, std::vector<SceneLight> lights,
              float ambient);

 private:
    GBufferLighting(const cl::Device& device, int shading);

    std::mutex mutex_;  // one call at a time: the queue is one
    KnownTuning known_;
    Gpu gpu_;
    int shading_;
};

}  // namespace kilolux
