// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/roofline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/measure/roofline/stage_report.h"
#include "host/measure/roofline/stages.h"
#include "host/stages/shading/fill_background.h"
#include "host/stages/shading/instruction_counts.h"
#include "host/stages/shading/shade.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

// Round numbers, so that times can be worked out by hand.
DeviceLimits round_limits() {
    DeviceLimits l;
    l.lanes = 8;
    l.fma_flops = 2e11;
    l.one_lane_fma_flops = 2.5e10;
    l.lane_instructions_per_s = 1e11;
    l.rsqrt_per_s = 4e9;
    l.sqrt_per_s = 5e9;
    l.divisions_per_s = 8e9;
    l.texels_per_s = 2e9;
    l.read_bandwidth = 4e10;
    l.write_bandwidth = 2e10;
    l.copy_bandwidth = 3e10;
    l.cached_read_bandwidth = 1e11;
    l.cached_write_bandwidth = 1e11;
    l.cached_copy_bandwidth = 1e11;
    l.cache_bytes = 1e6;
    l.upload_bandwidth = 1e10;
    l.download_bandwidth = 2e10;
    l.launch_latency_ms = 0.01;
    l.launch_event_ms = 0.001;
    return l;
}

StageCounts some_counts() {
    StageCounts c;
    c.pixels = 1920.0 * 1080.0;
    c.surface_pixels = 2e6;
    c.lights = 5000.0;
    c.tiles = 8160.0;
    c.box_intervals = 500.0;
    c.clusters = 3456.0;
    c.coarse_pairs = 60000.0;
    c.active_clusters = 10000.0;
    c.refine_tests = 250000.0;
    c.refined_pairs = 40000.0;
    c.evaluations = 8e6;
    c.full_evaluations = 4e6;
    c.seen_triangles = 1e5;
    c.texels = 2e7;
    c.shadow_rays = 3e6;
    c.shadow_seen = 2e6;
    c.shadow_words = 3e5;
    return c;
}

TEST(Roofline, LimitIsTheGreatestBoundAndTheLaunches) {
    const DeviceLimits limits = round_limits();
    StageWork work;
    work.launches = 2;
    EXPECT_NEAR(stage_limit(work, limits).ms, 0.002, 1e-12);
    EXPECT_EQ(stage_limit(work, limits).bound, Bound::launches);
    work.instructions.total = 1e9;
    EXPECT_NEAR(stage_limit(work, limits).ms, 10.002, 1e-9);
    EXPECT_EQ(stage_limit(work, limits).bound, Bound::instructions);
    work.instructions.rsqrts = 8e7;
    work.instructions.divisions = 8e7;  // 20 + 10 ms
    EXPECT_NEAR(stage_limit(work, limits).ms, 30.002, 1e-9);
    EXPECT_EQ(stage_limit(work, limits).bound, Bound::special_functions);
    work.texels = 7e7;  // 35 ms
    EXPECT_NEAR(stage_limit(work, limits).ms, 35.002, 1e-9);
    EXPECT_EQ(stage_limit(work, limits).bound, Bound::texels);
    work.bytes_written = 1e9;  // 50 ms
    EXPECT_NEAR(stage_limit(work, limits).ms, 50.002, 1e-9);
    EXPECT_EQ(stage_limit(work, limits).bound, Bound::bytes);
    work.bytes_read = 4e9;  // 100 ms by itself; both at the best rate 125 ms
    EXPECT_NEAR(stage_limit(work, limits).ms, 125.002, 1e-9);
}

TEST(Roofline, WhatFitsTheCacheMovesAtItsRate) {
    StageWork work;
    work.bytes_read = 1e6;
    EXPECT_NEAR(stage_limit(work, round_limits()).ms, 0.01, 1e-12);
    work.bytes_read = 1.1e6;
    EXPECT_NEAR(stage_limit(work, round_limits()).ms, 0.0275, 1e-12);
}

