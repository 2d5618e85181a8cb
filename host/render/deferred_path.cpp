// SPDX-License-Identifier: Apache-2.0
#include "host/render/deferred_path.h"

#include <algorithm>

namespace kilolux {
namespace {

// The first `count` rows, and those of single lights among the nodes after them.
template <typename Row>
std::vector<Row> single_lights(std::vector<Row> rows, uint count,
                               const std::vector<TreeNode>& nodes) {
    std::size_t end = count;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].next == i + 1) rows[end++] = rows[count + i];
    }
    rows.resize(end);
    return rows;
}

LitSurfaces lit(const PathContext& context, DecodedSurfaces surfaces,
                const PreparedLights& lights) {
    const Gpu& gpu = context.gpu;
    const auto nodes = download(gpu, lights.nodes, lights.node_count);
    LitSurfaces out{std::move(surfaces),
                    single_lights(download(gpu, lights.lights, lights.rows()), lights.count, nodes),
                    download(gpu, lights.directional, lights.directional_count),
                    {}};
    if (lights.profiles.lights) {
        const auto rows = download(gpu, *lights.profiles.lights, lights.rows());
        out.webs = webs_in_view(single_lights(rows, lights.count, nodes), context.scene.scene());
    }
    return out;
}

}  // namespace

bool PathContext::shades_display() const {
    const FrameRequest& want = settings.want;
    const bool is_one_sample = settings.samples <= 1 && !settings.auto_samples.on;
    const bool is_all = !settings.background && !settings.reflections && settings.bloom <= 0.0f &&
                        !has_blended_surfaces(scene.scene());
    return settings.renderer == RendererKind::deferred && want.display && !want.radiance &&
           want.view == ViewKind::lit && is_one_sample && is_all &&
           !plan.kernels.fast_relaxed_math && !plan.kernels.native_math;
}

DeferredPath::DeferredPath(const PathContext& context)
    : context_(context),
      surfaces_(context),
      lighting_(context.gpu, context.tuning, context.plan.kernels, path_surfaces(context)) {
    if (context.shades_display()) {
        lighting_.build(static_cast<int>(context.settings.tone_curve));
    } else {
        lighting_.build({});
    }
    if (!has_blended_surfaces(context.scene.scene())) return;
    lighting_.light_lists().list_everywhere();
    blended_.emplace(context, true);
}

Radiance DeferredPath::light(const Sample& sample, Measured out, const AfterShading& then) {
    lighting_.set_ambient(context_.settings.ambient);
    lights_ = sample.lights;
    const ClusterGrid grid = coarse_grid(context_, sample.camera, out.stats);
    const StageTimer before = out.timer;
    LightingInput input;
    Radiance radiance;
    do {
        out.timer = before;  // without surfaces that lacked triangles
        gbuffer_ = surfaces_.draw(sample, out);
        input = {gbuffer_, sample.lights, grid, surfaces_.shadows(sample), sample.display};
        const AfterShading after =
            context_.with_environment(gbuffer_, out.timer, blended_ ? AfterShading() : then);
        radiance = lighting_.light(input, out.timer, after);
    } while (!surfaces_.is_whole(out.stats));
    set_counts(out.stats);
    out.stats.shaded_display = sample.display.has_value();
    if (context_.settings.want.shadow_counts && context_.plan.kernels.shadows) {
        out.stats.shadows = lighting_.count_shadows(input, counting());
    }
    if (blended_) {
        const HostCoarseLists lists = lighting_.light_lists().download_coarse(lighting_.lists());
        blended_->draw(sample, radiance, surfaces_.targets(), &lists, out);
        then(radiance);
    }
    return radiance;
}

void DeferredPath::set_counts(FrameStats& stats) {
    static_cast<PairCounts&>(stats) = lighting_.light_lists().counts();
    stats.evaluations_per_pixel = mean_list_length(stats);
    stats.useful_evaluations_per_pixel = -1.0;
    if (!context_.settings.want.counts) return;
    const std::size_t size = std::size_t{gbuffer_.view.stride} * gbuffer_.view.height;
    stats.useful_evaluations_per_pixel =
        mean_of_drawn(download<uint>(context_.gpu, count_lights().covering, size));
}

