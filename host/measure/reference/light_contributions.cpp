// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/light_contributions.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/measure/reference/decoded_samples.h"
#include "kernels/shared/lights/light_transform.h"

namespace kilolux {
namespace {

// Why a light adds nothing: the first reason that applies. `in_reach`: by range and cone.
const char* why_dark(const LightContribution& light, bool in_reach, bool seen, bool faces) {
    if (light.radiance != glm::dvec3(0.0)) return "";
    if (!(light.distance < light.range)) return "out of range";
    if (!in_reach) return "outside its cone";
    if (!faces) return "behind the surface";
    return seen ? "too faint" : "hidden";
}

}  // namespace

std::vector<LightContribution> light_contributions(const PixelProbe& probe,
                                                   ReferenceOptions model) {
    model.ambient = 0.0;
    SurfaceSamples surfaces = make_surface_samples(1, 1);
    SurfaceSample& surface = surfaces.at(0, 0);
    surface = surface_sample([&](std::size_t plane) { return probe.surface[plane]; }, probe.unlit);
    surface.emissive = glm::dvec3(0.0);
    std::vector<LightContribution> out;
    for (const ProbedLight& light : probe.lights) {
        const ReferenceLights one = reference_lights(
            std::span(&light.shade, 1), {}, {std::span(&light.web, 1), std::span(&light.shape, 1)});
        const ReferencePicture lit = shade_reference(surfaces, one, model);
        const bool seen = light.seen.value_or(true);
        const glm::dvec3 way = one.lights.front().position - surface.position;
        LightContribution& next = out.emplace_back();
        next.index = light.index;
        next.distance = glm::length(way);
        next.range = 1.0 / std::sqrt(double{inv_range2_of(light.shade)});
        if (seen) next.radiance = {lit.radiance.rgb[0], lit.radiance.rgb[1], lit.radiance.rgb[2]};
        next.why_dark =
            why_dark(next, lit.reaching.front() > 0, seen, glm::dot(way, surface.normal) > 0.0);
    }
    const auto brightness = [](const LightContribution& s) {
        return std::max({s.radiance.x, s.radiance.y, s.radiance.z});
    };
    std::ranges::stable_sort(out, std::greater(), brightness);
    return out;
}

}  // namespace kilolux
