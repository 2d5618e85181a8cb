// SPDX-License-Identifier: Apache-2.0
#include "host/measure/roofline/roofline.h"

#include <algorithm>

#include "host/base/gbuffer_layout.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/light.h"
#include "kernels/shared/raster_row.h"
#include "kernels/shared/shadow.h"

namespace kilolux {
namespace {

constexpr double kTilePixels = FINE_TILE * FINE_TILE;
constexpr double kRadianceBytes = 12.0;  // three floats a pixel
constexpr double kDisplayBytes = 4.0;
constexpr double kOrderBytes = 1.0;  // of a pixel within its tile
constexpr double kBoundBytes = sizeof(float4);
constexpr double kCounterBytes = sizeof(uint);
constexpr double kWordBytes = sizeof(uint);  // of bits
constexpr int kPrefixSumLaunches = 1;        // more than one block takes three

double index_bytes(const StageCounts& c) { return c.kernels.light_index_bits / 8; }

// Reads each count twice, writes each offset.
StageWork prefix_sum_work(double counts) {
    return {.bytes_read = 2.0 * kCounterBytes * counts,
            .bytes_written = kCounterBytes * counts,
            .launches = kPrefixSumLaunches};
}

// The part of cone_reaches() that every light pays, point lights too: q 9, radius 7 and a square
// root, q^2 3, the guard 4.
InstructionCounts cone_guard_instructions() { return {24.0, 0.0, 1.0, 0.0}; }

// Three differences of 7. What lights that move by themselves add is left out.
StageWork move_work(const StageCounts& c) {
    return {.bytes_read = c.lights * sizeof(WorldLight),
            .bytes_written = c.lights * sizeof(Light),
            .instructions = c.lights * InstructionCounts{21.0},
            .launches = 1};
}

// A triangle is three indices and about half a vertex: neighbours share theirs. Of those that no
// pixel shows, how many are set up is left out; so is the prefix sum over tiles.
StageWork bin_triangles_work(const StageCounts& c) {
    constexpr double kTriangle = 3 * sizeof(uint) + 0.5 * 3 * sizeof(float);
    constexpr double kBox = 4 * sizeof(uint);
    // Three vertices: differences 6, rows 12, reciprocal 9, pixel 4. Their extremes 12, to whole
    // pixels 12, outside of the view 28, the determinant 17 and its bound 20. One that is set up:
    // three edges of 35 with a division each, the plane 15, to tiles 6. A pair is counted (1) and
    // placed (3).
    return {.bytes_read = kTriangle * c.triangles + kBox * c.seen_triangles,
            .bytes_written =
                (sizeof(RasterRow) + kBox) * c.seen_triangles + sizeof(uint) * c.triangle_pairs,
            .instructions = c.triangles * InstructionCounts{182.0} +
                            c.seen_triangles * InstructionCounts{126.0, 0.0, 0.0, 3.0} +
                            c.triangle_pairs * InstructionCounts{4.0},
            .launches = 3 + kPrefixSumLaunches};
}

// Every pixel is covered once at least; what lies behind, and alpha's samples, are left out.
StageWork raster_triangles_work(const StageCounts& c) {
    // A pixel: edges 3, their least 2, two comparisons, key 3, nearer 1, taken 2, stored 2.
    return {.bytes_read = (sizeof(uint) + sizeof(RasterRow)) * c.triangle_pairs,
            .bytes_written = sizeof(uint) * c.pixels,
            .instructions = c.drawn_pixels * InstructionCounts{15.0},
            .launches = 1};
}

// A triangle is set up once, however many pixels show it.
StageWork resolve_work(const StageCounts& c) {
    constexpr double kVertex = (3 + 3) * sizeof(float);  // further attributes are left out
    constexpr double kTriangle = 3 * sizeof(uint) + 0.5 * kVertex;
    // Ray 2, weights 22 and a division, depth 2, its buffer value 3 and 2 divisions, normal 6, its
    // unit vector 9 with a root and a division, octahedral 18 and a division, packing 8.
    // A triangle: differences from the eye 18, rows 27, edges and their sum 4 * 15. A texel's
    // channel is taken out 1, converted 1 and mixed 1.5; two channels. Where texels lie is left
    // out: textures of one size share it.
    return {.bytes_read = sizeof(uint) * c.pixels + kTriangle * c.seen_triangles,
            .bytes_written = c.gbuffer_bytes_per_pixel * c.pixels,
            .instructions = c.drawn_pixels * InstructionCounts{70.0, 0.0, 1.0, 5.0} +
                            c.seen_triangles * InstructionCounts{105.0} +
                            c.texels * InstructionCounts{7.0},
            .texels = c.texels,
            .launches = 1};
}

StageWork prepare_work(const StageCounts& c) {
    const double directional = c.directional_lights * sizeof(DirectionalLight);
    constexpr double kPrepared = sizeof(ShadeLight) + kBoundBytes + sizeof(LightExtent);
    // Rotations 18, 1/range^2 2, radius 6, ends in depth 4, pixel intervals 2 * 12, tile intervals
    // 2 * 19, slices 10, behind the camera 2; and 9 divisions.
    return {.bytes_read = c.lights * sizeof(Light) + directional,
            .bytes_written = c.lights * kPrepared + directional,
            .instructions = c.lights * InstructionCounts{113.0, 0.0, 0.0, 9.0} +
                            c.directional_lights * InstructionCounts{9.0},
            .launches = (c.lights > 0.0 ? 1 : 0) + (c.directional_lights > 0.0 ? 1 : 0)};
}

StageWork build_work(const StageCounts& c) {
    // Two edges 2, pad 3, ends 4, products with the depths 4 and their extremes 2, padding 2.
    return {.bytes_written = c.box_intervals * 2.0 * sizeof(float),
            .instructions = c.box_intervals * InstructionCounts{17.0},
            .launches = 1};
}

// Counting and filling walk the lights once each; then a cursor, an offset and a total a cluster.
StageWork cull_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.clusters);
    const double light =
        kBoundBytes + sizeof(LightExtent) + (c.kernels.spot_lights ? sizeof(ShadeLight) : 0.0);
    work.bytes_read += 2.0 * light * c.lights + 3.0 * kCounterBytes * c.clusters;
    work.bytes_written += 3.0 * kCounterBytes * c.clusters + index_bytes(c) * c.coarse_pairs;
    // An extent's six ends, twice; a pair is counted (1) and placed (3).
    work.instructions =
        c.lights * InstructionCounts{12.0} + c.coarse_pairs * InstructionCounts{4.0};
    if (c.kernels.spot_lights)
        work.instructions = work.instructions + 2.0 * c.coarse_pairs * cone_guard_instructions();
    work.launches += 3;
    return work;
}

