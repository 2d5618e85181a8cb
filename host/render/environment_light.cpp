// SPDX-License-Identifier: Apache-2.0
#include "host/render/environment_light.h"

#include <cmath>
#include <cstring>
#include <span>

#include "host/base/formats/srgb.h"
#include "host/picture/shown_light.h"

namespace kilolux {
namespace {

std::optional<FillBackground> make_background(const RenderContext& context,
                                              const Backdrop& backdrop) {
    if (!context.settings.background) return {};
    const Environment& image = *context.settings.background;
    std::span<const float> rgb(&image.rows.data()->x, 3 * image.rows.size());
    if (image.as_shown) rgb = {&backdrop.light.x, 3};
    FillBackground out(context.gpu, context.tuning);
    out.set_image(rgb, static_cast<uint>(image.width), static_cast<uint>(image.height));
    return out;
}

ReflectionMapsView view_of(const PrefilteredEnvironment& maps) {
    return {maps.texels, maps.levels, maps.table, maps.table_size};
}

std::optional<ReflectEnvironment> make_reflections(const RenderContext& context,
                                                   const ScenePlan& plan) {
    if (!context.settings.reflections) return {};
    ReflectEnvironment out(context.gpu, context.tuning, plan.kernels);
    out.set_maps(view_of(*context.settings.reflections));
    return out;
}

}  // namespace

Backdrop backdrop_of(const RenderSettings& settings) {
    Backdrop out;
    if (!settings.background || !settings.background->as_shown) return out;
    const glm::dvec3 shown = settings.background->rows.front();
    const int curve = static_cast<int>(settings.tone_curve);
    const glm::vec3 light(light_shown_as(shown, curve) / std::exp2(double{settings.exposure}));
    out.light = {light.x, light.y, light.z, 0.0f};
    out.code = 0xff000000u;
    for (int c = 0; c < 3; ++c) {
        out.code |= static_cast<uint>(std::lround(255.0 * linear_to_srgb(shown[c]))) << (8 * c);
    }
    return out;
}

std::uint64_t EnvironmentLight::device_bytes(const RenderSettings& settings) {
    return (settings.background ? FillBackground::bytes(settings.background->rows.size()) : 0) +
           (settings.reflections ? view_of(*settings.reflections).bytes() : 0);
}

void EnvironmentLight::set(const RenderContext& context) {
    const RenderSettings& settings = context.settings;
    if (maps_ != settings.reflections) {
        reflections_ = make_reflections(context, context.plan);
        const ScenePlan plan = context.plan.of_layers();
        of_layers_.reset();
        if (plan != context.plan) of_layers_ = make_reflections(context, plan);
        maps_ = settings.reflections;
    }
    const Backdrop backdrop = backdrop_of(settings);
    const bool same_light =
        std::memcmp(&backdrop.light, &backdrop_.light, sizeof backdrop.light) == 0;
    if (image_ != settings.background || !same_light) {
        background_ = make_background(context, backdrop);
        image_ = settings.background;
        backdrop_ = backdrop;
    }
}

void EnvironmentLight::fill_behind(const LitBand& band, StageTimer& timer) {
    if (background_ && !band.has_surfaces()) background_->enqueue_everywhere(band.light, timer);
}

void EnvironmentLight::enqueue(const LitBand& band, StageTimer& timer) {
    if (!band.has_surfaces()) return;  // OpenGL draws over the background
    if (reflections_) reflections_->enqueue(band.surfaces, band.light, timer);
    if (background_) background_->enqueue(band.surfaces, band.light, timer);
}

void EnvironmentLight::reflect_in_layer(const GBuffer& surfaces, const Radiance& light,
                                        StageTimer& timer) {
    auto& reflections = of_layers_ ? of_layers_ : reflections_;
    if (reflections) reflections->enqueue(surfaces, light, timer);
}

}  // namespace kilolux
