// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/render/lit_band.h"
#include "host/render/settings.h"
#include "host/stages/picture/adaptive_samples.h"
#include "host/stages/picture/sum_samples.h"

namespace kilolux {

/// Adds what the timer measured to the frame's stages.
void add_times(StageTimer& timer, FrameStats& stats);

/// What decides a picture.
struct PictureKey {
    RenderSettings settings;
    Camera camera;
    double time = 0.0;  // [s]
    SceneRevisions scene;
    bool operator==(const PictureKey&) const = default;
};

/// The samples of a picture's pixels, and their mean. Sample 0, through the pixels' centres, comes
/// last of a fixed number: counts, AOVs and views are its, since depths, ids and unit vectors have
/// no mean. Of a number that each tile decides it comes first; AOVs and views get it once more, of
/// all tiles.
class Samples {
 public:
    struct Next {
        uint number = 0;
        const NeededTiles* needed = nullptr;  // none: all
    };

    Samples(const Gpu& gpu, const Tuning& tuning) : gpu_(gpu), tuning_(tuning) {}

    /// Begins a picture. `refining` above 0: the mean of only the first of settings.samples, in one
    /// band; those that the last picture summed are kept where it has the same key.
    void begin(const PictureKey& key, int refining);

    /// Begins a band.
    void begin_band();

    /// The next sample of the band; none: all are lit.
    std::optional<Next> next();

    /// Adds it, and to the stats the times so far. Only where is_one() is false.
    void add(const Radiance& light, Measured out);

    /// Whether there is only sample 0, whose light is the mean.
    bool is_one() const { return !key_.settings.auto_samples.on && key_.settings.samples <= 1; }

    /// The mean of the band's samples; `last`: the light of the last one. Enqueues only.
    Radiance mean(const Radiance& last, StageTimer& timer);

    /// The picture was made: its sum may be refined.
    void keep();

    /// With auto_samples, of the last band: what AOVs show. Blocks.
    void add_counts(DecodedSurfaces& surfaces) const;

 private:
    void add_until_error(const Radiance& light, Measured out);
    void decide(Measured out);

    Gpu gpu_;
    Tuning tuning_;
    PictureKey key_;
    std::optional<SumSamples> sum_;               // made when first asked for
    std::optional<AdaptiveSamples> until_error_;  // likewise
    int refining_ = 0;                            // samples of a refined picture; 0: all
    int summed_ = 0;                              // of them in sum_ before
    std::optional<PictureKey> kept_;              // of which sum_ has the first samples
    int kept_count_ = 0;
    // Of the band.
    int lit_ = 0;  // samples that next() gave
    // Of auto_samples: each half of the samples has `taken_`, and goes on to `goal_`.
    int taken_ = 0, goal_ = 0, added_ = 0;
    uint half_ = 0, number_ = 0;
    bool is_enough_ = false, has_centre_again_ = false;
    std::optional<NeededTiles> needed_;
    std::optional<FrameStats> centre_;  // of sample 0
};

}  // namespace kilolux