// Of a pixel's stored position; 0 where it follows from the depth.
double position_bytes(uint gbuffer) {
    return 3.0 * plane_element_bytes(gbuffer, PLANE_POSITION_X) +
           plane_element_bytes(gbuffer, PLANE_ROW_0);
}

StageWork bin_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += 4.0 * c.pixels + (4.0 + position_bytes(c.kernels.gbuffer)) * c.drawn_pixels;
    work.bytes_written += kCounterBytes * c.tiles + sizeof(ActiveCluster) * c.active_clusters +
                          kOrderBytes * c.pixels;
    // A slice: pixel centre 2, depth 2 and a division, slice 4, mask 4, selection 1, extremes 3;
    // for both launches. Then the box: mask 1, centre 2, position 3, extremes 12, count 1.
    // Each pixel is placed in order (2). A tile's further clusters each search the tile's slices, 3
    // a pixel, in both launches.
    const double further = std::max(c.active_clusters - c.tiles, 0.0);
    work.instructions = (c.pixels + c.drawn_pixels) * InstructionCounts{17.0, 0.0, 0.0, 1.0} +
                        c.drawn_pixels * InstructionCounts{21.0} +
                        2.0 * kTilePixels * further * InstructionCounts{3.0};
    work.launches += 3;
    return work;
}

// Entries of the lists that come from the coarse ones; with a light tree there are more.
double refined_entries(const StageCounts& c) { return std::min(c.refined_pairs, c.refine_tests); }