CastShadows& DeferredPath::counting() {
    if (!counting_) {
        counting_.emplace(context_.gpu, context_.tuning, context_.plan.kernels,
                          path_surfaces(context_), true);
    }
    return *counting_;
}

LightCounts DeferredPath::count_lights() {
    if (!count_lights_) {
        count_lights_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    }
    StageTimer untimed;
    return count_lights_->enqueue(lighting_.lists().at(gbuffer_), untimed);
}

LitSurfaces DeferredPath::lit_surfaces() {
    return lit(context_, pixels({}), lighting_.lists().lights);
}

PixelProbe DeferredPath::probe(const Camera&, int x, int y) {
    const ListedLights& lists = lighting_.lists();
    PixelProbe out = surfaces_.probe(gbuffer_, lists.grid, x, y);
    if (!out.drawn()) return out;
    PixelLists found =
        lighting_.light_lists().at_pixel(lists, gbuffer_.view, static_cast<uint>(x),
                                         static_cast<uint>(y), out.surface[SURFACE_DEPTH]);
    out.coarse_count = found.coarse_count;
    out.active = found.active;
    out.has_list = found.active.has_value();
    for (const uint light : found.lights) out.lights.push_back({light, {}, {}, {}, {}});
    const KernelFeatures& kernels = context_.plan.kernels;
    if (kernels.shadows && !kernels.sampled_shadows && found.active) {
        const std::vector<bool> seen =
            seen_lights(*found.active, static_cast<uint>(x), static_cast<uint>(y));
        for (std::size_t i = 0; i < out.lights.size(); ++i) out.lights[i].seen = seen[i];
    }
    return out;
}

// Of the point and spot lights in the cluster's list, those that pixel (x, y) sees.
std::vector<bool> DeferredPath::seen_lights(const ActiveCluster& cluster, uint x, uint y) const {
    const Gpu& gpu = context_.gpu;
    const ListedLights& lists = lighting_.lists();
    const uint tile = fine_tile_of(gbuffer_.view, x, y);
    const auto order = download(gpu, lists.clusters.order, cluster.pixel_count,
                                std::size_t{tile} * FINE_TILE_PIXELS + cluster.first_pixel);
    const auto code = static_cast<std::uint8_t>(y % FINE_TILE * FINE_TILE + x % FINE_TILE);
    const auto found = static_cast<uint>(std::ranges::find(order, code) - order.begin());
    const uint place = cluster.first_pixel + found;
    const uint last = cluster.first_pixel + cluster.pixel_count;
    const std::size_t stride = (last + 31) / 32 - cluster.first_pixel / 32;
    const std::size_t directional = lists.lights.directional_count;
    const auto offset = download(gpu, lighting_.shadows().offsets, 1, tile).front();
    const auto words = download(gpu, lighting_.shadows().words, stride * cluster.list_count,
                                std::size_t{offset} + cluster.first_word + stride * directional);
    std::vector<bool> out;
    for (std::size_t i = 0; i < cluster.list_count; ++i) {
        const uint word = words[i * stride + place / 32 - cluster.first_pixel / 32];
        out.push_back((word >> place % 32 & 1u) != 0);
    }
    return out;
}

std::vector<ActiveCluster> DeferredPath::active_clusters() const {
    return lighting_.light_lists().active_clusters(lighting_.lists());
}

DecodedSurfaces DeferredPath::pixels(const Camera&) {
    DecodedSurfaces out = surfaces_.decode(gbuffer_, lighting_.lists().grid);
    const std::size_t size = std::size_t{out.view.stride} * out.view.height;
    const LightCounts counts = count_lights();
    out.evaluated = download<uint>(context_.gpu, counts.evaluated, size);
    out.covering = download<uint>(context_.gpu, counts.covering, size);
    const KernelFeatures& kernels = context_.plan.kernels;
    if (kernels.shadows && !kernels.sampled_shadows) count_seen(out);
    out.variance = find_variance();
    if (context_.settings.want.has_aov("error-bound")) out.bound = find_bound();
    return out;
}

