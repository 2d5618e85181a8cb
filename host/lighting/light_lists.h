// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/lighting/coarse_stages.h"
#include "host/picture/frame.h"
#include "host/picture/pixel_probe.h"
#include "host/stages/bin_pixels.h"
#include "host/stages/refine_lights.h"

namespace kilolux {

/// What the list stages hand to shading.
struct LightLists {
    PreparedLights lights;
    ClusterBoxes boxes;
    CoarseLists coarse;
    ActiveClusters clusters;
    RefinedLists refined;
};

/// The stages that find out which lights each pixel needs, in their order.
class ListStages {
 public:
    ListStages(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Makes the coarse lists of clusters without pixels, too: for what blends, which is in no
    /// G-buffer.
    void list_everywhere() { everywhere_ = true; }

    /// Enqueues all of them with the room that earlier frames needed.
    LightLists enqueue(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                       StageTimer& timer);

    /// True if the lists of the last enqueue are complete; else room has grown: enqueue again.
    /// Blocks.
    bool fit();

    /// Sets the counts of the last enqueue, whose result is `lists`: pairs, active clusters, lights
    /// evaluated a pixel. Blocks.
    void count(const LightLists& lists, FrameStats& stats) const;

    /// Adds to a probe of a drawn pixel (x, y) its lists of the last enqueue, whose result is
    /// `lists`. Blocks.
    void probe(const LightLists& lists, const View& view, int x, int y, PixelProbe& probe) const;

    /// The active clusters of the last enqueue. Blocks.
    std::vector<ActiveCluster> clusters(const LightLists& lists) const;

    /// The coarse lists of the last enqueue on the host. Blocks.
    HostCoarseLists download_coarse(const LightLists& lists) const;

 private:
    Gpu gpu_;
    int index_bits_;
    bool everywhere_ = false;
    CoarseStages coarse_;
    BinPixels bin_;
    RefineLights refine_;
};

}  // namespace kilolux
