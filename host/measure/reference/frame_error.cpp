// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/frame_error.h"

#include <algorithm>
#include <cassert>

#include "host/measure/metrics/error_size.h"
#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/reference.h"

namespace kilolux {
namespace {

constexpr ErrorSizeLimits kLimits = {.width = 320, .evaluations = 2e8};
constexpr int kSmallestEdge = 16;  // [pixel]

void make_small(RenderSettings& settings, std::uint64_t lights) {
    const auto [width, height] = error_size({settings.width, settings.height}, lights, kLimits);
    settings.width = std::max(kSmallestEdge, width);
    settings.height = std::max(kSmallestEdge, height);
}

// The float64 reference of the surfaces of the renderer's last picture.
ReferencePicture reference_of(Renderer& renderer, const Camera& camera,
                              const OnProgress& progress) {
    ReferenceOptions options = reference_options(renderer, camera);
    options.progress = progress;
    return picture_reference(renderer, camera, options);
}

ReferenceError error_of(const RgbImage& picture, const ReferencePicture& reference) {
    const ErrorDistribution flip = flip_hdr(picture, reference.radiance).error;
    return {.hdr = compare_hdr(picture, reference.radiance, {.scale = &reference.scale}),
            .flip_mean = flip.mean,
            .flip_max = flip.max};
}

}  // namespace

std::string_view beyond_reference(const RenderSettings& settings) {
    if (settings.samples > 1 || settings.auto_samples.on) return "samples";
    if (settings.background) return "background";
    return settings.reflections ? "reflections" : "";
}

FrameError measure_frame_error(Renderer& renderer, RenderSettings settings, const Camera& camera,
                               double time, const OnProgress& progress) {
    make_small(settings, renderer.light_count(settings));
    settings.want = radiance_only();
    settings.samples = 1;
    settings.auto_samples.on = false;
    settings.background.reset();
    settings.reflections.reset();
    assert(beyond_reference(settings).empty());
    renderer.change(settings);
    const Frame frame = renderer.render(camera, time);
    const RgbImage picture = rgb_image_of(frame.width, frame.height, frame.radiance);
    FrameError out;
    out.width = frame.width;
    out.height = frame.height;
    const bool stored = !is_forward(settings.renderer);
    const double first = stored ? 0.5 : 0.0;
    const auto part = [&](double from, double to) {
        if (!progress) return OnProgress{};
        return OnProgress([=](double share) { progress(from + share * (to - from)); });
    };
    if (stored) {
        out.kernels = error_of(picture, reference_of(renderer, camera, part(0.0, first)));
    }
    settings.renderer = RendererKind::deferred;
    settings.gbuffer = GBUFFER_FULL;
    renderer.change(settings);
    renderer.render(camera, time);
    const ReferencePicture full = reference_of(renderer, camera, part(first, 1.0));
    out.whole = error_of(picture, full);
    out.relative = pixel_errors(picture, full.radiance, &full.scale);
    out.lights_per_pixel = full.lights_per_pixel;
    return out;
}

}  // namespace kilolux
