// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/lighting/coarse_light_lists.h"
#include "host/stages/lists/bin_pixels.h"
#include "host/stages/lists/count_pairs.h"
#include "host/stages/lists/refine_lights.h"
#include "host/stages/tails/cut_light_tree.h"

namespace kilolux {

/// The lists of one frame, on the device. Valid until the next LightLists::enqueue().
struct ListedLights {
    ClusterGrid grid{};
    PreparedLights lights;
    ClusterBoxes boxes;
    CoarseLists coarse;
    ActiveClusters clusters;
    RefinedLists refined;
    std::uint64_t version = 0;  // the same only where the lists are; 0: none

    /// With the G-buffer that they were made for.
    LitPixels at(const GBuffer& gbuffer) const { return {gbuffer, lights, clusters, refined}; }
};

/// The versions of the inputs that lists were made from.
struct ListSource {
    std::uint64_t gbuffer = 0;  // version; 0: not known
    std::uint64_t more = 0;     // that of more pixels; 0: there are none
    std::uint64_t lights = 0;   // version; 0: not known
    uint seed = 0;              // of random ranges
    ClusterGrid grid{};

    /// Whether both have known versions and are the same.
    bool matches(const ListSource& other) const;
};

class LightLists;

/// Further pixels, whose clusters coarse lists must cover, too.
struct MorePixels {
    LightLists* maker = nullptr;  // that will list them by enqueue_sharing(); null: there are none
    GBuffer gbuffer;              // has a version where that of the first pixels has one
};

/// The lists that light one pixel, on the host.
struct PixelLists {
    uint coarse_count = 0;                // lights in its coarse cluster's list
    std::optional<ActiveCluster> active;  // none: background
    std::vector<uint> lights;             // its active cluster's list
};

/// Finds out which lights each pixel needs. The stages in their order are BinPixels, PrepareLights,
/// BuildClusters, CullLights, RefineLights, and CutLightTree for lights in a tree. Lists have as
/// many entries as there are pairs. The stages work with the room of earlier frames; where that was
/// too little, fits() says so and they run again:
///
///     do {
///         lists = {};  // arrays that grow must not be held twice
///         lists = light_lists.enqueue(lights, gbuffer, grid, timer);
///         ...          // what reads them
///     } while (!light_lists.fits(timer));
class LightLists {
 public:
    LightLists(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Whether enqueue() would return its last lists.
    bool has_made(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                  const MorePixels& more = {}) const;

    /// Whether fits() has found the last enqueue()'s lists complete.
    bool are_complete() const { return made_ && is_checked_; }

    /// Also lists the lights of coarse clusters without pixels: for tests.
    void list_everywhere() {
        everywhere_ = true;
        made_.reset();
    }

    /// Enqueues the stages. Active clusters are kept while gbuffer.version and the grid stay, lists
    /// while input.version and its seed do, too. Valid until the next call. Throws Error when the
    /// device cannot hold the lists.
    ListedLights enqueue(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                         StageTimer& timer, const MorePixels& more = {});

    /// Lists of the MorePixels of the enqueue() that returned `others`; uses its coarse lists.
    ListedLights enqueue_sharing(const ListedLights& others, const GBuffer& gbuffer,
                                 StageTimer& timer);

    /// Releases the last lists. They hold coarse lists of another maker, which would be there twice
    /// while they grow.
    void forget();

    /// Enqueues the counting that fits() waits for: what is enqueued in between keeps the device
    /// busy meanwhile. Without it fits() does so itself.
    void start_count(StageTimer& timer);

    /// False where the last enqueue()'s lists had no room; the next one makes it. Waits for the
    /// counts: asked once a frame.
    bool fits(StageTimer& timer);

    /// Repeats both until the lists are complete; the timer gets the stages of the last time.
    /// Blocks.
    ListedLights run(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid,
                     StageTimer& timer);

    /// Counts of the last lists that fitted; of enqueue_sharing() without the sums
    /// over clusters.
    const PairCounts& counts() const { return counts_; }

    /// What `lists` have for the pixel (x, y) of the G-buffer, which has depth z > 0. Blocks.
    PixelLists at_pixel(const ListedLights& lists, const View& view, uint x, uint y, float z) const;

    /// The active clusters of the last lists that fitted. Blocks.
    std::vector<ActiveCluster> active_clusters(const ListedLights& lists) const;

 private:
    bool is_made_of(const ListSource& source) const;
    template <typename Make>
    ListedLights kept_or_made(const ListSource& source, const Make& make);
    void find_clusters(const GBuffer& gbuffer, const ClusterGrid& grid,
                       const DeviceArray<std::uint8_t>& occupied, StageTimer& timer);
    bool is_binned(const GBuffer& gbuffer, const ClusterGrid& grid) const;
    ActiveClusters active_of(const GBuffer& gbuffer, const ClusterGrid& grid,
                             const DeviceArray<std::uint8_t>& occupied, StageTimer& timer);
    ListedLights refined(const CoarseLighting& coarse, const ActiveClusters& active,
                         const GBuffer& gbuffer, StageTimer& timer);
    bool is_complete(const ListedLights& lists) const;
    void grow();

    Gpu gpu_;
    int index_bits_;
    bool everywhere_ = false;
    CoarseLightLists coarse_;
    BinPixels bin_;
    RefineLights refine_;
    std::optional<CutLightTree> cut_;  // with a light tree
    CountPairs count_;
    PairCounts counts_{};
    uint refine_room_ = 0;                    // entries, of the last enqueue()
    bool has_cuts_ = false;                   // likewise
    bool needs_room_ = false;                 // more than there is
    bool had_coarse_room_ = false;            // then
    bool shares_coarse_ = false;              // the last lists are those of enqueue_sharing()
    std::optional<ActiveClusters> clusters_;  // of find_clusters()
    // Of the last clusters that were complete.
    std::uint64_t binned_version_ = 0;
    ClusterGrid binned_grid_{};
    ActiveClusters active_;
    // Of the last enqueue().
    std::uint64_t version_ = 0;
    ListSource made_of_;
    std::optional<ListedLights> made_;
    bool is_checked_ = false;   // made_ is complete
    bool is_counting_ = false;  // since start_count()
};

}  // namespace kilolux
