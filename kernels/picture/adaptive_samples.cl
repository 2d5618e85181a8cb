// SPDX-License-Identifier: Apache-2.0
// Means of as many samples as each fine tile needs, until the standard error of its mean is small
// enough.
//
// Stopping as soon as samples agree would miss rare light: such a mean is too dark where few
// samples are bright (Kirk and Arvo 1991, "Unbiased Sampling Techniques for Image Synthesis"). So
// there are two halves of the samples, and the spread of each decides where the other's mean stops.
// The number of samples of a mean then does not depend on these samples, and the mean is unbiased.
// A tile takes samples until both means have stopped.
//
// `planes`: 3 of the picture, and 3 of each group of lights. A half's state: its means of these,
// and planes of the running mean and the sum of squared deviations of the picture's luminance
// (Welford 1962), which continue after the means have stopped.
#include "kernels/device/luminance.h"
#include "kernels/device/pixels.h"

// Planes of a half's state.
static inline uint state_planes(uint planes) { return planes + 2; }

// `mean` of n values after `value`, the n-th. An infinite mean stays infinite.
static inline FV mean_with(FV mean, FV value, float n) {
    FV change = value - mean;
    FV next = mean + change / n;
    return lane_select(change - change == fv(0.0f), next, mean + value);
}

// Adds the n-th sample of half `h` where a tile is not done. One work-item takes VW neighbouring
// pixels of a row.
kernel void adaptive_samples_add(View view, uint planes, uint h, uint n,
                                 global const float* restrict radiance,  // [planes][height][stride]
                                 global const uint* restrict fixed,      // [2][tiles]
                                 // in, out [2][state_planes][height][stride]
                                 global float* restrict state) {
    ItemPlace at = place_in_planes(view);
    if (!at.inside || at.x >= view.width) return;
    uint tiles = fine_tile_count(view);
    if (fixed[at.tile] != 0 && fixed[tiles + at.tile] != 0) return;
    uint plane = view.stride * view.height;
    uint pixel = at.y * view.stride + at.x;
    bool is_first = n == 1;
    global float* half_state = state + h * state_planes(planes) * plane + pixel;
    if (fixed[h * tiles + at.tile] == 0) {
        for (uint c = 0; c < planes; ++c) {
            FV light = lane_load(radiance + c * plane + pixel);
            global float* mean = half_state + c * plane;
            lane_store(is_first ? light : mean_with(lane_load(mean), light, (float)n), mean);
        }
    }
    FV light[3];
    for (uint c = 0; c < 3; ++c) light[c] = lane_load(radiance + c * plane + pixel);
    FV seen = luminance(fv3(light[0], light[1], light[2]));
    half_state += planes * plane;
    FV middle = is_first ? seen : lane_load(half_state);
    FV squares = is_first ? fv(0.0f) : lane_load(half_state + plane);
    FV change = seen - middle;
    middle = mean_with(middle, seen, (float)n);
    lane_store(middle, half_state);
    lane_store(fma(change, seen - middle, squares), half_state + plane);
}

// After n samples of each half: where a half's samples show that the mean of both has a relative
// standard error of at most the one asked for, the other half's mean stops. A tile's squared error
// is the mean over its pixels of variance / (luminance^2 + floor^2); pixels that are not finite
// count 0. One work-item takes a tile, so the order of the sum is the same for every lane width.
kernel void adaptive_samples_decide(View view, uint planes, uint n, float squared_error,
                                    float squared_floor, global const float* restrict state,
                                    global uint* restrict fixed) {  // in, out [2][tiles]: the
                                                                    // samples of a half's mean, 0
                                                                    // while it takes more
    uint tile = get_global_id(0);
    uint tiles = fine_tile_count(view);
    if (tile >= tiles || (fixed[tile] != 0 && fixed[tiles + tile] != 0)) return;
    uint x0 = tile % fine_tiles_x(view) * FINE_TILE;
    uint y0 = tile / fine_tiles_x(view) * FINE_TILE;
    uint x1 = min(x0 + FINE_TILE, view.width);
    uint y1 = min(y0 + FINE_TILE, view.height);
    uint plane = view.stride * view.height;
    float pixels = (float)((x1 - x0) * (y1 - y0));
    for (uint h = 0; h < 2; ++h) {
        global const float* middle = state + (h * state_planes(planes) + planes) * plane;
        float sum = 0.0f;
        for (uint y = y0; y < y1; ++y) {
            for (uint x = x0; x < x1; ++x) {
                uint i = y * view.stride + x;
                float error = middle[plane + i] / fma(middle[i], middle[i], squared_floor);
                sum += error - error == 0.0f ? error : 0.0f;
            }
        }
        uint other_half = (1 - h) * tiles + tile;
        // The estimated variance of n values is off by sqrt(2 / (n - 1)) of it where a tile's
        // pixels err alike: that much is added. The mean of both halves has half the variance of
        // one.
        float degrees = (float)(n - 1);
        float bound = sum * (1.0f + sqrt(2.0f / degrees));
        bool is_enough = bound <= squared_error * pixels * 2.0f * (float)n * degrees;
        if (fixed[other_half] == 0 && is_enough) fixed[other_half] = n;
    }
}

// The mean of both halves, and the variance of its luminance. `n`: samples taken of each half where
// a mean has not stopped. One work-item takes VW neighbouring pixels of a row.
kernel void adaptive_samples_mean(View view, uint planes, uint n,
                                  global const float* restrict state,
                                  global const uint* restrict fixed,
                                  global float* restrict mean,  // out [planes][height][stride]
                                  global float* restrict variance) {  // out [height][stride]
    ItemPlace at = place_in_planes(view);
    if (!at.inside || at.x >= view.width) return;
    uint tiles = fine_tile_count(view);
    uint plane = view.stride * view.height;
    uint pixel = at.y * view.stride + at.x;
    global const float* other_half = state + state_planes(planes) * plane;
    for (uint c = 0; c < planes; ++c) {
        FV sum = lane_load(state + c * plane + pixel) + lane_load(other_half + c * plane + pixel);
        lane_store(0.5f * sum, mean + c * plane + pixel);
    }
    uint counts[2] = {fixed[at.tile], fixed[tiles + at.tile]};
    float taken = (float)(counts[0] == 0 || counts[1] == 0 ? n : max(counts[0], counts[1]));
    FV sum = fv(0.0f);
    for (uint h = 0; h < 2; ++h) {
        FV squares = lane_load(state + (h * state_planes(planes) + planes + 1) * plane + pixel);
        sum += squares / ((float)(counts[h] == 0 ? n : counts[h]) * (taken - 1.0f));
    }
    lane_store(0.25f * sum, variance + pixel);
}
