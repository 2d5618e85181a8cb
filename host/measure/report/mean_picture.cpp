// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/mean_picture.h"

namespace kilolux {

MeanPicture mean_picture(const std::shared_ptr<RenderScene>& scene, const Camera& camera,
                         double time, RenderSettings settings, const MeanPlan& plan,
                         const std::function<void()>& on_step) {
    constexpr uint kFirstSeed = 0x4d65616e;
    settings.shadows = Shadows::sampled;
    settings.shadow_rays = plan.rays;
    settings.samples = 1;
    settings.auto_samples.on = false;
    settings.want = radiance_only();
    settings.want.aovs = {"error-standard"};
    settings.seed = kFirstSeed;
    Renderer renderer(scene, settings);
    MeanPicture out;
    for (int i = 0; i < plan.pictures; ++i) {
        on_step();
        if (i > 0) ++settings.seed;
        renderer.change(settings);
        const Frame frame = renderer.render(camera, time);
        const std::vector<float>& error = frame.aovs.front().values;
        out.rgb.resize(frame.radiance.size());
        out.variance.resize(error.size());
        for (std::size_t k = 0; k < out.rgb.size(); ++k) out.rgb[k] += frame.radiance[k];
        for (std::size_t k = 0; k < error.size(); ++k) {
            const double one = error[k];
            out.variance[k] += one * one;
        }
    }
    const double count = plan.pictures;
    for (double& value : out.rgb) value /= count;
    for (double& value : out.variance) value /= count * count;
    return out;
}

}  // namespace kilolux
