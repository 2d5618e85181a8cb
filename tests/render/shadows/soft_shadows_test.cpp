// SPDX-License-Identifier: Apache-2.0
// Sampled shadows of lights with a size: against a quadrature in double, and the same bits in every
// form.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/shadow_caster.h"
#include "host/scene/lights/light_shape.h"
#include "tests/render/shadows/soft_scenes.h"

namespace kilolux {
namespace {

struct PixelTruth {
    bool shown = false;
    double seen = 0.0;  // share of the light's irradiance
};

// The points of a light and the solid angles about them, seen from the origin; `light` with its
// position and axes in view space.
template <typename Visit>
void for_each_part(const SceneLight& light, int steps, const Visit& visit) {
    const LightEdges edges = edges_of(light);
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double u = (i + 0.5) / steps, v = (j + 0.5) / steps;
            glm::dvec3 at = light.position, normal = light.direction;
            double area = 1.0;
            if (light.type == LightType::sphere) {
                const double z = 1.0 - 2.0 * u, around = 2.0 * 3.14159265358979 * v;
                const double across = std::sqrt(1.0 - z * z);
                normal = {across * std::cos(around), across * std::sin(around), z};
                at += static_cast<double>(light.radius) * normal;
            } else if (light.type == LightType::triangle) {
                const double root = std::sqrt(u);
                at += (root * v - 1.0 / 3.0) * edges.x + (1.0 - root - 1.0 / 3.0) * edges.y;
            } else {
                const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
                if (light.type == LightType::disk && x * x + y * y > 1.0) continue;
                at += x * edges.x + y * edges.y;
            }
            visit(at, normal, area);
        }
    }
}

SceneLight in_view(SceneLight light, const Camera& camera) {
    const glm::dmat3 view_from_world = glm::transpose(camera.world_from_view);
    light.position = view_from_world * (light.position - camera.position);
    light.direction = view_from_world * light.direction;
    light.side = view_from_world * light.side;
    return light;
}

std::vector<PixelTruth> truth_of(const ShadowScenario& scenario, Renderer& renderer, int steps) {
    const ShadowCaster caster(scenario.scene, scenario.camera);
    const SceneLight light = in_view(scenario.scene.lights.front(), scenario.camera);
    const SurfaceSamples surfaces = surface_samples(renderer.lit_surfaces().surfaces);
    std::vector<PixelTruth> out(surfaces.pixels.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const SurfaceSample& surface = surfaces.pixels[i];
        if (surface.kind == SurfaceKind::background) continue;
        const auto point = caster.point_at(surface.position);
        if (!point) continue;
        double all = 0.0, seen = 0.0;
        for_each_part(light, steps, [&](const glm::dvec3& at, const glm::dvec3& normal, double) {
            const glm::dvec3 to = at - surface.position;
            const double cosines =
                std::max(0.0, -glm::dot(to, normal)) * std::max(0.0, glm::dot(to, surface.normal));
            const double weight = cosines / std::pow(glm::dot(to, to), 2.0);
            if (weight == 0.0) return;
            all += weight;
            seen += caster.sees(*point, at) ? weight : 0.0;
        });
        if (all > 0.0) out[i] = {true, seen / all};
        if (!(seen > 0.0 && seen < all) || steps > 100) continue;
        all = seen = 0.0;
        for_each_part(light, 256, [&](const glm::dvec3& at, const glm::dvec3& normal, double) {
            const glm::dvec3 to = at - surface.position;
            const double cosines =
                std::max(0.0, -glm::dot(to, normal)) * std::max(0.0, glm::dot(to, surface.normal));
            const double weight = cosines / std::pow(glm::dot(to, to), 2.0);
            if (weight == 0.0) return;
            all += weight;
            seen += caster.sees(*point, at) ? weight : 0.0;
        });
        out[i].seen = seen / all;
    }
    return out;
}

