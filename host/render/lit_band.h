// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/gpu/surface_flow.h"
#include "host/lighting/light_lists.h"
#include "host/lighting/visibility.h"
#include "host/picture/bands.h"
#include "host/picture/frame.h"
#include "host/render/lights/light_rows.h"
#include "host/scene/open_tiles.h"

namespace kilolux {

/// The fine tiles of a band that need a sample; the others' pixels may be background.
struct NeededTiles {
    TileCounts done;
    OpenTiles open;
};

/// One sample of a band of a frame to light: the lights on the host and, uploaded, on the device.
struct Sample {
    Camera camera;  // of the whole picture
    const LightRows& rows;
    LightInput lights;
    Band band;
    bool redraw = true;  // else OpenGL's targets still hold this sample of the band's raster tile
    uint number = 0;     // of the pixel's samples
    const NeededTiles* needed = nullptr;  // null: all tiles of the band
    // Where the display picture goes; then no radiance is stored.
    std::optional<DisplayTarget> display = {};
};

/// The results of a sample on the device, which AOVs, views, counts and probes read. Valid until
/// the next sample.
struct LitBand {
    GBuffer surfaces;     // none of the forward renderers
    ShadowInput shadows;  // that are cast onto the surfaces
    LightInput lights;
    ClusterGrid grid{};
    ListedLights lists;             // of `deferred`
    HostCoarseLists coarse;         // of `forward-plus`
    SeenLights visible;             // with shadows, of `deferred`
    Radiance light;                 // of the forward renderers before shading: the background
    std::optional<Radiance> shown;  // after the stages over the whole picture
    std::optional<DisplayTarget> display;  // the picture of `shown`, or made by shading

    bool has_surfaces() const { return surfaces.bytes.buffer()() != nullptr; }

    /// Forgets what is made of the surfaces: arrays that grow must not be held twice.
    void drop_lists() {
        lists = {};
        visible = {};
        drop_picture();
    }

    /// Forgets what is made of the light.
    void drop_picture() {
        shown.reset();
        display.reset();
    }
};

/// The times and counts that stages add to.
struct Measured {
    StageTimer& timer;
    FrameStats& stats;
};

}  // namespace kilolux
