// SPDX-License-Identifier: Apache-2.0
// The samples of a picture's pixels, and their mean.
#include <algorithm>
#include <cmath>

#include "host/base/interrupt.h"
#include "host/picture/sample_pattern.h"
#include "host/render/pipeline.h"

namespace kilolux {
namespace {

// Grows with every change of the scene.
std::uint32_t revision_of(const Scene& scene) { return scene.revision + scene.lights_revision; }

// Samples of a half after which tiles may be done: each time by half as many again.
int next_goal(int taken, int most) {
    if (taken == 0) return kLeastAutoSamples / 2;
    return std::min(taken + taken / 2, most);
}

NeededTiles needed_tiles(const AdaptiveSamples& samples) {
    const int columns = static_cast<int>(fine_tiles_x(samples.view()));
    return {samples.done(), {FINE_TILE, columns, 0, samples.open_tiles()}};
}

SampleCounts counts_of(const AdaptiveSamples& samples) {
    SampleCounts out;
    out.tiles = samples.tile_count();
    out.open_tiles = static_cast<std::uint64_t>(std::ranges::count(samples.open_tiles(), true));
    out.least = ~0u;
    for (const uint taken : samples.taken()) {
        if (taken == 0) continue;  // beyond the width
        out.total += taken;
        ++out.pixels;
        out.least = std::min(out.least, taken);
        out.most = std::max(out.most, taken);
    }
    return out;
}

}  // namespace

void add_times(StageTimer& timer, FrameStats& stats) {
    for (const StageTimer::Time& time : timer.take()) {
        add_stage_time(stats.stages, time.stage, time.ms);
    }
    add_stage_time(stats.stages, kLaunchStage, timer.launch_ms());
    add_stage_time(stats.stages, kEnqueueStage, timer.enqueue_ms());
}

// How many of the samples are wanted, and which of them the last frame has summed.
void Pipeline::refine(const Camera& camera, double time, int samples) {
    const bool partly = settings.samples > 1 && !settings.auto_samples.on && is_whole() &&
                        settings.want.view == ViewKind::lit;
    refining_ = partly ? std::min(samples, settings.samples) : 0;
    summed_ = 0;
    if (refining_ > 0 && refined_) {
        const Refined same{settings, camera, time, revision_of(scene->scene()), refined_->samples};
        if (*refined_ == same && refined_->samples < refining_) summed_ = refined_->samples;
    }
    refined_.reset();  // a frame that fails leaves no sum
}

void Pipeline::keep_refined(const Camera& camera, double time) {
    if (refining_ == 0) return;
    refined_ = Refined{settings, camera, time, revision_of(scene->scene()), refining_};
}

// A jittered sample.
Radiance Pipeline::light_sample(const Sample& band, uint number, const NeededTiles* needed,
                                Measured out) {
    check_interrupt();
    Camera jittered = band.camera;
    jittered.jitter += sample_offset(number);
    LightInput lights = band.lights;
    lights.seed = tail_seed(settings, number);
    const Sample sample{jittered, band.rows, lights, band.band, true, number, needed};
    return std::visit([&](auto& path) { return path.light(sample, out, [](const Radiance&) {}); },
                      path());
}

// The mean of the jittered samples. Sample 0, through the pixels' centres, comes last: counts, AOVs
// and views are its, since depths, ids and unit vectors have no mean.
void Pipeline::light_samples(const Sample& band, Measured out, const AfterShading& then) {
    if (settings.auto_samples.on) return light_until_error(band, out, then);
    if (settings.samples <= 1) {
        check_interrupt();
        std::visit([&](auto& path) { path.light(band, out, then); }, path());
        return;
    }
    if (!sum_) sum_.emplace(gpu, tuning_);
    const auto add = [&](int i) {
        sum_->add(light_sample(band, static_cast<uint>(i), nullptr, out), timer_);
        add_times(timer_, out.stats);  // lists of the next sample may be made twice
    };
    if (summed_ == 0) sum_->clear();
    if (refining_ > 0) {
        for (int i = summed_; i < refining_; ++i) add(i);
    } else {
        for (int i = settings.samples - 1; i >= 0; --i) add(i);
    }
    then(sum_->mean(timer_));
}

// Samples until the tiles' errors are small enough. Counts are those of sample 0, the first; AOVs
// and views get it once more, of all tiles.
void Pipeline::light_until_error(const Sample& band, Measured out, const AfterShading& then) {
    const AutoSamples& wanted = settings.auto_samples;
    const float floor = kSampleErrorFloor * std::exp2(-settings.exposure);
    if (!until_error_) until_error_.emplace(gpu, tuning_);
    until_error_->clear();
    std::optional<FrameStats> centre;
    std::optional<NeededTiles> needed;
    int taken = 0;
    uint number = 0;
    bool is_enough = false;
    while (!is_enough) {
        const int goal = next_goal(taken, wanted.most / 2);
        for (uint half = 0; half < 2; ++half) {
            for (int i = taken; i < goal; ++i) {
                const Radiance light =
                    light_sample(band, number++, needed ? &*needed : nullptr, out);
                until_error_->add(half, light, timer_);
                add_times(timer_, out.stats);  // lists of the next sample may be made twice
                if (!centre) centre = out.stats;
            }
        }
        taken = goal;
        until_error_->decide(wanted.error, floor, timer_);
        needed = needed_tiles(*until_error_);
        is_enough = taken >= wanted.most / 2 || !std::ranges::count(needed->open.open, true);
    }
    centre->stages = std::move(out.stats.stages);
    out.stats = std::move(*centre);
    out.stats.samples = counts_of(*until_error_);
    then(until_error_->mean(timer_));
    const FrameRequest& want = settings.want;
    if (want.pixels() || want.probes || want.counts) light_sample(band, 0, nullptr, out);
}

}  // namespace kilolux