TEST(SoftShadows, Experiment) {
    for (const LightType type :
         {LightType::rectangle, LightType::disk, LightType::sphere, LightType::triangle}) {
        const ShadowScenario scenario = board_below(panel(type));
        RenderSettings settings = soft_settings();
        settings.want = radiance_only();
        settings.shadows = Shadows::off;
        Renderer off(scenario.scene, settings);
        const Frame whole = off.render(scenario.camera, 0.0);
        const auto truth = truth_of(scenario, off, 64);
        const SurfaceSamples surfaces = surface_samples(off.lit_surfaces().surfaces);
        settings.shadows = Shadows::sampled;
        settings.want.aovs = {"error-standard"};
        const int kSeeds = 64;
        for (const int rays : {1, 4, 16}) {
            settings.shadow_rays = rays;
            Renderer renderer(scenario.scene, settings);
            const std::size_t n = truth.size();
            std::vector<double> sum(n), squares(n), estimated(n);
            for (int seed = 1; seed <= kSeeds; ++seed) {
                settings.seed = static_cast<uint>(seed);
                renderer.change(settings);
                const Frame f = renderer.render(scenario.camera, 0.0);
                for (std::size_t i = 0; i < n; ++i) {
                    const double w = luminance_of(whole.radiance, i);
                    if (!(w > 0.0)) continue;
                    const double x = luminance_of(f.radiance, i) / w;
                    sum[i] += x;
                    squares[i] += x * x;
                    estimated[i] += std::pow(f.aovs[0].values[i] / w, 2.0);
                }
            }
            double v = 0, e = 0, z2 = 0, worst = 0, umbra = 0, lit = 0, bias = 0, rms = 0;
            int noisy = 0, inside = 0, umbras = 0, lits = 0, count = 0;
            for (std::size_t i = 0; i < n; ++i) {
                if (!truth[i].shown) continue;
                ++count;
                const double mean = sum[i] / kSeeds;
                const double var = (squares[i] - sum[i] * mean) / (kSeeds - 1);
                const double est = estimated[i] / kSeeds;
                const double off_by = mean - truth[i].seen;
                if (std::abs(off_by) > 0.03 && rays == 16) {
                    const auto& q = surfaces.pixels[i];
                    const glm::dvec3 w = scenario.camera.world_from_view * q.position + scenario.camera.position;
                    const glm::dvec3 nw = scenario.camera.world_from_view * q.normal;
                    printf("  pixel %zu truth %.4f mean %.4f est %.3g whole %g at %g %g %g n %g %g %g\n", i, truth[i].seen, mean, std::sqrt(est/kSeeds), luminance_of(whole.radiance, i), w.x,w.y,w.z,nw.x,nw.y,nw.z);
                }
                if (truth[i].seen == 0.0) ++umbras, umbra = std::max(umbra, std::abs(mean));
                if (truth[i].seen == 1.0) ++lits, lit = std::max(lit, std::abs(mean - 1.0));
                bias += off_by;
                rms += off_by * off_by;
                v += var;
                e += est;
                if (est > 0.0 && truth[i].seen > 0.02 && truth[i].seen < 0.98) {
                    ++noisy;
                    const double se = std::sqrt(est / kSeeds);
                    inside += std::abs(off_by) <= 1.96 * se ? 1 : 0;
                    z2 += off_by * off_by / (se * se);
                    worst = std::max(worst, std::abs(off_by) / se);
                }
            }
            printf("type %d rays %d: pixels %d var %.3g est/var %.3f bias %.2g rms %.3g noisy %d inside %.3f "
                   "z2 %.3f worst %.2f umbra %d max %.2g lit %d max %.2g\n",
                   static_cast<int>(type), rays, count, v / count, e / v, bias / count,
                   std::sqrt(rms / count), noisy, inside / double(noisy), z2 / noisy, worst, umbras,
                   umbra, lits, lit);
            fflush(stdout);
        }
    }
}

}  // namespace
}  // namespace kilolux