StageWork refine_work(const StageCounts& c) {
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += 2.0 * sizeof(ActiveCluster) * c.active_clusters;
    work.bytes_written += kCounterBytes * c.tiles + 2.0 * kCounterBytes * c.active_clusters +
                          index_bytes(c) * refined_entries(c);
    // Distances by axis 12, their squares' sum 3, range 1, test 1, end of the list 3, flag 1; a
    // light that stays is placed (2).
    work.instructions =
        c.refine_tests * InstructionCounts{21.0} + refined_entries(c) * InstructionCounts{2.0};
    if (c.kernels.spot_lights)
        work.instructions = work.instructions + refined_entries(c) * cone_guard_instructions();
    work.launches += 2;
    return work;
}

// Each entry of a cut is found twice, once to count it. Distance 7, its root 1, the normals' cone
// 12, both bounds and the choice 16; inner nodes above it are left out.
StageWork cut_work(const StageCounts& c) {
    const double entries = c.refined_pairs - refined_entries(c);
    StageWork work = prefix_sum_work(c.active_clusters);
    work.bytes_read += 2.0 * sizeof(ActiveCluster) * c.active_clusters;
    work.bytes_written += index_bytes(c) * c.refined_pairs;
    work.instructions = 2.0 * entries * InstructionCounts{36.0};
    work.launches += 3;
    return work;
}

// Pairs of a drawn pixel and a light of its list, directional ones too.
double listed_pairs(const StageCounts& c) {
    return c.evaluations + c.drawn_pixels * c.directional_lights;
}

// Drawn pixels, and the lights that are evaluated at them.
InstructionCounts shading_instructions(const StageCounts& c) {
    const double left_early = c.evaluations - c.full_evaluations;
    return c.drawn_pixels * pixel_instructions(c.kernels) + left_early * range_test_instructions() +
           c.full_evaluations * evaluation_instructions(c.kernels) +
           c.drawn_pixels * c.directional_lights * directional_instructions(c.kernels);
}

// The same with exact shadows: only lights that are seen are evaluated, directional ones first, as
// they take least. A bit of a word is found out for each pair: shift, mask, comparison.
InstructionCounts seen_instructions(const StageCounts& c) {
    StageCounts seen = c;
    seen.directional_lights = 0.0;
    const double directional = std::min(c.shadow_seen, c.drawn_pixels * c.directional_lights);
    seen.full_evaluations = std::min(c.shadow_seen - directional, c.evaluations);
    if (leaves_early(c.kernels)) {
        seen.full_evaluations = std::min(seen.full_evaluations, c.full_evaluations);
    }
    seen.evaluations = seen.full_evaluations;
    const double bits = c.all_lights ? 0.0 : listed_pairs(c);
    return shading_instructions(seen) + directional * directional_instructions(c.kernels) +
           bits * InstructionCounts{3.0};
}

// Of the list of each pixel, and what is stored of its surface.
double listed_surface_bytes(const StageCounts& c) {
    return (c.gbuffer_bytes_per_pixel + kOrderBytes) * c.drawn_pixels +
           sizeof(ActiveCluster) * c.active_clusters + index_bytes(c) * c.refined_pairs;
}

// Exposure 3, bound 9; sRGB codes 3 * (bounds 2, roots 2, polynomial 6, line 3, code and rest 6);
// packing 5. Tone curves differ: none is counted.
constexpr InstructionCounts kDisplayCodes{74.0, 0.0, 6.0};

// Sampled shadows shade twice: with all lights, and without hidden ones that were drawn.
StageWork radiance_work(const StageCounts& c) {
    StageWork work{.bytes_read = listed_surface_bytes(c),
                   .bytes_written = kRadianceBytes * c.pixels,
                   .instructions = shading_instructions(c),
                   .launches = 1};
    if (!c.kernels.shadows) return work;
    const double words = c.all_lights ? 0.0 : kWordBytes * c.shadow_words;
    if (!c.kernels.sampled_shadows) {
        work.bytes_read += words;
        work.instructions = seen_instructions(c);
        return work;
    }
    work.bytes_read = 2.0 * work.bytes_read + words + kRadianceBytes * c.drawn_pixels;
    work.bytes_written = 2.0 * work.bytes_written + sizeof(float) * c.pixels;
    work.instructions = 2.0 * work.instructions + listed_pairs(c) * InstructionCounts{3.0};
    work.launches = 2;
    return work;
}

