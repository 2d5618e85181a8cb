// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/picture/decoded_surfaces.h"
#include "host/render/lit_band.h"
#include "host/render/settings.h"
#include "host/stages/picture/adaptive_samples.h"
#include "host/stages/picture/sum_samples.h"

namespace kilolux {

/// Adds what the timer measured to the frame's stages.
void add_times(const Gpu& gpu, StageTimer& timer, FrameStats& stats);

/// The inputs that decide a picture.
struct PictureKey {
    RenderSettings settings;
    Camera camera;
    double time = 0.0;  // [s]
    SceneRevisions scene;
    bool operator==(const PictureKey&) const = default;
};

/// The samples of a picture's pixels, and their mean. Counts, AOVs and views are those of sample 0,
/// through the pixels' centres, since depths, ids and unit vectors have no mean. With a fixed
/// number of samples it comes last. Where each tile decides the number it comes first, and once
/// more at the end for AOVs and views of all tiles.
class Samples {
 public:
    struct Next {
        uint number = 0;
        const NeededTiles* needed = nullptr;  // none: all
    };

    Samples(const Gpu& gpu, const Tuning& tuning) : gpu_(gpu), tuning_(tuning) {}

    /// Begins a picture. `refining` above 0: the mean of only the first of settings.samples, in one
    /// band; the samples that the last picture summed are kept where it has the same key.
    void begin(const PictureKey& key, int refining);

    /// Of the last begin().
    const PictureKey& key() const { return key_; }

    /// Begins a band.
    void begin_band();

    /// The next sample of the band; none: all are done.
    std::optional<Next> next();

    /// Adds its light, and the times so far to the stats. Only where is_one() is false.
    void add(const Radiance& light, Measured out);

    /// Whether there is only sample 0, whose light then is the mean.
    bool is_one() const { return !key_.settings.auto_samples.on && key_.settings.samples <= 1; }

    /// The mean of the band's samples; `last`: the light of the last one. Enqueues only.
    Radiance mean(const Radiance& last, StageTimer& timer);

    /// Marks the picture as complete: its sum may be refined.
    void keep();

    /// With auto_samples, sets the counts of the last band, which AOVs show. Blocks.
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
    std::optional<PictureKey> kept_;              // the picture whose first samples sum_ has
    int kept_count_ = 0;
    // Of the band.
    int lit_ = 0;  // samples that next() gave
    // With auto_samples: each half of the samples has `taken_`, and goes on to `goal_`.
    int taken_ = 0, goal_ = 0, added_ = 0;
    uint half_ = 0, number_ = 0;
    bool is_enough_ = false, has_centre_again_ = false;
    std::optional<NeededTiles> needed_;
    std::optional<FrameStats> centre_;  // of sample 0
};

}  // namespace kilolux
