// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/light_contributions.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/measure/reference/decoded_samples.h"

namespace kilolux {

std::vector<LightContribution> light_contributions(const PixelProbe& probe,
                                                   const ReferenceOptions& model) {
    SurfaceSamples surfaces = make_surface_samples(1, 1);
    SurfaceSample& surface = surfaces.at(0, 0);
    surface = surface_sample([&](std::size_t plane) { return probe.surface[plane]; },
                             probe.specular, probe.unlit);
    surface.emissive = glm::dvec3(0.0);
    std::vector<LightContribution> out;
    for (const ProbedLight& light : probe.lights) {
        const ReferenceLights one =
            reference_lights(std::span(&light.shade, 1), {}, std::span(&light.web, 1));
        RgbImage lit = shade_reference(surfaces, one, model).radiance;
        const bool hidden = !light.seen.value_or(true);
        if (hidden) lit.rgb.assign(3, 0.0);
        const glm::dvec3 position = one.lights.front().position;
        out.push_back(
            {.index = light.index,
             .distance = glm::length(position - surface.position),
             .range = 1.0 / std::sqrt(std::abs(double{light.shade.position_inv_range2.w})),
             .radiance = {lit.rgb[0], lit.rgb[1], lit.rgb[2]},
             .hidden = hidden});
    }
    const auto brightness = [](const LightContribution& s) {
        return std::max({s.radiance.x, s.radiance.y, s.radiance.z});
    };
    std::ranges::stable_sort(out, std::greater(), brightness);
    return out;
}

}  // namespace kilolux
