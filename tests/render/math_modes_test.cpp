// SPDX-License-Identifier: Apache-2.0
// The approximations of shading that are off by default: bounded errors, and lists still change no
// bit but where the compiler may sum in any order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

struct Mode {
    const char* name;
    MathMode math;
    LightColors colors;
    double bound;        // of relative_error(): where lobes are narrow, roots count
    double lists = 0.0;  // the same between deferred and deferred-all
};

constexpr Mode kModes[] = {
    // OpenCL C lets the compiler sum in any order, in each kernel another one.
    {"fast-relaxed", MathMode::fast_relaxed, LightColors::single, 1e-3, 1e-3},
    {"native", MathMode::native, LightColors::single, 1e-3},
    // Half precision rounds to 2^-11.
    {"half", MathMode::exact, LightColors::half, 5e-4},
};

// The largest |x - r| of a value, relative to the brighter.
double relative_error(const Frame& frame, const Frame& reference) {
    double worst = 0.0;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        const double x = frame.radiance[i], r = reference.radiance[i];
        if (!std::isfinite(x)) return std::numeric_limits<double>::infinity();
        if (x != r) worst = std::max(worst, std::abs(x - r) / std::max(x, r));
    }
    return worst;
}

// The model with a square root, a reciprocal one and a division a light.
TEST(MathModes, ErrorsAndWhatListsChangeAreBounded) {
    const Scene scene = grid_with_every_light();
    RenderSettings settings = small_settings(64, 36, 100);
    settings.shading = Shading::pbr;
    const Frame exact = render_once(scene, settings);
    for (const Mode& mode : kModes) {
        settings.kernels.math = mode.math;
        settings.kernels.light_colors = mode.colors;
        settings.renderer = RendererKind::deferred;
        const Frame frame = render_once(scene, settings);
        settings.renderer = RendererKind::deferred_all;
        EXPECT_LE(relative_error(render_once(scene, settings), frame), mode.lists) << mode.name;
        EXPECT_LE(relative_error(frame, exact), mode.bound) << mode.name;
    }
}

// 65504 is half's largest number: colours are stored over a power of two.
TEST(MathModes, HalfColoursHoldAnyIntensity) {
    const Scene scene = make_generated_scene("grid");
    for (const double intensity : {1e-20, 1e9}) {
        RenderSettings settings = small_settings(64, 36, 100);
        settings.ambient = 0.0f;
        settings.lights.intensity = intensity;
        const Frame exact = render_once(scene, settings);
        settings.kernels.light_colors = LightColors::half;
        const Frame frame = render_once(scene, settings);
        double brightest = 0.0;
        for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
            const double x = frame.radiance[i], r = exact.radiance[i];
            ASSERT_NEAR(x, r, 5e-4 * std::max(x, r)) << intensity << " at " << i;
            brightest = std::max(brightest, x);
        }
        EXPECT_GT(brightest, 0.0) << intensity;
    }
}

}  // namespace
}  // namespace kilolux
