// SPDX-License-Identifier: Apache-2.0
#include "host/certify/hard_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>

#include "host/certify/cases.h"

namespace kilolux {
namespace {

// "u" is 2^-24, "k" the lights of a pixel, "E" the light that arrives there, "R1" the float64
// reference over the decoded surfaces. "missed": a light within its range by float64 that the
// pixel's list lacks.
constexpr HardCase kHardCases[] = {
    {"1", "slice-boundaries", "every slice end +-200 ulp and 1e6 depths in C++, OpenCL, GLSL",
     "the same slices", try_slice_boundaries},
    {"2", "far-over-near", "0.001..1e4 m and 0.1..1e6 m, lights in every slice",
     "0 missed; the bits of all lights; z to 2.5e-7; k*/k at least half of that at 1e3",
     try_far_over_near},
    {"3", "beyond-the-grid", "pixels and lights only in front of slice 0, or behind the last",
     "0 missed; the bits of all lights", try_beyond_the_grid},
    {"4", "huge-ranges", "ranges 1e3..1e6 times the scene, around and far behind the camera",
     "in every list; the bits of all lights; no cell visited twice", try_huge_ranges},
    {"5", "spheres-at-the-camera", "1e5 spheres across the camera and near planes",
     "0 missed; the bits of all lights", try_spheres_at_the_camera},
    {"6", "orthographic", "orthographic views with near 0 and -50",
     "0 missed; the bits of all lights; 1e-5 of R1", try_orthographic},
    {"7", "off-centre", "shear +-0.5, jitter 1/2 pixel, an oblique near plane",
     "0 missed; the bits of all lights; positions to 4 u", try_off_centre},
    {"8", "infinite-far", "far at infinity, 1e300 and 1e30; background",
     "no NaN; background exactly 0", try_infinite_far},
    {"9", "odd-sizes", "1x1, 17x31, 16x16, 1919x1079, 8192x1 with guards around the buffers",
     "the bits of all lights; no guard written or read", try_odd_sizes},
    {"10", "boundaries-and-tangents", "centres on cell faces, edges, corners; r = distance +-4 ulp",
     "0 missed; the bits of all lights", try_boundaries_and_tangents},
    {"11", "false-positives", "coarse lists against float64 sphere-cell overlap",
     "a superset; at most 1.3 times for r >= cell", try_false_positives},
    {"12", "tiny-lights", "r = 1e-6, 1e-20, denormal, 0, < 0 at 0.5 m and 1 km",
     "0 missed; r <= 0 rejected and counted", try_tiny_lights},
    {"13", "light-at-the-point", "d = 0, 1e-30 .. 1.01e-2 m, 5 directions, 3 models",
     "finite; at most I/d_min^2; 1e-5 of R1", try_light_at_the_point},
    {"14", "half-overflow", "1000 lights of 1e6..1e30 cd on a point",
     "float32 to 1e-5 of R1; halves clamped to 65504", try_half_overflow},
    {"15", "bad-numbers", "each field of a light NaN, Inf, negative; a NaN matrix",
     "only that light rejected and counted; no other bit changes", try_bad_numbers},
    {"16", "long-lists", "1, 255, 256, 257, 65535, 65536, 1e5 lights in a cluster",
     "all listed in order; the bits of all lights", try_long_lists},
    {"17", "repeated-runs", "20 runs x 3 local sizes x 1 and all threads", "one picture",
     try_repeated_runs},
    {"18", "long-sums", "k = 1..1e6 lights on a pixel, intensities over e^12, two orders",
     "|x-r|/E <= (72 + k/64) u", try_long_sums},
    {"19", "far-from-origin", "everything moved by 2^20 m and 1e6 m", "3e-6 relative",
     try_far_from_origin},
    {"20", "denormals", "tails of lobes, lights of 1e-38; flushed to zero or not",
     "|d| <= 1.2e-38 k; the same slices and lists", try_denormals},
    {"21", "srgb-rounding", "all code boundaries +-1 ulp, 256 codes, 2e4 values",
     "own exact; OpenGL's within 1 code of own and of the exact value; codes return",
     try_srgb_rounding},
    {"22", "narrow-lobes", "n.h swept through the peak, n = 1..1e4, roughness 0..1",
     "error / peak 1e-5 (n), 5e-5 (GGX); at most 1e-5 above the peak", try_narrow_lobes},
    {"23", "grazing-angles", "n.l, n.v at 90 deg +-1e-7..1e-2; facing away",
     "1e-6 E (Lambert), 1e-5 (lobes); none from behind", try_grazing_angles},
    {"24", "degenerate-surfaces", "slivers, no area, normals of length 0, 1e-20, 1e20",
     "no NaN; the bits of unit normals, zero as +z; counted", try_degenerate_surfaces},
    {"25", "octahedral-wrap", "6 axes, 12 edges, 8 faces, 1e6 directions in GLSL and OpenCL",
     "0.0038 deg; axes to 1e-4 rad; GLSL and OpenCL within 9.5 ulp", try_octahedral_wrap},
    {"26", "depth-noise", "random depth, and a near/far checkerboard: > 8 slices a tile",
     "0 missed; the bits of all lights; lists within the coarse ones", try_depth_noise},
    {"27", "nothing", "0 lights, 1, none in view, background only, an empty scene",
     "black, no error", try_nothing},
    {"28", "wide-indices", "70000 lights; sizes of 2^31 and 2^32 entries",
     "0 missed; 32-bit indices beyond 65536 lights; errors give the number", try_wide_indices},
    {"29", "tangent-spheres", "1e6 spheres tangent to a pixel's point +-4 ulp", "0 missed",
     try_tangent_spheres},
    {"30", "alternating-frames", "two views in turn, 20 frames", "each view keeps its bits",
     try_alternating_frames},
    {"31", "triangle-edges", "fans about pixels' centres; a body about the eye, also 2^20 m out",
     "each pixel covered by one triangle", try_triangle_edges},
    {"32", "shadow-edges",
     "columns, a 1 mm wall, a light 1 mm over a floor, spheres; also far away",
     "rays in double, but within 2^-15 of an edge; the bits of all lights", try_shadow_edges},
    {"33", "tails",
     "lights without a range: around the camera, over e^40, one that outshines; budgets "
     "1e-30..1e30",
     "exact to 1e-5 E; bounded lacks no more than its bound; suns keep their bits", try_tails},
    {"34", "light-profiles",
     "IES webs: a beam of 1 deg, a ridge on the seam, poles with unlike rings, mirrored",
     "3e-6 E; the bits of all lights", try_light_profiles},
    {"35", "area-lights",
     "rectangles, disks, spheres, triangles, some through the floor; without shadows and sampled",
     "2e-5 E (Lambert); the bits of all lights, other grids, bands, lanes, work-groups",
     try_area_lights},
    {"M1", "other-grids", "five grids", "the same bits", try_other_grids},
    {"M2", "idle-lights", "500 more lights, of no intensity or out of range", "the same bits",
     try_idle_lights},
    {"M3", "scaled-intensities", "intensities x 2^n, n = -24, -3, 1, 30; 3 models", "x 2^n exactly",
     try_scaled_intensities},
    {"M4", "scaled-world", "radii x 2^n, intensities x 4^n, n = -5, -1, 3, 10", "the same bits",
     try_scaled_world},
    {"M5", "mirror", "x mirrored, symmetric camera", "2 ulp", try_mirror},
    {"M6", "split-light", "one light as two halves in its place", "2k ulp", try_split_light},
    {"M7", "permuted-lights", "1000 lights in three other orders", "twice the bound of case 18",
     try_permuted_lights},
    {"M8", "lane-widths", "one lane against this width; 3 models, lists, surfaces",
     "the same bits on CPUs", try_lane_widths}};

bool is_count(const Finding& f) { return f.limit == 0.0 && f.value == std::floor(f.value); }

void run_at(HardCaseRow& row, const Gpu& gpu, int lanes) {
    Findings found;
    try {
        row.hard_case.run(gpu.with_lanes(lanes), found);
    } catch (const std::exception& error) {
        row.error = fmt::format("{} lanes: {}", lanes, error.what());
    }
    row.findings.merge(found);
    row.lanes.push_back(lanes);
}

std::string findings_text(const HardCaseRow& row) {
    std::string text = row.error;
    for (const Finding& f : row.findings.all()) {
        text += (text.empty() ? "" : "; ") + finding_text(f);
    }
    return text;
}

}  // namespace

std::span<const HardCase> hard_cases() { return kHardCases; }

std::string finding_text(const Finding& f) {
    std::string text = fmt::format("{}: {:.3g}", f.what, f.value);
    if (is_count(f) && f.checked > 1) text += fmt::format(" of {}", f.checked);
    if (f.limit > 0.0 && std::isfinite(f.limit)) text += fmt::format(" ({:.3g})", f.limit);
    if (!f.passed()) text += " FAILED" + (f.where.empty() ? "" : " at " + f.where);
    return text;
}

std::vector<HardCaseRow> run_hard_cases(const Gpu& gpu, std::span<const HardCase> cases,
                                        std::span<const int> lanes,
                                        const std::function<void()>& step) {
    std::vector<HardCaseRow> rows;
    for (const HardCase& hard_case : cases) {
        HardCaseRow& row = rows.emplace_back(HardCaseRow{hard_case, {}, {}, {}});
        for (const int width : lanes) {
            run_at(row, gpu, width);
            step();
        }
    }
    return rows;
}

Table hard_case_table(const std::vector<HardCaseRow>& rows) {
    using Row = HardCaseRow;
    return make_table<Row>(
        {{"case", [](const Row& row) { return row.hard_case.label; }},
         {"name", [](const Row& row) { return row.hard_case.name; }},
         {"tried", [](const Row& row) { return row.hard_case.topic; }},
         {"worst error (limit)", findings_text},
         {"threshold", [](const Row& row) { return row.hard_case.threshold; }},
         {"lanes", [](const Row& row) { return fmt::to_string(fmt::join(row.lanes, ", ")); }},
         {"pass", [](const Row& row) { return row.passed() ? "yes" : "NO"; }}},
        rows);
}

}  // namespace kilolux
