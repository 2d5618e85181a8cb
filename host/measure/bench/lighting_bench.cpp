// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/lighting_bench.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "host/base/hash.h"
#include "host/lighting/deferred_lighting.h"
#include "host/render/grid_request.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_source.h"
#include "host/stages/tonemap.h"

namespace kilolux {
namespace {

bool same_planes(const GBufferNeeds& a, const GBufferNeeds& b) {
    return a.layout == b.layout && a.material == b.material && a.occlusion == b.occlusion &&
           a.emissive_scale == b.emissive_scale && a.specular == b.specular && a.unlit == b.unlit;
}

// The least time of each stage so far.
void keep_least(std::vector<StageTime>& least, const std::string& stage, double ms) {
    const auto found = std::ranges::find(least, stage, &StageTime::name);
    if (found == least.end()) {
        least.push_back({stage, ms, 0.0});
    } else {
        found->ms = std::min(found->ms, ms);
    }
}

}  // namespace

// The stages after the G-buffer.
struct LightingBench::Stages {
    Stages(const Gpu& gpu, const LightingRequest& request, const RenderSettings& settings)
        : lighting(gpu, request.tuning.tuning, request.plan.kernels),
          tonemap(gpu, request.tuning.tuning, static_cast<int>(settings.tone_curve)) {
        lighting.set_ambient(settings.ambient);
    }
    DeferredLighting lighting;
    Tonemap tonemap;
};

LightingBench::LightingBench(const Scene& scene, const RenderSettings& settings,
                             const Camera& camera, double time)
    : scene_(scene),
      settings_(settings),
      camera_(camera),
      box_(bounds(scene)),
      gpu_(open_device(settings)),
      device_(describe(gpu_.device)),
      context_(GlContext::headless()),
      gpu_scene_(scene),
      bridge_(gpu_),
      light_source_(gpu_, choose_tuning(device_, settings.kernels).tuning, scene, settings_) {
    in_stage("lighting bench", [&] {
        StageTimer untimed;
        light_source_.update(time, camera_.position, light_stats_);
        lights_ = light_source_.input(camera_.position, true, untimed);
    });
}

LightingRequest LightingBench::request() const {
    const std::uint64_t lights = settings_.lights.count + scene_.lights.size();
    return {make_scene_plan(scene_, settings_, lights), choose_tuning(device_, settings_.kernels)};
}

void LightingBench::set_layout(const GBufferNeeds& needs) {
    if (geometry_ && same_planes(geometry_->needs(), needs)) return;
    geometry_.emplace(gpu_scene_, needs);
    draw(nullptr);
}

void LightingBench::draw(std::vector<StageTime>* least) {
    using Clock = std::chrono::steady_clock;
    gpu_.queue.finish();
    const Clock::time_point start = Clock::now();
    geometry_->draw(camera_, settings_.width, settings_.height);
    const std::chrono::duration<double, std::milli> drawing = Clock::now() - start;
    gbuffer_ = bridge_.transfer(geometry_->targets(), geometry_->needs(),
                                view_of(camera_, settings_.width, settings_.height));
    if (!least) return;
    // The transfer waits for OpenGL, whatever part of the drawing it did not do at once.
    keep_least(*least, "geometry", drawing.count());
    keep_least(*least, "gbuffer_bridge", bridge_.last_ms());
}

Radiance LightingBench::light(Stages& stages) {
    const double pad = position_pad(geometry_->needs().layout, box_, camera_);
    const ClusterGrid grid =
        make_cluster_grid(grid_request(settings_.grid, camera_, box_, static_cast<float>(pad)),
                          gbuffer_.view.width, gbuffer_.view.height);
    return stages.lighting.light({gbuffer_, lights_, grid}, timer_, [&](const Radiance& radiance) {
        stages.tonemap.enqueue(radiance, settings_.exposure, timer_);
    });
}

LightingRun LightingBench::run(const LightingRequest& request) {
    return in_stage("lighting bench", [&] {
        context_.make_current();
        set_layout(request.plan.gbuffer);
        Stages stages(gpu_.with_lanes(request.tuning.lanes), request, settings_);
        LightingRun out;
        out.stats = light_stats_;
        Radiance radiance = light(stages);
        timer_.take();
        static_cast<PairCounts&>(out.stats) = stages.lighting.light_lists().counts();
        out.stats.evaluations_per_pixel = mean_list_length(out.stats);
        const ClusterGrid& grid = stages.lighting.lists().grid;
        std::ranges::copy(std::array{grid.tiles_x, grid.tiles_y, grid.slices}, out.stats.grid);
        out.stats.useful_evaluations_per_pixel = -1.0;
        for (int i = 0; i < std::max(request.runs, 1); ++i) {
            if (request.geometry) draw(&out.stats.stages);
            radiance = light(stages);
            for (const StageTimer::Time& stage : timer_.take())
                keep_least(out.stats.stages, stage.stage, stage.ms);
        }
        for (const StageTime& stage : out.stats.stages) out.ms += stage.ms;
        const std::size_t words = std::size_t{3} * gbuffer_.view.stride * gbuffer_.view.height;
        out.picture = Fnv1a().add_words(download<uint>(gpu_, radiance.planes, words)).value();
        return out;
    });
}

}  // namespace kilolux
