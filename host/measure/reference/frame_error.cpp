// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/frame_error.h"

#include <algorithm>
#include <cmath>

#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/reference.h"

namespace kilolux {
namespace {

constexpr double kWidest = 320.0;     // [pixel]
constexpr double kEvaluations = 2e8;  // of lights at pixels: some seconds of two cores
constexpr int kSmallestEdge = 16;     // [pixel]

void make_small(RenderSettings& settings, std::uint64_t lights) {
    const double pixels = static_cast<double>(settings.width) * settings.height;
    const double all = pixels * static_cast<double>(std::max<std::uint64_t>(lights, 1));
    const double scale = std::min({1.0, kWidest / settings.width, std::sqrt(kEvaluations / all)});
    settings.width = std::max(kSmallestEdge, static_cast<int>(scale * settings.width));
    settings.height = std::max(kSmallestEdge, static_cast<int>(scale * settings.height));
}

bool stores_surfaces(RendererKind renderer) {
    return renderer == RendererKind::deferred || renderer == RendererKind::deferred_all;
}

// By every light in float64, from the surfaces of the renderer's last picture.
ReferencePicture reference_of(Renderer& renderer, bool orthographic, const OnProgress& progress) {
    const LitSurfaces lit = renderer.lit_surfaces();
    ReferenceOptions options;
    options.shading = static_cast<Shading>(renderer.plan().kernels.shading + 1);
    options.ambient = static_cast<double>(renderer.settings().ambient);
    options.orthographic = orthographic;
    options.progress = progress;
    return shade_reference(surface_samples(lit.surfaces),
                           reference_lights(lit.lights, lit.directional), options);
}

ReferenceError error_of(const RgbImage& picture, const ReferencePicture& reference) {
    ReferenceError out;
    HdrOptions options;
    options.scale = &reference.scale;
    out.hdr = compare_hdr(picture, reference.radiance, options);
    const FlipResult flip = flip_hdr(picture, reference.radiance).flip;
    out.flip_mean = flip.error.mean;
    out.flip_max = flip.error.max;
    return out;
}

// |x - r| / max(|r|, E) of each pixel, the largest of its channels; 0 where x = r.
std::vector<double> relative_errors(const RgbImage& picture, const ReferencePicture& reference) {
    std::vector<double> out(picture.pixel_count(), 0.0);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        const double r = reference.radiance.rgb[i];
        const double error = std::abs(picture.rgb[i] - r);
        if (error == 0.0) continue;
        double& worst = out[i / 3];
        worst = std::max(worst, error / std::max(std::abs(r), reference.scale.rgb[i]));
    }
    return out;
}

}  // namespace

FrameError measure_frame_error(Renderer& renderer, RenderSettings settings, const Camera& camera,
                               double time, const OnProgress& progress) {
    make_small(settings, renderer.light_count(settings));
    settings.want = radiance_only();
    settings.samples = 1;
    renderer.change(settings);
    const Frame frame = renderer.render(camera, time);
    const RgbImage picture = rgb_image_of(frame.width, frame.height, frame.radiance);
    FrameError out;
    out.width = frame.width;
    out.height = frame.height;
    const bool stored = stores_surfaces(settings.renderer);
    const double first = stored ? 0.5 : 0.0;
    const auto part = [&](double from, double to) {
        if (!progress) return OnProgress{};
        return OnProgress([=](double share) { progress(from + share * (to - from)); });
    };
    if (stored) {
        out.kernels =
            error_of(picture, reference_of(renderer, camera.orthographic, part(0.0, first)));
    }
    settings.renderer = RendererKind::deferred;
    settings.gbuffer = GBUFFER_FULL;
    renderer.change(settings);
    renderer.render(camera, time);
    const ReferencePicture full = reference_of(renderer, camera.orthographic, part(first, 1.0));
    out.whole = error_of(picture, full);
    out.relative = relative_errors(picture, full);
    out.lights_per_pixel = full.lights_per_pixel;
    return out;
}

}  // namespace kilolux
