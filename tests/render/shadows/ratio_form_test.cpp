// SPDX-License-Identifier: Apache-2.0
// Two estimates of soft shadows from the same rays. The renderer takes the light of hidden rays
// from the whole, W - H. The ratio estimate is W (1 - H / D), D being the light of all rays drawn.
// D is measured by hiding every light: the rays, which depend on lights and surfaces alone, are the
// same, and all are hidden.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/measure/metrics/rgb_image.h"
#include "host/measure/report/mean_picture.h"
#include "host/scene/lights/light_shape.h"
#include "tests/render/shadows/soft_scenes.h"
#include "tests/support/full.h"

namespace kilolux {
namespace {

// Every light in a closed box of its own.
Scene without_light(const Scene& scene) {
    Scene out = scene;
    const Scene stage = shadow_stage();
    const auto material = static_cast<int>(out.materials.size());
    out.materials.push_back(stage.materials.front());
    for (const SceneLight& light : scene.lights) {
        add_box(out, glm::dvec3(2.2 * bounding_radius(light) + 2e-3), light.position);
        out.meshes.back().material = material;
    }
    return out;
}

// The errors of an estimate over the pixels, relative to the mean of the true picture.
struct FormError {
    double rmse = 0.0;   // of a picture
    double bias = 0.0;   // root mean square of the pixels' biases
    double shift = 0.0;  // of the picture's mean
};

struct Forms {
    FormError plain, ratio;
};

// Sums over pictures of one pixel.
struct FormSums {
    double sum = 0.0, squares = 0.0;
    void add(double value) {
        sum += value;
        squares += value * value;
    }
};

// `truth`: the sums' true value, whose own variance is `noise`.
void add_pixel(FormError& error, const FormSums& sums, int pictures, double truth, double noise) {
    const double n = pictures, mean = sums.sum / n;
    const double variance = (sums.squares - sums.sum * mean) / (n - 1.0);
    const double off = (mean - truth) * (mean - truth) - noise;
    error.rmse += off + variance * (n - 1.0) / n;
    error.bias += off - variance / n;
    error.shift += mean - truth;
}

void finish(FormError& error, double pixels, double mean) {
    error.rmse = std::sqrt(error.rmse / pixels) / mean;
    error.bias = std::sqrt(std::max(0.0, error.bias / pixels)) / mean;
    error.shift = error.shift / pixels / mean;
}

std::vector<double> luminances(const std::vector<float>& rgb) {
    std::vector<double> out;
    for (std::size_t i = 0; i < rgb.size(); i += 3) out.push_back(luminance(&rgb[i]));
    return out;
}

Forms forms_of(const ShadowScenario& scenario, RenderSettings settings, int pictures) {
    const Scene dark = without_light(scenario.scene);
    const auto opened = shared_scene(scenario.scene);
    const MeanPicture truth = mean_picture(opened, scenario.camera, 0.0, settings, {64, 64}, [] {});
    settings.want.aovs = {"depth"};
    Renderer by_light(opened, settings), by_dark(dark, settings);
    RenderSettings off = settings;
    off.shadows = Shadows::off;
    const Frame whole_frame = Renderer(opened, off).render(scenario.camera, 0.0);
    const std::vector<double> whole = luminances(whole_frame.radiance);
    std::vector<FormSums> plain(whole.size()), ratio(whole.size());
    std::vector<float> depth;
    for (int seed = 1; seed <= pictures; ++seed) {
        settings.seed = static_cast<uint>(seed);
        by_light.change(settings);
        by_dark.change(settings);
        const std::vector<double> lit = luminances(by_light.render(scenario.camera, 0.0).radiance);
        const Frame dark_frame = by_dark.render(scenario.camera, 0.0);
        const std::vector<double> rest = luminances(dark_frame.radiance);
        depth = dark_frame.aovs.front().values;
        for (std::size_t i = 0; i < whole.size(); ++i) {
            const double hidden = whole[i] - lit[i], drawn = whole[i] - rest[i];
            plain[i].add(lit[i]);
            ratio[i].add(drawn > 0.0 ? whole[i] * (1.0 - hidden / drawn) : whole[i]);
        }
    }
    Forms out;
    double pixels = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        // A box may be seen itself.
        if (depth[i] <= 0.0f || depth[i] != whole_frame.aovs.front().values[i]) continue;
        const double exact = luminance(&truth.rgb[3 * i]);
        ++pixels;
        sum += exact;
        add_pixel(out.plain, plain[i], pictures, exact, truth.variance[i]);
        add_pixel(out.ratio, ratio[i], pictures, exact, truth.variance[i]);
    }
    finish(out.plain, pixels, sum / pixels);
    finish(out.ratio, pixels, sum / pixels);
    return out;
}

// A board and columns between a floor and lights of every kind with a size.
ShadowScenario columns_by(int lights) {
    ShadowScenario out = columns_scenario();
    out.scene.lights.clear();
    for (int i = 0; i < lights; ++i) {
        SceneLight light = panel(kSizedTypes[static_cast<std::size_t>(i) % kSizedTypes.size()]);
        light.position = {14.0 * (i + 0.5) / lights - 7.0, 3.0 + 0.3 * (i % 3), i % 5 - 4.5};
        light.intensity *= 1.0f + 0.5f * static_cast<float>(i % 3);
        out.scene.lights.push_back(light);
    }
    return out;
}

class RatioForm : public testing::TestWithParam<int> {};

// Both are the same for one light, all of whose rays are drawn. Of several the ratio's errors are
// smaller, for rays that are drawn too often are among both H and D; but it is biased.
TEST_P(RatioForm, ErrsLessButIsBiased) {
    const int lights = GetParam();
    const ShadowScenario scenario =
        lights == 1 ? board_below(panel(LightType::rectangle)) : columns_by(lights);
    for (const int rays : {4, 16}) {
        SCOPED_TRACE(fmt::format("{} lights, {} rays", lights, rays));
        const auto [plain, ratio] = forms_of(scenario, soft_settings(48, 27, rays), 256);
        for (const auto& [name, form] : {std::pair{"difference", plain}, std::pair{"ratio", ratio}})
            fmt::print("{} lights, {} rays, {}: RMSE {:.4f}, bias {:.4f}, shift {:+.4f}\n", lights,
                       rays, name, form.rmse, form.bias, form.shift);
        EXPECT_LT(plain.bias, 0.004);
        if (lights == 1) {
            EXPECT_NEAR(ratio.rmse, plain.rmse, 1e-4 * plain.rmse);
            continue;
        }
        EXPECT_LT(ratio.rmse, 0.95 * plain.rmse);
        EXPECT_GT(ratio.rmse, 0.7 * plain.rmse);
        if (rays == 4) {
            EXPECT_GT(ratio.bias, 0.02);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Lights, RatioForm,
                         testing::ValuesIn(runs_full() ? std::vector{1, 4, 16, 64}
                                                       : std::vector{1, 16}));

}  // namespace
}  // namespace kilolux
