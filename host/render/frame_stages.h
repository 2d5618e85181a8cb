// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/lighting/deferred_lighting.h"
#include "host/render/forward_shading.h"
#include "host/render/layers.h"
#include "host/render/lit_band.h"
#include "host/render/surface_pass.h"

namespace kilolux {

/// Which stages of a sample had room.
struct Room {
    bool surfaces = false, lists = false;
    bool enough() const { return surfaces && lists; }
};

/// The stages from surfaces to radiance. Each renderer has some of them:
///
///     deferred      surfaces, lists, visibility with shadows, shading by lists, blended surfaces
///     deferred-all  surfaces,                                 shading by all,   blended surfaces
///     forward-plus            coarse lists,                   OpenGL's fragments
///     forward                                                 OpenGL's fragments
///
/// Each function fills its part of the band; without such a stage it does nothing.
class FrameStages {
 public:
    /// The stages of context.settings.renderer.
    explicit FrameStages(RenderContext& context);

    /// Starts a sample of a band: draws the G-buffer, what casts shadows onto it, and the coarse
    /// grid.
    void draw_surfaces(const Sample& sample, LitBand& band, Measured out);

    /// The lists of lights of its pixels.
    void list_lights(const Sample& sample, LitBand& band, Measured out);

    /// Which pixels see which lights of their lists.
    void find_visible(LitBand& band, Measured out);

    /// Radiance, or with sample.display the display picture.
    void shade(const Sample& sample, LitBand& band, Measured out);

    /// Enqueues the counting that room() waits for.
    void count(Measured out);

    /// Which of the last calls had room; the others must run again, and then have it. Waits for
    /// their counts. Sets the counts of lists.
    Room room(const LitBand& band, Measured out);

    /// The surfaces that blend, as layers over the others.
    BlendedLayers& layer_surfaces();

    /// Lays the first layers of surfaces that blend over the lit ones. Others may follow: see
    /// blend_rest().
    void blend(LitBand& band, EnvironmentLight& environment, Measured out);

    bool expects_no_more_layers() const { return !layers_ || layers_->expects_no_more(); }

    /// After room(): further layers of them; false: there were none. Blocks.
    bool blend_rest(LitBand& band, EnvironmentLight& environment, Measured out);

    /// Draws the G-buffer for the forward renderers, which only later requests need.
    void draw_missing_surfaces(const Camera& camera, LitBand& band);

    /// The lists of `deferred`; null for the others.
    const LightLists* lists() const { return lists_ ? &*lists_ : nullptr; }
    /// The visibility of `deferred` with shadows; null else.
    Visibility* visibility() { return visibility_ ? &*visibility_ : nullptr; }
    /// The lights of `deferred-all`, as it shades them.
    const PreparedLights& all_lights() const { return shade_all_->lights(); }

    /// With sampled shadows: see Shade::variance().
    DeviceArray<float> variance() const {
        return shade_ ? shade_->variance() : shade_all_->variance();
    }

 private:
    RenderContext& context_;
    std::optional<SurfacePass> surfaces_;  // of the forward renderers when first asked for
    std::optional<LightLists> lists_;
    std::optional<CoarseLightLists> coarse_;
    bool has_coarse_ = true;  // the last lists of coarse_ had room
    std::optional<Visibility> visibility_;
    std::optional<Shade> shade_;
    std::optional<AllLightsLighting> shade_all_;
    std::optional<ForwardShading> forward_;
    std::optional<BlendedLayers> layer_surfaces_;  // when first asked for
    std::optional<Layers> layers_;
};

}  // namespace kilolux
