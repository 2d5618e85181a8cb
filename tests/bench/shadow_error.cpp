// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/shadow_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/measure/metrics/statistics.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/renderer.h"

namespace kilolux {
namespace {

// Whether a picture differs from the exact one by more than the rounding of taking hidden lights
// away from `whole`, the pixel without shadows: 16 units in its last place.
bool differs_from(const double* exact, const float* picture, const float* whole) {
    for (int c = 0; c < 3; ++c) {
        if (!(std::abs(picture[c] - exact[c]) <= 0x1p-20 * whole[c])) return true;
    }
    return false;
}

// The picture without shadows, and the one with exact ones.
struct TruePictures {
    Frame whole;
    MeanPicture exact;
};

// Every other picture of one number of rays, by pixel: sums of luminances and of estimated
// variances.
struct HalfOfPictures {
    std::vector<double> sum, estimated;
    int seeds = 0;
};

// Sums over the pictures of one number of rays.
class SampledSums {
 public:
    SampledSums(const TruePictures& of, int rays)
        : of_(of), pixels_(of.exact.variance.size()), noisy_(pixels_) {
        result_.rays = rays;
        for (HalfOfPictures& half : halves_) {
            half.sum.resize(pixels_);
            half.estimated.resize(pixels_);
        }
    }

    // Adds a picture with the layers error-standard and depth.
    void add(const Frame& picture) {
        HalfOfPictures& half = halves_[static_cast<std::size_t>(result_.seeds++ % 2)];
        ++half.seeds;
        for (std::size_t i = 0; i < pixels_; ++i) {
            if (picture.aovs[1].values[i] > 0.0f) add_pixel(picture, i, half);
        }
    }

    SampledShadowError result() const {
        SampledShadowError out = result_;
        double noisy = 0.0, noisy_within = 0.0, tested = 0.0, tested_within = 0.0;
        for (std::size_t i = 0; i < pixels_; ++i) {
            if (!noisy_[i].differs) continue;
            ++noisy;
            noisy_within += noisy_[i].within;
            for (const std::size_t half : {std::size_t{0}, std::size_t{1}}) {
                if (hidden_draws(halves_[1 - half], i) < kEnoughDraws) continue;
                tested += 0.5;
                tested_within += is_mean_within(halves_[half], i) ? 0.5 : 0.0;
            }
        }
        const double all = std::max(added_, 1.0);
        out.rmse = std::sqrt(squares_ / (3.0 * all));
        out.variance /= all;
        out.estimated_variance /= all;
        out.noisy_share = noisy * out.seeds / all;
        out.tested_share = tested * out.seeds / all;
        out.within_picture = noisy > 0.0 ? noisy_within / (noisy * out.seeds) : 1.0;
        out.within_mean = tested > 0.0 ? tested_within / tested : 1.0;
        return out;
    }

 private:
    struct Noise {
        bool differs = false;  // in some picture
        int within = 0;        // pictures
    };

    void add_pixel(const Frame& picture, std::size_t i, HalfOfPictures& half) {
        const float* x = &picture.radiance[3 * i];
        const double* r = &of_.exact.rgb[3 * i];
        const double estimated = std::pow(double{picture.aovs[0].values[i]}, 2.0);
        const double off = luminance(x) - luminance(r);
        ++added_;
        for (int c = 0; c < 3; ++c) squares_ += std::pow(x[c] - r[c], 2.0);
        result_.variance += off * off;
        result_.estimated_variance += estimated;
        half.sum[i] += luminance(x);
        half.estimated[i] += estimated;
        noisy_[i].differs =
            noisy_[i].differs || estimated > 0.0 || differs_from(r, x, &of_.whole.radiance[3 * i]);
        noisy_[i].within +=
            is_within(luminance(x), estimated + of_.exact.variance[i], luminance(r)) ? 1 : 0;
    }

    // A hidden light without a size that was drawn takes the luminance without shadows over the
    // rays away, and adds its square, times one minus its probability, to the variance:
    // kernels/shadows/shadow_pick.h. Of a light with a size, a hidden pair of rays about as much.
    double hidden_draws(const HalfOfPictures& half, std::size_t i) const {
        const double each = luminance(&of_.whole.radiance[3 * i]) / result_.rays;
        return each > 0.0 ? half.estimated[i] / (each * each) : 0.0;
    }

    bool is_mean_within(const HalfOfPictures& half, std::size_t i) const {
        const double n = half.seeds;
        return is_within(half.sum[i] / n, half.estimated[i] / (n * n) + of_.exact.variance[i],
                         luminance(&of_.exact.rgb[3 * i]));
    }