StageWork shade_work(const StageCounts& c) {
    StageWork work = radiance_work(c);
    if (!c.shaded_display) return work;
    work.bytes_written += (kDisplayBytes - kRadianceBytes) * c.pixels;
    work.instructions = work.instructions + c.pixels * kDisplayCodes;
    return work;
}

StageWork origins_work(const StageCounts& c) {
    constexpr double kOriginBytes = 4 * sizeof(float);
    // Pixel centre 2, depth 2 and a division, position 3, to shadow space 9, to the eye 3; its side
    // of the plane 5, turned 3, height 6, size 6, move 1, moved 3, kept 6; octahedron 9 and a
    // division, codes 6. Planes of triangles are those of many pixels.
    return {.bytes_read = sizeof(uint) * c.pixels + sizeof(float) * c.drawn_pixels,
            .bytes_written = kOriginBytes * c.drawn_pixels,
            .instructions = c.drawn_pixels * InstructionCounts{66.0, 0.0, 0.0, 2.0},
            .launches = 1};
}

// Each light of a pixel's list alone, its luminance, and the comparison with a random number.
StageWork draw_work(const StageCounts& c) {
    StageCounts lights = c;
    lights.drawn_pixels = 0.0;
    // Decoding is left out. Times albedo 3, luminance 3, product 1, comparison 2.
    return {
        .bytes_read = listed_surface_bytes(c) + kRadianceBytes * c.drawn_pixels,
        .bytes_written = kWordBytes * c.shadow_words,
        .instructions = shading_instructions(lights) + listed_pairs(c) * InstructionCounts{9.0} +
                        c.drawn_pixels * c.directional_lights * directional_instructions(c.kernels),
        .launches = 2};
}

// A walk's nodes and triangles come from near caches.
StageWork cast_work(const StageCounts& c) {
    constexpr double kOriginBytes = 4 * sizeof(float);
    StageWork work = prefix_sum_work(c.tiles);
    work.bytes_read += (kOriginBytes + kOrderBytes) * c.drawn_pixels +
                       sizeof(ActiveCluster) * c.active_clusters +
                       index_bytes(c) * c.refined_pairs + kBoundBytes * c.lights;
    work.bytes_written += kWordBytes * c.shadow_words;
    // A ray: difference 3, side of the surface 4, range 5, both 2, size 5, at least 1, a division,
    // direction 3. Pairs that need none, which are left out, pay most of it, too.
    const InstructionCounts ray = {24.0, 0.0, 0.0, 1.0};
    // A child's box: six ends of difference, product and extreme, a comparison.
    const InstructionCounts node = {SHADOW_WIDTH * 19.0};
    // Corners turned 48, normal 12, sums of its products 17, size 17, offset 3, unit 4, height 16;
    // side 2, corners from the light 9; an edge: sum and difference 6, product 6, its sums 17, unit
    // 2, scaled 5 with a division; the plane's form 5 with a division. Its most in the shaft: four
    // forms of 12, comparisons and masks 7.
    const InstructionCounts triangle = {296.0, 0.0, 0.0, 4.0};
    // Four forms of 3, the least 3, comparison 1, left lit 1.
    const InstructionCounts point = {17.0};
    work.instructions = c.shadow_rays * ray + c.shadow_nodes * node +
                        c.shadow_triangles * triangle + c.shadow_points * point;
    work.launches += 2;
    return work;
}

// Texels lie side by side for neighbouring pixels.
StageWork background_work(const StageCounts& c) {
    const double open = c.pixels - c.drawn_pixels;
    // Ray 14, two angles of 24 and a quotient each, root 2, texels 26, three filters of 9.
    return {.bytes_read = sizeof(float) * c.pixels + kRadianceBytes * open,
            .bytes_written = kRadianceBytes * open,
            .instructions = open * InstructionCounts{117.0, 0.0, 1.0, 2.0},
            .launches = 1};
}

