// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "host/render/environment_light.h"
#include "host/render/frame_stages.h"
#include "host/render/lights/light_source.h"
#include "host/render/picture_output.h"
#include "host/render/read/band_reader.h"
#include "host/render/render_context.h"
#include "host/render/samples.h"

namespace kilolux {

/// A renderer's stages, built for one device and scene plan. render_frame() runs them.
struct Pipeline {
    /// `opened`: see open_device(). Throws Error as Renderer does.
    Pipeline(std::shared_ptr<RenderScene> scene, const RenderSettings& settings, const Gpu& opened);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    /// Makes `pipeline` serve `settings`: keeps it where its kernels and device do, else replaces
    /// it.
    static void change(std::unique_ptr<Pipeline>& pipeline,
                       const std::shared_ptr<RenderScene>& scene, const RenderSettings& settings);

    RenderContext context;
    // Makes the picture.
    LightSource lights;
    std::map<RendererKind, FrameStages> stages;  // made when first asked for
    EnvironmentLight environment;
    Samples samples;
    PictureOutput picture;
    StageTimer timer;
    // The last frame's results, and their reader.
    struct Last {
        Camera camera;
        LightRows rows;  // where OpenGL's fragments are lit
        LitBand band;
        PictureKey opengl;     // of the picture in its targets
        int raster_tile = -1;  // first row of the one that OpenGL's targets hold; -1: none
        bool is_sound = true;  // no frame has failed
    };
    Last last;
    BandReader reader;
    std::unique_ptr<Pipeline> reference;  // for the view of differences from it

    FrameStages& current_stages() { return stages.at(context.settings.renderer); }
    LastSample last_sample() { return {last.band, current_stages(), last.camera}; }

 private:
    bool is_built_for(const RenderSettings& wanted) const;
    void take(const RenderSettings& next);
    void take_up_settings();
};

}  // namespace kilolux