TEST(Roofline, IsMonotoneInEveryCount) {
    double StageCounts::*const fields[] = {&StageCounts::pixels,
                                           &StageCounts::surface_pixels,
                                           &StageCounts::lights,
                                           &StageCounts::directional_lights,
                                           &StageCounts::tiles,
                                           &StageCounts::box_intervals,
                                           &StageCounts::clusters,
                                           &StageCounts::coarse_pairs,
                                           &StageCounts::active_clusters,
                                           &StageCounts::refine_tests,
                                           &StageCounts::refined_pairs,
                                           &StageCounts::evaluations,
                                           &StageCounts::full_evaluations,
                                           &StageCounts::seen_triangles,
                                           &StageCounts::texels,
                                           &StageCounts::shadow_rays,
                                           &StageCounts::shadow_seen,
                                           &StageCounts::shadow_words,
                                           &StageCounts::gbuffer_bytes_per_pixel};
    for (const StageInfo* stage : all_stages()) {
        if (!stage->work) continue;
        bool grew = false;
        for (double StageCounts::*const field : fields) {
            // Background pixels are those without a surface.
            if (field == &StageCounts::surface_pixels && stage == &kFillBackgroundStage) continue;
            StageCounts more = some_counts();
            more.*field = 2.0 * more.*field + 100.0;
            const double before = stage_limit(stage->work(some_counts()), round_limits()).ms;
            const double after = stage_limit(stage->work(more), round_limits()).ms;
            EXPECT_GE(after, before) << stage->name;
            grew = grew || after > before;
        }
        EXPECT_TRUE(grew) << stage->name;
    }
}

TEST(Roofline, EveryDeclaredWorkHasALimitEvenWithoutWork) {
    for (const StageInfo* stage : all_stages()) {
        EXPECT_EQ(stage_info(stage->name), stage) << "two stages are called " << stage->name;
        if (!stage->work) continue;
        const double ms = stage_limit(stage->work(StageCounts{}), round_limits()).ms;
        EXPECT_TRUE(std::isfinite(ms) && ms >= 0.0) << stage->name << ": " << ms;
    }
    EXPECT_EQ(stage_info("no such stage"), nullptr);
    EXPECT_EQ(group_of("no such stage"), StageGroup::host);
}

// Counts of deferred-all with 5000 lights: most are out of range, and leave evaluate() at its range
// test.
TEST(Roofline, CountsLightsThatLeaveEarlyAsRangeTests) {
    StageCounts all = some_counts();
    all.kernels.shading = SHADING_PBR;
    all.evaluations = all.full_evaluations = 1e9;
    StageCounts few = all;
    few.full_evaluations = 1e6;
    const double all_ms = stage_limit(shade_work(all), round_limits()).ms;
    const double few_ms = stage_limit(shade_work(few), round_limits()).ms;
    EXPECT_LT(few_ms, all_ms / 4.0);
    const double instructions_ms = 1e3 * 1e9 * range_test_instructions().total / 1e11;
    EXPECT_GE(few_ms, instructions_ms);
    EXPECT_LE(few_ms, 1.1 * instructions_ms);
}

double shade_ms(const StageCounts& counts) {
    return stage_limit(shade_work(counts), round_limits()).ms;
}

// Lights that exact shadows hide are not evaluated, in range or not.
TEST(Roofline, ShadingOwesNothingForLightsThatShadowsHide) {
    StageCounts c = some_counts();
    c.kernels.shading = SHADING_PBR;
    c.evaluations = 2e8;
    c.full_evaluations = 1e8;
    const double lit = shade_ms(c);
    c.kernels.shadows = true;
    c.shadow_seen = 1e6;
    const double hidden = shade_ms(c);
    EXPECT_LT(hidden, 0.2 * lit);
    c.full_evaluations = 2e6;
    EXPECT_EQ(shade_ms(c), hidden) << "what is seen decides";
    c.shadow_seen = 1e8;
    EXPECT_GT(shade_ms(c), hidden);
    c.kernels.sampled_shadows = true;
    c.full_evaluations = 1e8;
    EXPECT_GE(shade_ms(c), 1.99 * lit) << "all of it twice";
}

FrameSetup some_setup() {
    FrameSetup setup;
    setup.width = 64;
    setup.height = 48;
    return setup;
}

FrameStats some_stats() {
    FrameStats stats;
    stats.lights_used = 103;
    stats.directional_lights = 3;
    stats.surface_pixels = 1000;
    stats.evaluations_per_pixel = 5.0;
    stats.useful_evaluations_per_pixel = 4.0;
    stats.refine_tests = 700;
    stats.grid[0] = 4;
    stats.grid[1] = 3;
    stats.grid[2] = 10;
    stats.stages = {{"light_input", 1.0, 7.0}, {"shade", 2.0, 0.0}, {"refine_lights", 1.0, 0.0}};
    return stats;
}