// The two finest levels of the pyramid, which move 0.94 of all its bytes: down reads a level and
// writes a quarter of it, up reads that quarter and the level and writes the level.
StageWork bloom_work(const StageCounts& c) {
    constexpr double kLevels = 1.0 + 0.25;
    // A channel of a coarse pixel: 4 rows of 4 bounded taps 3 and filter 4, their filter 4; of a
    // fine one: 2 rows 2, wide 2, mix 2.
    const InstructionCounts channel = 0.25 * InstructionCounts{68.0} + InstructionCounts{8.0};
    return {.bytes_read = kLevels * (1.0 + 0.25 + 1.0) * kRadianceBytes * c.pixels,
            .bytes_written = kLevels * (0.25 + 1.0) * kRadianceBytes * c.pixels,
            .instructions = kLevels * 3.0 * c.pixels * channel,
            .launches = 4};
}

StageWork tonemap_work(const StageCounts& c) {
    return {.bytes_read = kRadianceBytes * c.pixels,
            .bytes_written = kDisplayBytes * c.pixels,
            .instructions = c.pixels * kDisplayCodes,
            .launches = 1};
}

// The fragments of the forward renderers. `evaluations` are of all fragments, hidden ones too; the
// surfaces of hidden ones are not counted.
StageWork forward_work(const StageCounts& c) {
    return {.bytes_written = kRadianceBytes * c.pixels, .instructions = shading_instructions(c)};
}

StageWork bridge_work(const StageCounts& c) {
    const double bytes = c.bridge_bytes_per_pixel * c.pixels;
    if (c.device_is_host) return {.bytes_read = bytes, .bytes_written = bytes};
    return {.bytes_uploaded = bytes};
}

struct Model {
    std::string_view stage;
    StageWork (*work)(const StageCounts&);
};

constexpr Model kModels[] = {
    {"gbuffer_bridge", bridge_work},
    {"resolve_surfaces", resolve_work},
    {"bin_triangles", bin_triangles_work},
    {"raster_triangles", raster_triangles_work},
    {"move_lights", move_work},
    {"prepare_lights", prepare_work},
    {"build_clusters", build_work},
    {"cull_lights", cull_work},
    {"bin_pixels", bin_work},
    {"refine_lights", refine_work},
    {"cut_light_tree", cut_work},
    {"shadow_origins", origins_work},
    {"draw_shadows", draw_work},
    {"cast_shadows", cast_work},
    {"shade", shade_work},
    {"fill_background", background_work},
    {"bloom", bloom_work},
    {"tonemap", tonemap_work},
    {"forward", forward_work},
    {"forward_plus", forward_work},
};

// Work that fits the cache moves at the cache's rates.
double bytes_seconds(const StageWork& work, const DeviceLimits& limits) {
    const double bytes = work.bytes();
    const bool cached = bytes <= limits.cache_bytes;
    const double read = cached ? limits.cached_read_bandwidth : limits.read_bandwidth;
    const double write = cached ? limits.cached_write_bandwidth : limits.write_bandwidth;
    const double copy = cached ? limits.cached_copy_bandwidth : limits.copy_bandwidth;
    const double mixed = bytes / std::max({read, write, copy});
    return std::max({work.bytes_read / read, work.bytes_written / write, mixed}) +
           work.bytes_uploaded / limits.upload_bandwidth;
}

double special_seconds(const InstructionCounts& counts, const DeviceLimits& limits) {
    return counts.rsqrts / limits.rsqrt_per_s + counts.sqrts / limits.sqrt_per_s +
           counts.divisions / limits.divisions_per_s;
}

}  // namespace

const char* bound_name(Bound bound) {
    constexpr const char* kNames[] = {"bytes", "instructions", "special functions", "texels",
                                      "launches"};
    return kNames[static_cast<std::size_t>(bound)];
}

std::optional<StageWork> stage_work(std::string_view stage, const StageCounts& counts) {
    const auto* found = std::ranges::find(kModels, stage, &Model::stage);
    if (found == std::end(kModels)) return std::nullopt;
    return found->work(counts);
}

