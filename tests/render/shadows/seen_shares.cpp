// SPDX-License-Identifier: Apache-2.0
#include "tests/render/shadows/seen_shares.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/measure/metrics/statistics.h"
#include "host/measure/reference/reference_brdf.h"
#include "host/measure/reference/shadow_caster.h"
#include "host/scene/lights/light_shape.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

constexpr int kCoarse = 48,
              kFine = 192;  // steps of the quadrature; fine ones where light is partial

// The light in the camera's space.
SceneLight in_view(SceneLight light, const Camera& camera) {
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    light.position = view_from_world * (light.position - camera.position);
    light.direction = view_from_world * light.direction;
    light.side = view_from_world * light.side;
    return light;
}

// visit(point, normal) of parts of the light that have the same area.
template <typename Visit>
void for_each_part(const SceneLight& light, int steps, const Visit& visit) {
    const LightEdges edges = edges_of(light);
    for (int i = 0; i < steps * steps; ++i) {
        const double u = (i / steps + 0.5) / steps, v = (i % steps + 0.5) / steps;
        const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
        const double root = std::sqrt(u);
        if (light.type == LightType::sphere) {
            const double turn = 2.0 * std::numbers::pi * v, across = std::sqrt(1.0 - x * x);
            const glm::dvec3 out(across * std::cos(turn), across * std::sin(turn), x);
            visit(light.position + static_cast<double>(light.radius) * out, out);
        } else if (light.type == LightType::triangle) {
            const glm::dvec3 at = (root * v - 1.0 / 3.0) * edges.x + (2.0 / 3.0 - root) * edges.y;
            visit(light.position + at, light.direction);
        } else if (light.type != LightType::disk || x * x + y * y <= 1.0) {
            visit(light.position + x * edges.x + y * edges.y, light.direction);
        }
    }
}

struct Share {
    double all = 0.0, seen = 0.0;
    void add(double weight, bool sees) {
        all += weight;
        seen += sees ? weight : 0.0;
    }
    double value() const { return seen / all; }
};

struct Shares {
    Share diffuse, reflected;
};

Shares shares_at(const ShadowCaster& caster, const ShadowPoint& point, const SurfaceSample& surface,
                 const SceneLight& light, Shading shading, int steps) {
    Shares out;
    const glm::dvec3 to_eye = -glm::normalize(surface.position);
    for_each_part(light, steps, [&](const glm::dvec3& at, const glm::dvec3& normal) {
        const glm::dvec3 to = at - surface.position;
        const double cosines =
            std::max(0.0, -glm::dot(to, normal)) * std::max(0.0, glm::dot(to, surface.normal));
        if (cosines == 0.0) return;
        const double weight = cosines / std::pow(glm::dot(to, to), 2.0);
        const bool sees = caster.sees(point, at);
        const glm::dvec3 brdf = reference_brdf(surface, to_eye, glm::normalize(to), shading);
        out.diffuse.add(weight, sees);
        out.reflected.add(weight * brdf.y, sees);
    });
    return out;
}

std::vector<SharePixel> true_shares(const ShadowScenario& scenario, const SurfaceSamples& surfaces,
                                    Shading shading) {
    const ShadowCaster caster(scenario.scene, scenario.camera);
    const SceneLight light = in_view(scenario.scene.lights.front(), scenario.camera);
    std::vector<SharePixel> out;
    for (std::size_t i = 0; i < surfaces.pixels.size(); ++i) {
        const SurfaceSample& surface = surfaces.pixels[i];
        if (surface.kind == SurfaceKind::background) continue;
        const auto point = caster.point_at(surface.position);
        if (!point) continue;
        Shares shares = shares_at(caster, *point, surface, light, shading, kCoarse);
        if (!(shares.reflected.all > 0.0)) continue;
        if (shares.diffuse.seen > 0.0 && shares.diffuse.value() < 1.0) {
            shares = shares_at(caster, *point, surface, light, shading, kFine);
        }
        SharePixel pixel;
        pixel.index = i;
        pixel.position = world_of(scenario.camera, surface.position);
        pixel.truth = shares.reflected.value();
        pixel.diffuse_truth = shares.diffuse.value();
        out.push_back(pixel);
    }
    return out;
}

// Whether a neighbour of the picture, or the pixel, is in the penumbra.
void mark_edges(std::vector<SharePixel>& pixels, int width) {
    std::vector<double> truths;
    for (const SharePixel& p : pixels) {
        truths.resize(std::max(truths.size(), p.index + 1), 2.0);
        truths[p.index] = p.truth;
    }
    const auto row = static_cast<std::size_t>(width);
    for (SharePixel& p : pixels) {
        for (const std::size_t other : {p.index + 1, p.index + row, p.index - 1, p.index - row}) {
            if (other < truths.size() && truths[other] != p.truth) p.is_edge = true;
        }
    }
}

// Sums over the pictures of a batch and of all.
struct PixelSums {
    double sum = 0.0, squares = 0.0, estimated = 0.0;
    double batch_sum = 0.0, batch_estimated = 0.0;
};

}  // namespace

glm::dvec3 world_of(const Camera& camera, const glm::dvec3& p_view) {
    return camera.world_from_view * p_view + camera.position;
}

SharePixels seen_shares(const ShadowScenario& scenario, RenderSettings settings, int pictures,
                        int batch) {
    RenderSettings unshadowed = settings;
    unshadowed.shadows = Shadows::off;
    Renderer off(scenario.scene, unshadowed);
    const Frame whole = off.render(scenario.camera, 0.0);
    SharePixels out;
    out.pixels =
        true_shares(scenario, surface_samples(off.lit_surfaces().surfaces), settings.shading);
    mark_edges(out.pixels, settings.width);
    out.pictures = pictures;
    out.batches = pictures / batch;
    settings.want.aovs = {"error-standard"};
    Renderer renderer(scenario.scene, settings);
    std::vector<PixelSums> sums(out.pixels.size());
    for (int seed = 1; seed <= pictures; ++seed) {
        settings.seed = static_cast<uint>(seed);
        renderer.change(settings);
        const Frame frame = renderer.render(scenario.camera, 0.0);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            SharePixel& pixel = out.pixels[i];
            PixelSums& s = sums[i];
            const double all = luminance_of(whole.radiance, pixel.index);
            const double share = luminance_of(frame.radiance, pixel.index) / all;
            const double estimated = std::pow(frame.aovs.front().values[pixel.index] / all, 2.0);
            s.sum += share;
            s.squares += share * share;
            s.estimated += estimated;
            s.batch_sum += share;
            s.batch_estimated += estimated;
            if (seed % batch != 0) continue;
            pixel.batches_within +=
                is_within(s.batch_sum / batch, s.batch_estimated / (batch * batch), pixel.truth)
                    ? 1
                    : 0;
            s.batch_sum = s.batch_estimated = 0.0;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        SharePixel& pixel = out.pixels[i];
        pixel.mean = sums[i].sum / pictures;
        pixel.variance = std::max(0.0, sums[i].squares - sums[i].sum * pixel.mean) / (pictures - 1);
        pixel.estimated = sums[i].estimated / pictures;
    }
    return out;
}

}  // namespace kilolux
