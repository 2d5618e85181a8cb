// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "host/measure/metrics/compensated_sum.h"
#include "host/measure/reference/area/area_parts.h"
#include "host/measure/reference/reference_brdf.h"

namespace kilolux {
namespace {

class CompensatedSum3 {
 public:
    void add(const glm::dvec3& term) {
        for (int c = 0; c < 3; ++c) sums_[static_cast<std::size_t>(c)].add(term[c]);
    }
    glm::dvec3 value() const { return {sums_[0].value(), sums_[1].value(), sums_[2].value()}; }

 private:
    std::array<CompensatedSum, 3> sums_;
};

// A pixel while its lights are summed.
struct Pixel {
    CompensatedSum3 radiance;
    CompensatedSum3 scale;
    std::uint32_t lights = 0;
    std::uint32_t reaching = 0;
};

glm::dvec3 direction_to_eye(const glm::dvec3& position, bool orthographic) {
    const double distance = glm::length(position);
    if (orthographic || distance == 0.0) return {0.0, 0.0, 1.0};
    return -position / distance;
}

// Adds light that would arrive with `irradiance` on a surface that faces it.
// `passing()`: the share of it that does.
template <typename Passing>
void add_incident(Pixel& pixel, const SurfaceSample& surface, const glm::dvec3& to_light,
                  const glm::dvec3& irradiance, const ReferenceOptions& options,
                  const Passing& passing) {
    pixel.scale.add(glm::abs(irradiance));
    const glm::dvec3 to_eye = direction_to_eye(surface.position, options.orthographic);
    const glm::dvec3 share = reference_reflection(surface, to_eye, to_light, options.shading);
    if (share == glm::dvec3(0.0)) return;
    const glm::dvec3 passed = passing();
    if (passed != glm::dvec3(0.0)) pixel.radiance.add(share * irradiance * passed);
}

// The share of a light with a size that comes to the point of what it would reflect if nothing hid
// it: a quadrature over steps^2 rays, by which the exact integral is multiplied.
template <typename Reflected>
glm::dvec3 share_of_rays(const AreaShape& shape, const glm::dvec3& position,
                         const ShadowPoint& point, const ReferenceOptions& options, int steps,
                         const Reflected& reflected) {
    const ShadowCaster& caster = *options.shadows;
    CompensatedSum3 passed, all;
    for (const AreaPart& part : parts_of(shape, steps)) {
        if (part.solid_angle == 0.0) continue;
        const glm::dvec3 light = reflected(glm::normalize(part.to_light)) * part.solid_angle;
        if (light == glm::dvec3(0.0)) continue;
        all.add(light);
        const glm::dvec3 target = position + part.to_light;
        passed.add(light * (options.tinted_shadows ? caster.share(point, target, options.shading)
                                                   : glm::dvec3(caster.sees(point, target))));
    }
    const glm::dvec3 sum = all.value();
    glm::dvec3 share(1.0);
    for (int c = 0; c < 3; ++c) {
        if (sum[c] > 0.0) share[c] = passed.value()[c] / sum[c];
    }
    return share;
}

// The same, with a quarter of the rays where all of these pass or none does.
template <typename Reflected>
glm::dvec3 passing_share(const AreaShape& shape, const glm::dvec3& position,
                         const ShadowPoint& point, const ReferenceOptions& options,
                         const Reflected& reflected) {
    const auto share = [&](int steps) {
        return share_of_rays(shape, position, point, options, steps, reflected);
    };
    const glm::dvec3 coarse = share(options.area_steps / 2);
    const bool agree = coarse == glm::dvec3(0.0) || coarse == glm::dvec3(1.0);
    return agree ? coarse : share(options.area_steps);
}

// A light with a size: its luminance times BRDF times cosine over its solid angle. `point`: from
// where shadow rays go, if they do.
void add_area(Pixel& pixel, const SurfaceSample& surface, const ReferenceLight& light,
              const std::optional<ShadowPoint>& point, const ReferenceOptions& options) {
    const double window = window_at(light, surface.position, options);
    if (window == 0.0) return;
    AreaShape shape = *light.shape;
    shape.center = light.position - surface.position;
    const glm::dvec3 luminance = light.intensity * (window * light.inverse_area);
    const double side = glm::dot(shape.center, glm::cross(shape.half_x, shape.half_y));
    const bool is_sphere = shape.kind == AreaKind::sphere;
    const double margin = kReachMargin * glm::length(shape.half_x) * glm::length(shape.half_y) *
                          glm::length(shape.center);
    ++pixel.lights;
    pixel.reaching +=
        window > 2.0 * kReachMargin && (is_sphere || shape.two_sided || side < -margin);
    // The irradiance of a disk of that area straight ahead, at least.
    const double square = glm::dot(shape.center, shape.center);
    pixel.scale.add(luminance / (square * light.inverse_area + 1.0 / std::numbers::pi));
    const glm::dvec3 to_eye = direction_to_eye(surface.position, options.orthographic);
    const auto reflected = [&](const glm::dvec3& to_light) {
        return reference_reflection(surface, to_eye, to_light, options.shading);
    };
    const bool one_horizon = surface.coat == 0.0;
    const AreaIntegral sum =
        one_horizon ? integrate_area(shape, surface.normal, reflected, options.area_tolerance)
                    : integrate_area(shape, reflected, options.area_tolerance);
    if (sum.value == glm::dvec3(0.0)) return;
    const glm::dvec3 share =
        point ? passing_share(shape, surface.position, *point, options, reflected)
              : glm::dvec3(1.0);
    pixel.radiance.add(luminance * sum.value * share);
}

Pixel shade(const SurfaceSample& surface, const ReferenceLights& lights,
            const ReferenceOptions& options) {
    Pixel pixel;
    const glm::dvec3 to_eye = direction_to_eye(surface.position, options.orthographic);
    const double below = 1.0 - reference_coat_share(surface, to_eye, options.shading);
    pixel.radiance.add(below * surface.emissive);
    if (surface.kind != SurfaceKind::lit) return pixel;
    pixel.radiance.add(below * options.ambient * surface.occlusion *
                       reference_ambient_albedo(surface, to_eye, options.shading));
    std::optional<ShadowPoint> point;  // none: it sees every light
    if (options.shadows != nullptr)
        point = options.shadows->point_at(surface.position, surface.blended);
    for (const ReferenceDirectionalLight& light : lights.directional) {
        add_incident(pixel, surface, light.to_light, light.illuminance, options, [&] {
            if (!point) return glm::dvec3(1.0);
            const ShadowCaster& caster = *options.shadows;
            return options.tinted_shadows
                       ? caster.share_of_direction(*point, light.to_light, options.shading)
                       : glm::dvec3(caster.sees_direction(*point, light.to_light));
        });
    }
    for (const ReferenceLight& light : lights.lights) {
        if (light.shape) {
            add_area(pixel, surface, light, point, options);
            continue;
        }
        const Incidence in = incidence(light, surface.position, options);
        if (in.attenuation == 0.0) continue;
        ++pixel.lights;
        pixel.reaching += in.reaches;
        add_incident(pixel, surface, in.to_light, light.intensity * in.attenuation, options, [&] {
            if (!point) return glm::dvec3(1.0);
            const ShadowCaster& caster = *options.shadows;
            return options.tinted_shadows ? caster.share(*point, light.position, options.shading)
                                          : glm::dvec3(caster.sees(*point, light.position));
        });
    }
    return pixel;
}

void store(RgbImage& image, std::size_t i, const glm::dvec3& value) {
    for (int c = 0; c < 3; ++c) image.rgb[3 * i + static_cast<std::size_t>(c)] = value[c];
}

glm::dvec3 value_at(const RgbImage& image, std::size_t i) {
    return {image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]};
}

}  // namespace

