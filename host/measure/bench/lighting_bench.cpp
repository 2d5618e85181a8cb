// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/lighting_bench.h"

#include <algorithm>
#include <array>

#include "host/base/hash.h"
#include "host/gpu/repeat_until_fits.h"
#include "host/render/plan/grid_request.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/surface_pass.h"
#include "host/stages/picture/tonemap.h"

namespace kilolux {
namespace {

bool same_planes(const GBufferNeeds& a, const GBufferNeeds& b) {
    const GBufferLayout p = make_gbuffer_layout(a, 16, 1), q = make_gbuffer_layout(b, 16, 1);
    return p.layout == q.layout && p.emissive_scale == q.emissive_scale && a.unlit == b.unlit &&
           std::ranges::equal(p.offset_bytes, q.offset_bytes);
}

// Whether both can use the same G-buffer.
bool draws_alike(const LightingRequest& a, const LightingRequest& b) {
    const Tuning& s = a.tuning.tuning;
    const Tuning& t = b.tuning.tuning;
    return same_planes(a.plan.gbuffer, b.plan.gbuffer) && a.drawn_by == b.drawn_by &&
           a.plan.kernels.shadows == b.plan.kernels.shadows && s.raster_group == t.raster_group &&
           s.raster_lanes == t.raster_lanes && s.raster_tile_width == t.raster_tile_width &&
           s.raster_tile_height == t.raster_tile_height && s.geometry == t.geometry;
}

// Keeps the least time of each stage so far.
void keep_least(std::vector<StageTime>& least, const std::string& stage, double ms) {
    const auto found = std::ranges::find(least, stage, &StageTime::name);
    if (found == least.end()) {
        least.push_back({stage, ms, 0.0});
    } else {
        found->ms = std::min(found->ms, ms);
    }
}

RenderSettings drawn_settings(RenderSettings settings, Geometry geometry) {
    settings.geometry = geometry;
    settings.no_reuse = true;
    return settings;
}

}  // namespace

// The stages after the G-buffer.
struct LightingBench::Stages {
    Stages(const Gpu& gpu, const LightingRequest& request, const RenderSettings& settings,
           const SurfaceFeatures& surfaces)
        : lighting(gpu, request.tuning.tuning, request.plan.kernels, surfaces),
          tonemap(gpu, request.tuning.tuning, static_cast<int>(settings.tone_curve)) {
        lighting.set_ambient(settings.ambient);
    }
    DeferredLighting lighting;
    Tonemap tonemap;
};

// The stages that make the G-buffer, and the objects that they refer to.
struct LightingBench::Drawing {
    Drawing(std::shared_ptr<RenderScene> scene, const LightingRequest& the_request,
            const RenderSettings& asked, const Gpu& gpu)
        : request(the_request),
          context{std::move(scene),      drawn_settings(asked, request.drawn_by),
                  request.plan,          gpu,
                  request.tuning.tuning, {}},
          pass(context) {}

    LightingRequest request;
    RenderContext context;
    SurfacePass pass;
};

LightingBench::LightingBench(const Scene& scene, const RenderSettings& settings,
                             const Camera& camera, double time)
    : scene_(scene),
      settings_(settings),
      camera_(camera),
      box_(bounds(scene)),
      gpu_(open_device(settings)),
      device_(describe(gpu_.device)),
      render_scene_(std::make_shared<RenderScene>(scene, true)),
      light_source_(gpu_, choose_tuning(device_, settings.kernels).tuning, scene, settings_) {
    in_stage("lighting bench", [&] {
        StageTimer untimed;
        light_source_.update(time, camera_, light_stats_);
        lights_ = light_source_.input(camera_.position, true, untimed);
    });
}

LightingBench::~LightingBench() { render_scene_->make_current_or_lost(); }

LightingRequest LightingBench::request() const {
    const std::uint64_t lights = settings_.lights.count + scene_.lights.size();
    return {.plan = make_scene_plan(scene_, settings_, lights),
            .tuning = choose_tuning(device_, settings_.kernels),
            .drawn_by = settings_.geometry};
}

void LightingBench::set_drawing(const LightingRequest& request) {
    if (drawing_ && draws_alike(drawing_->request, request)) return;
    drawing_.reset();  // before the next is there: both might not fit
    drawing_ = std::make_unique<Drawing>(render_scene_, request, settings_, gpu_);
    FrameStats unused;
    draw(unused);
    timer_.take();
}

void LightingBench::draw(FrameStats& stats) {
    const LightRows no_rows;
    gbuffer_ =
        drawing_->pass.draw({camera_, no_rows, lights_, {0, settings_.height}}, {timer_, stats});
    gbuffer_.version = 0;  // so that every run bins its pixels
}

LightingInput LightingBench::input() const {
    const double pad = position_pad(gbuffer_.layout.layout, box_, camera_);
    const ClusterGrid grid =
        make_cluster_grid(grid_request(settings_.grid, camera_, box_, static_cast<float>(pad)),
                          gbuffer_.view.width, gbuffer_.view.height);
    const LightRows no_rows;
    return {gbuffer_, lights_, grid, drawing_->pass.shadows({camera_, no_rows, lights_, {}})};
}

Radiance LightingBench::light(Stages& stages) {
    const LightingInput from = input();
    const auto enqueue = [&] {
        const Radiance radiance = stages.lighting.enqueue(from, timer_);
        stages.tonemap.enqueue(radiance, settings_.exposure, timer_);
        return radiance;
    };
    return repeat_until_fits(timer_, enqueue, [&] { return stages.lighting.fits(timer_); });
}

LightingRun LightingBench::run(const LightingRequest& request) {
    return in_stage("lighting bench", [&] {
        render_scene_->make_current();
        set_drawing(request);
        Stages stages(gpu_.with_lanes(request.tuning.lanes), request, settings_,
                      drawing_->context.surface_features());
        LightingRun out;
        out.stats = light_stats_;
        Radiance radiance = light(stages);
        timer_.take();
        static_cast<PairCounts&>(out.stats) = stages.lighting.light_lists().counts();
        out.stats.evaluations_per_pixel = mean_list_length(out.stats);
        const ClusterGrid& grid = stages.lighting.lists().grid;
        std::ranges::copy(std::array{grid.tiles_x, grid.tiles_y, grid.slices}, out.stats.grid);
        out.stats.useful_evaluations_per_pixel = -1.0;
        if (request.counts && request.plan.kernels.shadows) {
            CastShadows counting(gpu_.with_lanes(request.tuning.lanes), request.tuning.tuning,
                                 request.plan.kernels, drawing_->context.surface_features(), true);
            out.stats.shadows = stages.lighting.count_shadows(input(), counting);
        }
        for (int i = 0; i < std::max(request.runs, 1); ++i) {
            FrameStats run;
            if (request.geometry) draw(run);
            radiance = light(stages);
            for (const StageTimer::Time& stage : timer_.take())
                add_stage_time(run.stages, stage.stage, stage.ms);
            for (const StageTime& stage : run.stages)
                keep_least(out.stats.stages, stage.name, stage.ms);
        }
        for (const StageTime& stage : out.stats.stages) out.ms += stage.ms;
        const std::size_t words = std::size_t{3} * gbuffer_.view.stride * gbuffer_.view.height;
        const std::vector<uint> bits = download<uint>(gpu_, radiance.planes, words);
        out.picture = hash64(std::as_bytes(std::span(bits)));
        return out;
    });
}

}  // namespace kilolux