StageLimit stage_limit(const StageWork& work, const DeviceLimits& limits) {
    const double launches = 1e-3 * limits.launch_event_ms * work.launches;
    const double bytes = bytes_seconds(work, limits);
    const double instructions = work.instructions.total / limits.lane_instructions_per_s;
    const double special = special_seconds(work.instructions, limits);
    const double texels = work.texels > 0.0 ? work.texels / limits.texels_per_s : 0.0;
    const double most = std::max({bytes, instructions, special, texels});
    StageLimit limit;
    limit.ms = 1e3 * (most + launches);
    if (launches < most) {
        limit.bound = most == bytes          ? Bound::bytes
                      : most == instructions ? Bound::instructions
                      : most == texels       ? Bound::texels
                                             : Bound::special_functions;
    }
    return limit;
}

FrameSetup frame_setup(const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device) {
    const bool ids = resolves_ids(settings.geometry) && !is_forward(settings.renderer);
    return {settings.width,
            settings.height,
            plan.kernels,
            plan.gbuffer_bytes_per_pixel,
            ids ? static_cast<int>(sizeof(uint)) : plan.gbuffer_bytes_per_pixel,
            settings.renderer,
            device.is_cpu};
}

StageCounts stage_counts(const FrameStats& stats, const FrameSetup& setup) {
    const auto number = [](auto value) { return static_cast<double>(value); };
    const auto tiles = [](int size) { return (size + FINE_TILE - 1) / FINE_TILE; };
    StageCounts c;
    c.pixels = number(setup.width) * setup.height;
    c.drawn_pixels = stats.drawn_pixels > 0 ? number(stats.drawn_pixels) : c.pixels;
    c.directional_lights = number(stats.directional_lights);
    c.lights = number(stats.lights_used) - c.directional_lights;
    c.tiles = number(tiles(setup.width)) * tiles(setup.height);
    c.box_intervals = number(stats.grid[2]) * (number(stats.grid[0]) + stats.grid[1] + 1.0);
    c.clusters = number(stats.grid[0]) * stats.grid[1] * stats.grid[2];
    c.coarse_pairs = number(stats.coarse_pairs);
    c.active_clusters = number(stats.active_clusters);
    c.refine_tests = number(stats.refine_tests);
    c.triangles = number(stats.triangles);
    c.triangle_pairs = number(stats.triangle_pairs);
    c.seen_triangles = number(stats.seen_triangles);
    c.texels = number(stats.texels);
    c.refined_pairs = number(stats.refined_pairs);
    const bool all_lights = setup.renderer == RendererKind::deferred_all;
    c.evaluations = c.drawn_pixels * (all_lights ? c.lights : stats.evaluations_per_pixel);
    // k* of them are in range at their pixel, and so are evaluated in full.
    const double in_range = std::max(stats.useful_evaluations_per_pixel, 0.0) * c.drawn_pixels;
    c.full_evaluations =
        leaves_early(setup.kernels) ? std::min(in_range, c.evaluations) : c.evaluations;
    c.all_lights = all_lights;
    c.shaded_display = stats.shaded_display;
    c.shadow_rays = number(stats.shadows.rays);
    c.shadow_seen = number(stats.shadows.seen);
    c.shadow_nodes = number(stats.shadows.nodes);
    c.shadow_triangles = number(stats.shadows.triangles);
    c.shadow_points = number(stats.shadows.points);
    c.shadow_words = number(stats.shadows.words);
    c.gbuffer_bytes_per_pixel = setup.gbuffer_bytes_per_pixel;
    c.bridge_bytes_per_pixel = setup.bridge_bytes_per_pixel;
    c.device_is_host = setup.device_is_host;
    c.kernels = setup.kernels;
    return c;
}

void fill_limits(FrameStats& stats, const DeviceLimits& limits, const FrameSetup& setup) {
    const StageCounts counts = stage_counts(stats, setup);
    for (StageTime& stage : stats.stages) {
        const auto work = stage_work(stage.name, counts);
        stage.limit_ms = work ? stage_limit(*work, limits).ms : 0.0;
    }
}

}  // namespace kilolux
