// SPDX-License-Identifier: Apache-2.0
#include "host/render/forward_shading.h"

#include "host/stages/shading/instruction_counts.h"

namespace kilolux {
namespace {

ForwardFeatures forward_features(const ScenePlan& plan, bool clustered) {
    ForwardFeatures features;
    static_cast<SceneFeatures&>(features) = plan.of_layers().kernels;
    features.shading = plan.kernels.shading;
    features.clustered = clustered;
    return features;
}

// With `lists`, by coarse cluster. Neither is owned.
ForwardLights forward_lights(const Sample& sample, float ambient, const HostCoarseLists* lists) {
    ForwardLights out;
    out.lights = sample.rows.local;
    out.directional = sample.rows.directional;
    out.profiles = sample.rows.profiles;
    out.profile_tables = sample.rows.profile_tables;
    out.shapes = sample.rows.shapes;
    out.seed = sample.lights.seed;
    out.ambient = ambient;
    if (lists) {
        out.grid = lists->grid;
        out.cluster_offsets = lists->offsets;
        out.light_lists = lists->lists;
    }
    return out;
}

}  // namespace

StageWork forward_work(const StageCounts& c) {
    return {.bytes_written = kRadianceBytes * c.pixels,
            .instructions = shading_instructions(c),
            .evaluations = full_evaluations(c)};
}

ForwardShading::ForwardShading(const RenderContext& context)
    : context_(context),
      pass_(context.meshes(), forward_features(context.plan, context.settings.renderer ==
                                                                 RendererKind::forward_plus)),
      radiance_(context.gpu, kForwardStage) {}

Radiance ForwardShading::target(const Sample& sample) {
    const View view = view_of(sample.camera, context_.settings.width, context_.settings.height);
    return {radiance_.reserve(std::size_t{3} * view.stride * view.height), view};
}

void ForwardShading::draw(const Sample& sample, const HostCoarseLists* lists,
                          const Radiance& radiance, Measured out) {
    const RenderSettings& settings = context_.settings;
    const View& view = radiance.view;
    std::vector<float> background;
    if (settings.background) {
        background = download<float>(context_.gpu, radiance.planes,
                                     std::size_t{3} * view.stride * view.height);
    }
    pass_.draw(sample.camera, settings.width, settings.height,
               forward_lights(sample, settings.ambient, lists), background);
    const std::vector<float> lit = pass_.read_radiance(view.stride);
    out.timer.record_host(lists ? kForwardPlusStage : kForwardStage, pass_.last_ms());
    upload<float>(context_.gpu, radiance.planes, lit);
}

}  // namespace kilolux