    const TruePictures& of_;
    std::size_t pixels_;
    std::vector<Noise> noisy_;
    std::array<HalfOfPictures, 2> halves_;  // one decides on which pixels the other is tested
    SampledShadowError result_;
    double squares_ = 0.0, added_ = 0.0;
};

RenderSettings one_sample(RenderSettings settings, Shadows shadows) {
    settings.shadows = shadows;
    settings.samples = 1;
    settings.auto_samples.on = false;
    settings.want = radiance_only();
    if (shadows == Shadows::sampled) settings.want.aovs = {"error-standard", "depth"};
    return settings;
}

// Exact shadows are a mean without a variance.
MeanPicture true_picture(const ReportView& view, const RenderSettings& settings,
                         const ShadowErrorPlan& plan, const std::function<void()>& on_step) {
    if (make_scene_plan(view.scene, settings, 0).kernels.area_lights) {
        return mean_picture(view.opened, view.camera, view.time, settings, plan.truth, on_step);
    }
    on_step();
    const Frame exact =
        Renderer(view.opened, one_sample(settings, Shadows::exact)).render(view.camera, view.time);
    MeanPicture out{{exact.radiance.begin(), exact.radiance.end()}, {}};
    out.variance.resize(out.rgb.size() / 3);
    return out;
}

}  // namespace

std::vector<SampledShadowError> measure_shadow_error(const ReportView& view,
                                                     const RenderSettings& settings,
                                                     const ShadowErrorPlan& plan,
                                                     const std::function<void()>& on_step) {
    on_step();
    const TruePictures truth{
        Renderer(view.opened, one_sample(settings, Shadows::off)).render(view.camera, view.time),
        true_picture(view, settings, plan, on_step)};
    RenderSettings sampled = one_sample(settings, Shadows::sampled);
    Renderer renderer(view.opened, sampled);
    std::vector<SampledShadowError> out;
    for (const int rays : plan.rays) {
        SampledSums sums(truth, rays);
        const int seeds = std::max(plan.seeds, (plan.draws + rays - 1) / rays);
        for (int seed = 1; seed <= seeds; ++seed) {
            on_step();
            sampled.shadow_rays = rays;
            sampled.seed = static_cast<uint>(seed);
            renderer.change(sampled);
            sums.add(renderer.render(view.camera, view.time));
        }
        out.push_back(sums.result());
    }
    return out;
}

Table shadow_error_table(const std::vector<SampledShadowError>& errors) {
    using E = SampledShadowError;
    return make_table<E>(
        {{"rays N", &E::rays},
         {"pictures", &E::seeds},
         {"RMSE", &E::rmse},
         {"variance", &E::variance},
         {"N x variance", [](const E& e) { return e.rays * e.variance; }},
         {"estimated variance", &E::estimated_variance},
         {"noisy pixels [%]", [](const E& e) { return 100.0 * e.noisy_share; }},
         {"a picture in 95 % [%]", [](const E& e) { return 100.0 * e.within_picture; }},
         {"tested pixels [%]", [](const E& e) { return 100.0 * e.tested_share; }},
         {"mean in 95 % [%]",
          [](const E& e) { return e.tested_share > 0.0 ? Cell(100.0 * e.within_mean) : Cell(); }}},
        errors);
}

std::string shadow_error_notes() {
    return fmt::format(
        "Sampled shadows against exact ones of the same renderer, of lights with a size against "
        "the mean of pictures with 64\n"
        "rays: pictures with seeds 1, 2, ...\n"
        "RMSE: of the radiance. variance: mean square of the luminance's error; estimated: by "
        "--aov "
        "error-standard.\n"
        "noisy pixels: of those with a surface, those that differ from the exact one in some "
        "picture; no other has a variance.\n"
        "in 95 %: the exact luminance is within 1.96 of the estimated error: of a picture, at "
        "noisy "
        "pixels; of the mean of half of the\n"
        "pictures, at tested ones, on which the other half drew {} hidden lights or more. One "
        "picture with few rays estimates single\n"
        "pixels badly: where it draws no hidden light its estimate is 0.\n",
        kEnoughDraws);
}

Plot shadow_error_plot(const std::vector<SampledShadowError>& errors, const std::string& caption) {
    Plot plot;
    plot.title = "Sampled shadows: variance over rays";
    plot.subtitle = caption;
    plot.x_label = "rays a pixel N, at most on average (--shadow-rays)";
    plot.y_label = "mean square error of the luminance";
    plot.log_x = plot.log_y = true;
    for (const SampledShadowError& e : errors) {
        const double rays = e.rays;
        series_of(plot, "measured").push_back({rays, e.variance});
        series_of(plot, "estimated", PlotStyle::points).push_back({rays, e.estimated_variance});
        series_of(plot, "1/N")
            .push_back({rays, errors.front().variance * errors.front().rays / rays});
    }
    return plot;
}

}  // namespace kilolux
