// SPDX-License-Identifier: Apache-2.0
#include "host/render/samples.h"

#include <algorithm>
#include <cmath>

namespace kilolux {
namespace {

// The number of samples of a half after which tiles are judged: half as many again each time.
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

void add_times(const Gpu& gpu, StageTimer& timer, FrameStats& stats) {
    for (const StageTimer::Time& time : timer.take()) {
        add_stage_time(stats.stages, time.stage, time.ms);
    }
    add_stage_time(stats.stages, kLaunchStage, timer.launch_ms());
    add_stage_time(stats.stages, kEnqueueStage, timer.enqueue_ms());
    stats.build_ms += timer.build_ms() + timer.first_launch_ms();
    // The wait is over: nothing is said about it.
    gpu.programs->add_build_time(1e-3 * timer.first_launch_ms());
}

void Samples::begin(const PictureKey& key, int refining) {
    key_ = key;
    const RenderSettings& settings = key.settings;
    const bool partly =
        settings.samples > 1 && !settings.auto_samples.on && settings.want.view == ViewKind::lit;
    refining_ = partly ? std::min(refining, settings.samples) : 0;
    summed_ = refining_ > 0 && kept_ == key && kept_count_ < refining_ ? kept_count_ : 0;
    kept_.reset();  // a frame that fails leaves no sum
}

void Samples::keep() {
    if (refining_ == 0) return;
    kept_ = key_;
    kept_count_ = refining_;
}

void Samples::begin_band() {
    lit_ = summed_;
    if (key_.settings.auto_samples.on) {
        if (!until_error_) until_error_.emplace(gpu_, tuning_);
        until_error_->clear();
        taken_ = added_ = 0;
        half_ = number_ = 0;
        goal_ = next_goal(0, key_.settings.auto_samples.most / 2);
        is_enough_ = has_centre_again_ = false;
        needed_.reset();
        centre_.reset();
    } else if (!is_one()) {
        if (!sum_) sum_.emplace(gpu_, tuning_);
        if (summed_ == 0) sum_->clear();
    }
}

std::optional<Samples::Next> Samples::next() {
    const RenderSettings& settings = key_.settings;
    if (settings.auto_samples.on) {
        if (!is_enough_) return Next{number_++, needed_ ? &*needed_ : nullptr};
        const FrameRequest& want = settings.want;
        if (has_centre_again_ || !(want.pixels() || want.probes || want.counts)) return {};
        has_centre_again_ = true;
        return Next{};
    }
    const int count = refining_ > 0 ? refining_ : std::max(settings.samples, 1);
    if (lit_ == count) return {};
    const int number = refining_ > 0 ? lit_ : count - 1 - lit_;
    ++lit_;
    return Next{static_cast<uint>(number), nullptr};
}

void Samples::add(const Radiance& light, Measured out) {
    if (key_.settings.auto_samples.on) return add_until_error(light, out);
    sum_->add(light, out.timer);
    add_times(gpu_, out.timer, out.stats);  // lists of the next sample may be made twice
}

void Samples::add_until_error(const Radiance& light, Measured out) {
    if (is_enough_) return;  // sample 0 is made once more
    until_error_->add(half_, light, out.timer);
    add_times(gpu_, out.timer, out.stats);  // lists of the next sample may be made twice
    if (!centre_) centre_ = out.stats;
    if (++added_ < goal_ - taken_) return;
    added_ = 0;
    half_ = 1 - half_;
    if (half_ == 0) decide(out);
}

// Whether both halves' means are good enough everywhere.
void Samples::decide(Measured out) {
    const AutoSamples& wanted = key_.settings.auto_samples;
    const float floor = kSampleErrorFloor * std::exp2(-key_.settings.exposure);
    taken_ = goal_;
    until_error_->decide(wanted.error, floor, out.timer);
    needed_ = needed_tiles(*until_error_);
    goal_ = next_goal(taken_, wanted.most / 2);
    is_enough_ = taken_ >= wanted.most / 2 || !std::ranges::count(needed_->open.open, true);
    if (!is_enough_) return;
    centre_->stages = std::move(out.stats.stages);
    out.stats = std::move(*centre_);
    out.stats.samples = counts_of(*until_error_);
}

Radiance Samples::mean(const Radiance& last, StageTimer& timer) {
    if (is_one()) return last;
    return key_.settings.auto_samples.on ? until_error_->mean(timer) : sum_->mean(timer);
}

void Samples::add_counts(DecodedSurfaces& surfaces) const {
    if (!key_.settings.auto_samples.on) return;
    surfaces.variance = download(gpu_, until_error_->variance());
    surfaces.taken = until_error_->taken();
}

}  // namespace kilolux
