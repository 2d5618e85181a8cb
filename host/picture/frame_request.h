// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

/// What a picture shows (`--show`): the lit scene, or a view of what lights it.
enum class ViewKind {
    lit,
    albedo,
    normal,
    depth,
    position,
    roughness,
    lights,
    clusters,
    slices,
    active,
    overdraw,
    difference,
    false_positives,
    shadows,
    layers,
    luminance,
    illuminance
};

/// Whether a view is made from the picture's radiance.
constexpr bool shows_radiance(ViewKind view) {
    return view == ViewKind::difference || view == ViewKind::luminance;
}

/// Of which surfaces AOVs and views tell: the opaque ones, or the nearest, which may blend.
enum class SurfaceLayer { opaque, nearest };

/// The results that a caller wants of a frame. Nothing else leaves the device.
struct FrameRequest {
    bool display = true;            // Frame::display
    bool radiance = true;           // Frame::radiance
    bool shown_light = false;       // Frame::shown_light
    bool counts = false;            // also k*, by one more pass
    bool shadow_counts = false;     // also FrameStats::shadows, by casting the shadows once more
    ViewKind view = ViewKind::lit;  // what Frame::display shows
    std::vector<std::string> aovs;  // Frame::aovs, see aov_kinds()
    SurfaceLayer layer = SurfaceLayer::opaque;
    bool probes = false;  // pixels will be probed: surfaces keep all attributes
    // Renderers that make one picture together, whose caller takes it in strips of rows: see
    // MemoryPlan::strip_rows. 0: it takes the whole.
    int strip_makers = 0;
    std::uint64_t crop_pixels = 0;  // of the largest part that the caller takes of the picture
    bool operator==(const FrameRequest&) const = default;

    bool has_aov(std::string_view name) const {
        return std::ranges::find(aovs, name) != aovs.end();
    }
    /// Whether surfaces or counts of single pixels are read.
    bool pixels() const { return !aovs.empty() || view != ViewKind::lit; }

    /// Whether illuminance is made beside the picture.
    bool illuminance() const { return has_aov("illuminance") || view == ViewKind::illuminance; }

    /// Whether surfaces that blend are read.
    bool layers() const {
        return pixels() && (layer == SurfaceLayer::nearest || view == ViewKind::layers ||
                            has_aov("layer-count"));
    }

    /// Whether attributes of surfaces are wanted that no light needs.
    bool whole_surfaces() const { return pixels() || probes; }
};

/// Only the linear light.
inline FrameRequest radiance_only() {
    FrameRequest request;
    request.display = false;
    return request;
}

}  // namespace kilolux
