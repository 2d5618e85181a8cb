// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/render/coarse_stages.h"
#include "host/render/frame.h"
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

    /// Enqueues all of them with the room that earlier frames needed.
    LightLists enqueue(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                       StageTimer& timer);

    /// True if the lists of the last enqueue are complete; else room has grown: enqueue again.
    /// Blocks.
    bool fit();

    /// Sets the counts of the last enqueue, whose result is `lists`: pairs, active clusters, lights
    /// evaluated a pixel. Blocks.
    void count(const LightLists& lists, FrameStats& stats) const;

    /// The coarse lists of the last enqueue on the host. Blocks.
    HostCoarseLists download_coarse(const LightLists& lists) const;

 private:
    Gpu gpu_;
    CoarseStages coarse_;
    BinPixels bin_;
    RefineLights refine_;
};

}  // namespace kilolux