TailErrors& DeferredPath::tail_errors() {
    if (!tail_errors_) {
        tail_errors_.emplace(context_.gpu, context_.tuning, context_.plan.kernels);
    }
    return *tail_errors_;
}

std::vector<float> DeferredPath::find_variance() {
    const KernelFeatures& kernels = context_.plan.kernels;
    if (!context_.settings.want.has_aov("error-standard")) return {};
    if (kernels.drawn_ranges == 0.0f) {
        if (kernels.sampled_shadows) return download(context_.gpu, lighting_.variance());
        return std::vector<float>(std::size_t{gbuffer_.view.stride} * gbuffer_.view.height);
    }
    StageTimer untimed;
    return download(context_.gpu,
                    tail_errors().variance(lighting_.lists().at(gbuffer_), lighting_.shadows(),
                                           lighting_.samples(), lighting_.variance(), untimed));
}

std::vector<float> DeferredPath::find_bound() {
    StageTimer untimed;
    const ListedLights& lists = lighting_.lists();
    const LitPixels lit = lists.at(gbuffer_);
    if (context_.plan.kernels.light_tree) {
        return download(context_.gpu, tail_errors().tree_bound(lit, untimed));
    }
    return download(context_.gpu, tail_errors().bound(lit, lights_.lights, lists.boxes, untimed));
}

void DeferredPath::count_seen(DecodedSurfaces& out) {
    const Gpu& gpu = context_.gpu;
    if (!count_seen_) count_seen_.emplace(gpu, context_.tuning, context_.plan.kernels);
    StageTimer untimed;
    const SeenCounts counts =
        count_seen_->enqueue(lighting_.lists().at(gbuffer_), lighting_.shadows(), untimed);
    const std::size_t size = std::size_t{out.view.stride} * out.view.height;
    out.facing = download<uint>(gpu, counts.facing, size);
    out.seen = download<uint>(gpu, counts.seen, size);
}

DeferredAllPath::DeferredAllPath(const PathContext& context)
    : context_(context),
      surfaces_(context),
      lighting_(context.gpu, context.tuning, context.plan.kernels, path_surfaces(context)) {
    if (has_blended_surfaces(context.scene.scene())) blended_.emplace(context, false);
}

Radiance DeferredAllPath::light(const Sample& sample, Measured out, const AfterShading& then) {
    lighting_.set_ambient(context_.settings.ambient);
    grid_ = coarse_grid(context_, sample.camera, out.stats);
    gbuffer_ = surfaces_.draw_whole(sample, out);
    const Radiance radiance =
        lighting_.light({gbuffer_, sample.lights, grid_, surfaces_.shadows(sample)}, out.timer,
                        context_.with_environment(gbuffer_, out.timer, {}));
    out.stats.evaluations_per_pixel = sample.lights.count;
    out.stats.useful_evaluations_per_pixel = -1.0;
    if (blended_) {
        blended_->draw(sample, radiance, surfaces_.targets(), nullptr, out);
    }
    then(radiance);
    return radiance;
}

LitSurfaces DeferredAllPath::lit_surfaces() {
    return lit(context_, pixels({}), lighting_.lights());
}

PixelProbe DeferredAllPath::probe(const Camera&, int x, int y) {
    return surfaces_.probe(gbuffer_, grid_, x, y);
}

DecodedSurfaces DeferredAllPath::pixels(const Camera&) {
    DecodedSurfaces out = surfaces_.decode(gbuffer_, grid_);
    if (context_.plan.kernels.sampled_shadows) {
        out.variance = download(context_.gpu, lighting_.variance());
    }
    for (std::size_t i = 0; i < std::size_t{out.view.stride} * out.view.height; ++i) {
        out.evaluated.push_back(out.planes[i] == 0.0f ? kBackground : lighting_.lights().count);
    }
    return out;
}

}  // namespace kilolux
