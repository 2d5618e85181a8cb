// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/lighting/deferred_lighting.h"
#include "host/measure/photometry/measuring_points.h"
#include "host/render/lights/light_source.h"

namespace kilolux {

/// The illuminance of points by the renderer's own kernels: the points are the pixels of a G-buffer
/// of layout `full`, white and Lambertian, so that radiance times pi is illuminance. Lists are
/// those of a picture: a point costs as much as a pixel.
///
/// Pixels lie where the points do, not on rays of a camera: a frame holds 256 x 256 pixels, each
/// fine tile a group of neighbours. The coarse grid is one cluster, padded by the frame's size;
/// tiles have lists of their own, by the box of their points.
class PointLighting {
 public:
    /// `scene`: as ExactLighting has it; outlives this. Lights without a range reach every point.
    PointLighting(const Scene& scene, const RenderSettings& settings);

    /// The illuminance of each point [lx]. `order`: order_in_groups() of the points. Positions are
    /// float32 relative to the middle of a frame's points. Calls check_interrupt().
    std::vector<double> illuminance(std::span<const MeasuringPoint> points,
                                    std::span<const std::uint32_t> order);

    const DeviceInfo& device() const { return gpu_.info; }

 private:
    void light_frame(std::span<const MeasuringPoint> points, std::span<const std::uint32_t> frame,
                     std::vector<double>& out);

    RenderSettings settings_;  // of lights
    Gpu gpu_;
    Tuning tuning_;
    KernelFeatures features_;
    LightSource lights_;
    DeferredLighting lighting_;
    GrowingArray<std::byte> planes_;
};

}  // namespace kilolux
