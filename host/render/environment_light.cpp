// SPDX-License-Identifier: Apache-2.0
#include "host/render/environment_light.h"

#include <utility>

namespace kilolux {
namespace {

std::optional<FillBackground> make_background(const RenderContext& context) {
    if (!context.settings.background) return {};
    const Environment& image = *context.settings.background;
    FillBackground out(context.gpu, context.tuning);
    out.set_image({&image.rows.data()->x, 3 * image.rows.size()}, static_cast<uint>(image.width),
                  static_cast<uint>(image.height));
    return out;
}

std::optional<ReflectEnvironment> make_reflections(const RenderContext& context) {
    if (!context.settings.reflections) return {};
    const PrefilteredEnvironment& maps = *context.settings.reflections;
    ReflectEnvironment out(context.gpu, context.tuning, context.plan.kernels);
    out.set_maps({maps.texels, maps.levels, maps.table, maps.table_size});
    return out;
}

}  // namespace

void EnvironmentLight::set(const RenderContext& context) {
    const RenderSettings& settings = context.settings;
    if (maps_ != settings.reflections) {
        reflections_ = make_reflections(context);
        maps_ = settings.reflections;
    }
    if (image_ != settings.background) {
        background_ = make_background(context);
        image_ = settings.background;
    }
}

void EnvironmentLight::enqueue(const LitBand& band, StageTimer& timer) {
    if (!band.surfaces.bytes.buffer()()) return;  // OpenGL drew over the picture of fill()
    if (reflections_) reflections_->enqueue(band.surfaces, band.light, timer);
    if (background_) background_->enqueue(band.surfaces, band.light, timer);
}

void EnvironmentLight::fill(const Radiance& radiance, StageTimer& timer) {
    background_->enqueue_everywhere(radiance, timer);
}

}  // namespace kilolux