TEST(StageCountsTest, ComeFromTheFrame) {
    const StageCounts c = stage_counts(some_stats(), some_setup());
    EXPECT_EQ(c.pixels, 3072.0);
    EXPECT_EQ(c.surface_pixels, 1000.0);
    EXPECT_EQ(c.lights, 100.0);
    EXPECT_EQ(c.directional_lights, 3.0);
    EXPECT_EQ(c.tiles, 12.0);
    EXPECT_EQ(c.clusters, 120.0);
    EXPECT_EQ(c.box_intervals, 80.0);
    EXPECT_EQ(c.evaluations, 5000.0);
    FrameSetup all = some_setup();
    all.renderer = RendererKind::deferred_all;
    EXPECT_EQ(stage_counts(some_stats(), all).evaluations, 100.0 * 1000.0);
    EXPECT_EQ(stage_counts(some_stats(), all).full_evaluations, 100.0 * 1000.0) << "lambert";
    all.kernels.shading = SHADING_PBR;
    FrameStats stats = some_stats();
    EXPECT_EQ(stage_counts(stats, all).full_evaluations, 4000.0) << "k* a pixel";
    stats.useful_evaluations_per_pixel = -1.0;
    EXPECT_EQ(stage_counts(stats, all).full_evaluations, 0.0) << "not counted";
}

TEST(StageReports, TellTheRaysThatWereSaved) {
    FrameStats stats = some_stats();
    stats.shadows.shafts = 12;
    stats.shadows.rays = 3500;
    stats.shadows.seen = 3000;
    stats.shadows.words = 99;
    stats.stages = {{"cast_shadows", 1.0, 0.0}, {"shade", 1.0, 0.0}};
    FrameSetup setup = some_setup();
    setup.kernels.shadows = true;
    const auto reports = stage_reports(stats, round_limits(), setup);
    EXPECT_EQ(reports[0].evaluations, 3500.0);
    EXPECT_EQ(reports[0].shafts, 12.0);
    EXPECT_EQ(reports[0].saved_rays, 5000.0 + 3.0 * 1000.0 - 3500.0);
    EXPECT_GT(reports[0].limit_ms, 0.0);
    EXPECT_EQ(reports[1].evaluations, 3000.0) << "lights that are seen";
    stats.shadows = {};
    EXPECT_EQ(stage_reports(stats, round_limits(), setup)[0].saved_rays, 0.0) << "not counted";
}

TEST(StageReports, HoldTimesAgainstLimits) {
    FrameStats stats = some_stats();
    fill_limits(stats, round_limits(), some_setup());
    EXPECT_EQ(stats.stages[0].limit_ms, 0.0) << "no model";
    EXPECT_GT(stats.stages[1].limit_ms, 0.0);
    const auto reports = stage_reports(stats, round_limits(), some_setup());
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[1].limit_ms, stats.stages[1].limit_ms);
    EXPECT_DOUBLE_EQ(reports[1].evaluations, 8000.0);  // three directional lights beside
    EXPECT_DOUBLE_EQ(reports[2].evaluations, 700.0);
    EXPECT_TRUE(reports[0].bound.empty());
    EXPECT_EQ(reports[1].shafts, 0.0);
    const Efficiency efficiency = efficiency_of(reports, stats);
    EXPECT_DOUBLE_EQ(efficiency.hardware, (reports[1].limit_ms + reports[2].limit_ms) / 3.0);
    EXPECT_DOUBLE_EQ(efficiency.algorithm, 0.8);
    stats.useful_evaluations_per_pixel = -1.0;
    EXPECT_LT(efficiency_of(reports, stats).algorithm, 0.0) << "not counted";
}

TEST(StageReports, OtherIsWhatTheStagesLeaveOfTheFrame) {
    FrameStats stats = some_stats();
    stats.frame_ms = 5.5;
    EXPECT_DOUBLE_EQ(outside_stages_ms(stats), 1.5);
}

}  // namespace
}  // namespace kilolux
