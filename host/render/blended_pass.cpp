// SPDX-License-Identifier: Apache-2.0
#include "host/render/blended_pass.h"

#include "host/render/host_stages.h"

namespace kilolux {

ForwardFeatures forward_features(const ScenePlan& plan, bool clustered, bool opaque) {
    ForwardFeatures features;
    static_cast<SceneFeatures&>(features) = plan.kernels;
    features.shading = plan.kernels.shading;
    features.clustered = clustered;
    features.opaque = opaque;
    return features;
}

ForwardLights forward_lights(const Sample& sample, float ambient, const HostCoarseLists* lists) {
    ForwardLights out;
    out.lights = sample.rows.local;
    out.directional = sample.rows.directional;
    out.profiles = sample.rows.profiles;
    out.profile_tables = sample.rows.profile_tables;
    out.seed = sample.lights.seed;
    out.ambient = ambient;
    if (lists) {
        out.grid = lists->grid;
        out.cluster_offsets = lists->offsets;
        out.light_lists = lists->lists;
    }
    return out;
}

BlendedPass::BlendedPass(const PathContext& context, bool clustered)
    : context_(context),
      pass_(context.meshes(), forward_features(context.plan, clustered, false)) {}

void BlendedPass::draw(const Sample& sample, const Radiance& radiance,
                       const GBufferTargets& targets, const HostCoarseLists* lists, Measured out) {
    const RenderSettings& settings = context_.settings;
    const View& view = radiance.view;
    const auto planes =
        download<float>(context_.gpu, radiance.planes, std::size_t{3} * view.stride * view.height);
    pass_.draw_blended(crop(sample.camera, settings.height, sample.band), view, targets, planes,
                       forward_lights(sample, settings.ambient, lists));
    upload<float>(context_.gpu, radiance.planes, pass_.read_radiance(view.stride));
    add_host_time(out, kBlendedStage, pass_.last_ms());
}

}  // namespace kilolux
