// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/interop/gbuffer_bridge.h"
#include "host/picture/decoded_surfaces.h"
#include "host/picture/pixel_probe.h"
#include "host/render/path.h"
#include "host/stages/decode_gbuffer.h"
#include "raster/geometry_pass.h"

namespace kilolux {

/// The scene's surfaces: drawn by OpenGL, on the OpenCL device, and decoded.
class SurfacePass {
 public:
    explicit SurfacePass(const PathContext& context);

    /// Draws the G-buffer of the band's raster tile, unless it is there from the last call, and
    /// brings the band to the device, where it stays until the next call; lights are not read.
    /// Waits for OpenGL. Adds the stages geometry and gbuffer_bridge to `stages`.
    GBuffer draw(const Sample& sample, std::vector<StageTime>& stages);

    /// The surfaces of the last draw() on the host. Blocks.
    DecodedSurfaces decode(const GBuffer& gbuffer, const ClusterGrid& grid);

    /// The surface and the coarse cluster of one pixel of the last draw(). Blocks.
    PixelProbe probe(const GBuffer& gbuffer, const ClusterGrid& grid, int x, int y);

    const GBufferTargets& targets() const { return geometry_.targets(); }

 private:
    PathContext context_;
    GeometryPass geometry_;
    GBufferBridge bridge_;
    DecodeGBuffer decode_;
};

/// The coarse grid of a frame.
ClusterGrid coarse_grid(const PathContext& context, const Camera& camera, FrameStats& stats);

}  // namespace kilolux
