// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/draw_list.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/raster_triangles.h"

namespace kilolux {

/// Draws in OpenCL which triangle each pixel shows, as IdsPass does in OpenGL: opaque and masked
/// surfaces; materials that blend are left out.
class TriangleIds {
 public:
    /// The scene must outlive this; its instances may move, its meshes must stay as many.
    TriangleIds(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                const SurfaceFeatures& features);

    /// The instances that the camera sees, sorted front to back and numbered. `open`: see DrawList.
    std::vector<Draw> visible(const Camera& camera, int width, int height,
                              const OpenTiles* open = nullptr) const;

    /// ids[view.height][view.stride], as ResolveSurfaces reads them. `scene`: of `draws`. Outside
    /// the tiles of `open` pixels may lack surfaces. Enqueues only, with the room of the last call:
    /// see fits(). Valid until the next call.
    DeviceArray<uint> enqueue(const SurfaceBuffers& scene, std::span<const Draw> draws,
                              const View& view, StageTimer& timer, const OpenTiles* open = nullptr);

    /// Starts to copy what fits() waits for, so that the device works on meanwhile. Enqueues only.
    void start_count(StageTimer& timer) { bin_.start_count(timer); }

    /// False where the last enqueue()'s ids lack triangles, as there was no room to list them; the
    /// next call has it. Blocks. Throws Error as BinTriangles::fits().
    bool fits();

    /// Repeats enqueue() until the lists have room. Blocks.
    DeviceArray<uint> draw(const SurfaceBuffers& scene, std::span<const Draw> draws,
                           const View& view, StageTimer& timer, const OpenTiles* open = nullptr);

    /// Triangles of the last enqueue(); pairs of triangle and tile as of the last fits().
    std::uint64_t triangles() const { return triangles_; }
    std::uint64_t pairs() const { return pairs_; }

 private:
    std::vector<std::uint8_t> closed_tiles(const View& view, const OpenTiles* open) const;

    const Scene& scene_;
    Tuning tuning_;
    DrawList draw_list_;
    BinTriangles bin_;
    RasterTriangles raster_;
    uint triangles_ = 0;
    std::uint64_t pairs_ = 0;
};

}  // namespace kilolux
