// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "host/gpu/features.h"

namespace kilolux {

/// Quantities of work of a frame's stages.
struct StageCounts {
    double pixels = 0.0;          // of the image
    double surface_pixels = 0.0;  // that show a surface
    double lights = 0.0;          // point and spot
    double directional_lights = 0.0;
    double tiles = 0.0;          // fine tiles
    double box_intervals = 0.0;  // of the coarse grid: slices * (tiles_x + tiles_y + 1)
    double clusters = 0.0;       // coarse
    double coarse_pairs = 0.0;
    double active_clusters = 0.0;
    double refine_tests = 0.0;  // entries of the active clusters' coarse lists
    double refined_pairs = 0.0;
    double triangles = 0.0;  // that OpenCL draws
    double triangle_pairs = 0.0;
    // Of resolving; not counted: 0.
    double seen_triangles = 0.0;
    double texels = 0.0;
    double evaluations = 0.0;       // of lights at pixels: k * surface_pixels
    double full_evaluations = 0.0;  // of those that do not leave early; not counted: 0
    // Of shadows, see ShadowCounts; not counted: 0.
    double shadow_rays = 0.0;
    double shadow_seen = 0.0;
    double shadow_words = 0.0;
    bool all_lights = false;      // are evaluated at every pixel
    bool shaded_display = false;  // shading makes codes of a display in place of radiance
    double gbuffer_bytes_per_pixel = 12.0;
    double bridge_bytes_per_pixel = 12.0;  // that OpenGL hands over: the G-buffer, or ids
    bool device_is_host = true;            // the device reads them where OpenGL left them
    KernelFeatures kernels;

    double index_bytes() const { return kernels.light_index_bits / 8; }
    /// Pairs of a surface pixel and a light of its list, directional ones too.
    double listed_pairs() const { return evaluations + surface_pixels * directional_lights; }
};

inline constexpr double kRadianceBytes = 12.0;          // of a pixel: three floats
inline constexpr double kDisplayBytes = 4.0;            // of a pixel
inline constexpr double kPixelOrderBytes = 1.0;         // of a pixel within its tile
inline constexpr double kWordBytes = sizeof(uint);      // a counter, an offset, 32 bits
inline constexpr double kRowBytes = 4 * sizeof(float);  // a light's bound, a shadow ray's origin

/// Operations of one lane: fma counts as one; comparisons, selections, conversions and bit
/// operations count one each; negations, loads, stores, loop counters and loop invariants count
/// nothing.
struct InstructionCounts {
    double total = 0.0;  // special functions included, as one each
    double rsqrts = 0.0;
    double sqrts = 0.0;
    double divisions = 0.0;
    bool operator==(const InstructionCounts&) const = default;
};

/// What a stage must at least do: each input read and each output written once for every launch
/// that needs it. Instructions are counted where a test compares them with the kernel's own text.
struct StageWork {
    double bytes_read = 0.0;
    double bytes_written = 0.0;
    double bytes_uploaded = 0.0;  // from host memory to a device with its own
    InstructionCounts instructions{};
    double texels = 0.0;  // read at places of their own
    int launches = 0;
    double evaluations = 0.0;  // lights evaluated or tested, or rays; used for rates

    double bytes() const { return bytes_read + bytes_written; }  // in the device's memory
};

/// The part of a frame that a stage belongs to: tables sum by it.
enum class StageGroup { lights, surfaces, lists, shadows, shading, picture, host };
inline constexpr std::string_view kStageGroupNames[] = {"lights",  "surfaces", "lists", "shadows",
                                                        "shading", "picture",  "host"};

/// A stage of a frame, declared beside what runs it. Converts to its name.
struct StageInfo {
    std::string_view name;
    StageGroup group = StageGroup::picture;
    StageWork (*work)(const StageCounts& counts) = nullptr;  // null: it has no limit
    bool opengl_copies = false;  // OpenGL copies data; the measured limits do not apply

    constexpr operator std::string_view() const { return name; }
};

}  // namespace kilolux
