// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/gpu/stage_info.h"
#include "kernels/shared/clusters.h"
#include "kernels/shared/shadow.h"

namespace kilolux {

/// Named channels of an image, interleaved, row 0 on top: floats, or ids.
struct Layer {
    std::string name;  // "depth", "normal", ...; "" for the colour
    std::vector<std::string>
        channels;  // EXR channel names: {"R","G","B"}, {"Z"}, {"N.X","N.Y","N.Z"}, ...
    std::vector<float> values{};       // channels.size() * width * height; empty for ids
    std::vector<std::uint32_t> ids{};  // likewise; whole numbers: written as UINT, never averaged
    std::uint64_t most_id = 0;         // of a strip: the largest that the picture may have
    bool is_id() const { return !ids.empty(); }
};

/// Time of one stage of a frame: see StageTimer.
struct StageTime {
    std::string name;
    double ms = 0.0;
    double limit_ms = 0.0;  // by the device's measured limits; 0: none
};

/// Rows measured on the host, not by a kernel: bringing pixels to the host, with what the host does
/// there; the device's idling between commands, of which the next was enqueued, or was not.
inline constexpr StageInfo kReadBackStage = {"read_back", StageGroup::host};
inline constexpr StageInfo kLaunchStage = {"launch", StageGroup::host};
inline constexpr StageInfo kEnqueueStage = {"enqueue", StageGroup::host};

/// Adds to the stage's time, or appends the stage.
inline void add_stage_time(std::vector<StageTime>& stages, std::string_view name, double ms) {
    auto found = std::ranges::find(stages, name, &StageTime::name);
    if (found == stages.end()) found = stages.insert(found, {std::string(name)});
    found->ms += ms;
}

/// Samples of a picture whose tiles take as many as they need.
struct SampleCounts {
    std::uint64_t total = 0;  // of all pixels; 0: their number was given
    std::uint64_t pixels = 0;
    std::uint32_t least = 0, most = 0;
    std::uint64_t tiles = 0, open_tiles = 0;  // that have not reached the error asked for
};

/// Counts of one frame, with those of its lists, all bands together.
struct FrameStats : PairCounts {
    FrameStats() : PairCounts{} {}

    std::uint64_t lights_given = 0;
    std::uint64_t lights_used = 0;
    std::uint64_t lights_rejected = 0;      // unusable: not finite, no range, no intensity
    std::uint64_t directional_lights = 0;   // of those used
    std::uint64_t lights_uploaded = 0;      // rows that the host sent to the device
    std::uint64_t shadow_scenes_built = 0;  // shadow hierarchies
    std::uint64_t zero_normals =
        0;  // vertices of the scene whose normal has no direction: drawn as +Z of the view
    // Triangles that OpenCL draws; 0 where OpenGL does.
    std::uint64_t triangles = 0;       // of the instances in view
    std::uint64_t triangle_pairs = 0;  // of them and tiles of the picture
    // Work of making surfaces in OpenCL; 0: not counted.
    std::uint64_t seen_triangles = 0;   // that some pixel shows
    std::uint64_t texels = 0;           // read at least: four for a mip level of a texture
    std::uint64_t layers = 0;           // of surfaces that blend, over one pixel at most
    std::uint64_t layer_pixels = 0;     // pixels covered, summed over layers and samples
    std::uint64_t layer_tiles = 0;      // of FINE_TILE pixels a side, likewise; 0: not counted
    std::uint32_t grid[3] = {0, 0, 0};  // tiles x, tiles y, slices
    // k, over pixels that are not background; < 0: not counted. Forward shading counts fragments
    // that later ones hide, too.
    double evaluations_per_pixel = 0.0;
    double useful_evaluations_per_pixel =
        0.0;                 // k*: lights whose range covers the pixel; < 0: not counted
    ShadowCounts shadows{};  // 0: not counted
    SampleCounts samples;
    bool shaded_display = false;  // shading made the display picture: there is no tonemap stage
    std::vector<StageTime> stages;
    double frame_ms = 0.0;  // without build_ms
    double build_ms = 0.0;  // in which the device waited for programs to be built
};

/// Lights evaluated at a pixel that shows a surface; 0 without any.
inline double mean_list_length(const PairCounts& counts) {
    const auto pixels = static_cast<double>(counts.surface_pixels);
    return pixels > 0.0 ? static_cast<double>(counts.evaluations) / pixels : 0.0;
}

/// A rendered picture on the host.
struct Frame {
    int width = 0;
    int height = 0;
    int first_row = 0;                  // of the picture: above 0 in lower strips of it
    std::vector<float> radiance;        // linear HDR Rec. 709, 3 * width * height
    std::vector<float> shown_light;     // the same with bloom; empty without
    std::vector<std::uint8_t> display;  // sRGB, 4 * width * height
    std::vector<Layer> aovs;
    FrameStats stats;
};

}  // namespace kilolux