ReferencePicture shade_reference(const std::vector<SurfaceSamples>& layers,
                                 const ReferenceLights& lights, const ReferenceOptions& options) {
    const auto picture_of = [&](std::size_t k) {
        ReferenceOptions part = options;
        if (options.progress) {
            part.progress = [&, k](double share) {
                options.progress((static_cast<double>(k) + share) /
                                 static_cast<double>(layers.size()));
            };
        }
        return shade_reference(layers[k], lights, part);
    };
    ReferencePicture out = picture_of(0);
    for (std::size_t k = 1; k < layers.size(); ++k) {
        const ReferencePicture over = picture_of(k);
        for (std::size_t i = 0; i < layers[k].pixels.size(); ++i) {
            const SurfaceSample& surface = layers[k].pixels[i];
            if (surface.kind == SurfaceKind::background) continue;
            const glm::dvec3 share = reference_share_behind(
                surface, direction_to_eye(surface.position, options.orthographic), options.shading);
            for (const auto image : {&ReferencePicture::radiance, &ReferencePicture::scale}) {
                store(
                    out.*image, i,
                    surface.coverage * value_at(over.*image, i) + share * value_at(out.*image, i));
            }
        }
    }
    return out;
}

ReferencePicture shade_reference(const SurfaceSamples& surfaces, const ReferenceLights& lights,
                                 const ReferenceOptions& options) {
    ReferencePicture out{.radiance = make_rgb_image(surfaces.width, surfaces.height),
                         .scale = make_rgb_image(surfaces.width, surfaces.height)};
    out.reaching.resize(surfaces.pixels.size());
    std::vector<std::uint32_t> lights_of(surfaces.pixels.size());
    const auto shade_row = [&](int y) {
        for (int x = 0; x < surfaces.width; ++x) {
            const std::size_t i = surfaces.index(x, y);
            if (surfaces.pixels[i].kind == SurfaceKind::background) continue;
            const Pixel pixel = shade(surfaces.pixels[i], lights, options);
            store(out.radiance, i, pixel.radiance.value());
            store(out.scale, i, pixel.scale.value());
            out.reaching[i] = pixel.reaching;
            lights_of[i] = pixel.lights;
        }
    };
    parallel_rows(surfaces.height, shade_row, options.progress);
    const auto hit =
        static_cast<std::ptrdiff_t>(surfaces.pixels.size()) -
        std::ranges::count(surfaces.pixels, SurfaceKind::background, &SurfaceSample::kind);
    const double sum = std::accumulate(lights_of.begin(), lights_of.end(), 0.0);
    if (hit > 0) out.lights_per_pixel = sum / static_cast<double>(hit);
    return out;
}

}  // namespace kilolux
