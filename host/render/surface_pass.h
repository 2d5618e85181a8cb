// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/interop/gbuffer_bridge.h"
#include "host/render/lit_band.h"
#include "host/render/render_context.h"
#include "host/stages/lists/mask_tiles.h"
#include "host/stages/shadows/shadow_origins.h"
#include "host/stages/surfaces/count_texels.h"
#include "host/surfaces/triangle_ids.h"
#include "raster/solid_pass.h"

namespace kilolux {

inline constexpr StageInfo kGeometryStage = {"geometry", StageGroup::surfaces};
inline constexpr StageInfo kShadowSceneStage = {"shadow_scene", StageGroup::shadows};

/// The scene's surfaces in a G-buffer on the OpenCL device: OpenGL or OpenCL draws triangle ids
/// that OpenCL resolves, or OpenGL the planes themselves (RenderSettings::geometry).
class SurfacePass {
 public:
    explicit SurfacePass(RenderContext& context);

    /// Draws the band's raster tile, unless it is there from the last call, and makes the band's
    /// G-buffer on the device, valid until the next call; lights are not read. Waits for OpenGL.
    /// Adds the stages geometry and gbuffer_bridge; resolve_surfaces goes to the timer. Does
    /// nothing where the last call made the same, unless settings.no_reuse. Where OpenCL draws,
    /// triangles may be missing: see fits().
    GBuffer enqueue(const Sample& sample, Measured out);

    /// Starts to copy what fits() waits for, so that the device works on meanwhile. Enqueues only.
    void start_count(StageTimer& timer) {
        if (!is_checked_) triangles_->start_count(timer);
    }

    /// False where the last enqueue() lacks triangles, since their lists had no room; the next call
    /// has it. Waits for the device.
    bool fits(FrameStats& stats);

    /// Repeats enqueue() until fits().
    GBuffer draw(const Sample& sample, Measured out);

    /// The shadow casters of the last enqueue()'s surfaces, and where their rays end; empty without
    /// shadows.
    ShadowInput shadows(const Sample& sample) const;

    /// OpenGL's targets; not where OpenCL draws.
    const GBufferTargets& targets() const { return planes_ ? planes_->targets() : ids_->targets(); }

 private:
    // The inputs of a G-buffer that may change between frames.
    struct Source {
        Camera camera;
        Band band;
        int width, height;
        std::array<std::uint32_t, 3> revision;  // of the scene's surfaces and their looks
        bool masked;  // some tiles are background though surfaces cover them
        bool operator==(const Source&) const = default;
    };
    GBuffer draw_planes(const Sample& sample, Measured out);
    GBuffer draw_ids(const Sample& sample, Measured out);
    GBuffer draw_in_opencl(const Sample& sample, Measured out);
    GBuffer resolve(const DeviceArray<uint>& all_ids, const SurfaceBuffers& scene, const View& view,
                    const Sample& sample, Measured out);
    void count(const DeviceArray<uint>& ids, const SurfaceBuffers& scene, const View& view,
               FrameStats& stats);
    void place_origins(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                       const GBuffer& gbuffer, const Sample& sample, Measured out);

    RenderContext& context_;
    std::optional<GeometryPass> planes_;
    std::optional<IdsPass> ids_;              // with Geometry::ids
    std::optional<TriangleIds> triangles_;    // with Geometry::compute
    std::optional<ResolveSurfaces> resolve_;  // of ids_ or triangles_
    std::optional<CountTexels> texels_;       // of the same, made when first asked for
    std::optional<ShadowOrigins> origins_;    // with shadows
    std::optional<MaskTiles> mask_;           // made when first asked for
    GBufferBridge bridge_;
    ShadowInput shadows_;
    std::optional<Source> source_;  // of gbuffer_
    bool is_checked_ = true;        // gbuffer_ is whole
    GBuffer gbuffer_;
};

}  // namespace kilolux
