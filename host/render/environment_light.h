// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "host/render/lit_band.h"
#include "host/render/render_context.h"
#include "host/stages/shading/fill_background.h"
#include "host/stages/shading/reflect_environment.h"

namespace kilolux {

/// The light of a background that the display shows as it is; none for other backgrounds.
Backdrop backdrop_of(const RenderSettings& settings);

/// Adds an environment to lit surfaces: its reflections, and the environment behind them.
class EnvironmentLight {
 public:
    static std::uint64_t device_bytes(const RenderSettings& settings);

    /// Takes over settings.background and settings.reflections where they changed. Throws Error;
    /// the part that failed then keeps its former value.
    void set(const RenderContext& context);

    /// Before shading: the background at all pixels of the light that OpenGL draws over; nothing
    /// for the deferred renderers. Enqueues only.
    void fill_behind(const LitBand& band, StageTimer& timer);

    /// Adds both to lit surfaces, of the deferred renderers. Enqueues only.
    void enqueue(const LitBand& band, StageTimer& timer);

    /// Adds the reflections to the surfaces of a layer. Enqueues only.
    void reflect_in_layer(const GBuffer& surfaces, const Radiance& light, StageTimer& timer);

 private:
    std::shared_ptr<const Environment> image_;  // that background_ has
    Backdrop backdrop_;                         // of image_
    std::shared_ptr<const PrefilteredEnvironment> maps_;
    std::optional<FillBackground> background_;
    std::optional<ReflectEnvironment> reflections_;
    std::optional<ReflectEnvironment> of_layers_;  // none: as the others
};

}  // namespace kilolux
