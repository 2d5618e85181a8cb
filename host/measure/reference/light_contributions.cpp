// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/light_contributions.h"

#include <algorithm>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/reference.h"

namespace kilolux {
namespace {

// Without emission.
SurfaceSample surface_of(const PixelProbe& probe) {
    SurfaceSample out = surface_sample([&](std::size_t plane) { return probe.surface[plane]; },
                                       probe.specular, probe.unlit);
    out.emissive = glm::dvec3(0.0);
    return out;
}

}  // namespace

std::vector<LightContribution> light_contributions(const PixelProbe& probe, Shading shading,
                                                   bool orthographic) {
    SurfaceSamples surfaces = make_surface_samples(1, 1);
    surfaces.at(0, 0) = surface_of(probe);
    ReferenceOptions options;
    options.shading = shading;
    options.orthographic = orthographic;
    std::vector<LightContribution> out;
    for (const ProbedLight& light : probe.lights) {
        const ReferenceLights one = reference_lights(std::span(&light.shade, 1), {});
        const RgbImage lit = shade_reference(surfaces, one, options).radiance;
        LightContribution share;
        share.index = light.index;
        share.distance = glm::length(one.lights.front().position - surfaces.at(0, 0).position);
        share.range = static_cast<double>(light.light.position_range.w);
        share.radiance = {lit.rgb[0], lit.rgb[1], lit.rgb[2]};
        out.push_back(share);
    }
    const auto brightness = [](const LightContribution& s) {
        return std::max({s.radiance.x, s.radiance.y, s.radiance.z});
    };
    std::stable_sort(out.begin(), out.end(),
                     [&](const LightContribution& a, const LightContribution& b) {
                         return brightness(a) > brightness(b);
                     });
    return out;
}

}  // namespace kilolux
