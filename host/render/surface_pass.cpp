// SPDX-License-Identifier: Apache-2.0
#include "host/render/surface_pass.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "host/base/log.h"
#include "host/gpu/repeat_until_fits.h"

namespace kilolux {
namespace {

// The tiles that a sample needs of the part drawn from row `first_row` of the picture on; none:
// all.
std::optional<OpenTiles> open_tiles(const Sample& sample, int first_row) {
    if (sample.needed == nullptr) return {};
    OpenTiles out = sample.needed->open;
    out.first_row = sample.band.first_row - first_row;
    return out;
}

// Work-groups take a tile each, and the slowest tile keeps all others waiting: a picture that has
// few tiles for every unit of the device gets smaller ones.
Tuning raster_tuning(const RenderContext& context) {
    constexpr std::int64_t kTilesOfUnit = 64;
    Tuning out = context.tuning;
    const std::int64_t pixels = std::int64_t{context.settings.width} * context.settings.height;
    const auto tiles = [&] { return pixels / (out.raster_tile_width * out.raster_tile_height); };
    while (out.raster_group > 1 && out.raster_tile_width > FINE_TILE &&
           tiles() < kTilesOfUnit * context.gpu.info.compute_units) {
        out.raster_tile_width /= 2;
    }
    return out;
}

// Number of triangles that some pixel shows. Columns of a row beyond the picture's width are
// skipped.
std::uint64_t count_seen_triangles(std::span<const uint> ids, const View& view) {
    std::vector<bool> seen(1);
    for (std::size_t y = 0; y < view.height; ++y) {
        for (const uint id : ids.subspan(y * view.stride, view.width)) {
            if (id >= seen.size()) seen.resize(std::size_t{id} + 1);
            seen[id] = true;
        }
    }
    seen[0] = false;  // background
    return static_cast<std::uint64_t>(std::ranges::count(seen, true));
}

}  // namespace

SurfacePass::SurfacePass(RenderContext& context) : context_(context), bridge_(context.gpu) {
    if (!context.resolves()) {
        planes_.emplace(context.meshes(), context.plan.gbuffer);
        return;
    }
    const Gpu gpu = context.resolving_gpu();
    const Scene& scene = context.scene->scene();
    const SurfaceFeatures features = context.surface_features();
    context.device_surfaces();
    if (context.draws_in_opencl) {
        triangles_.emplace(gpu, raster_tuning(context), scene, features);
    } else {
        ids_.emplace(context.meshes());
    }
    resolve_.emplace(gpu, context.tuning, context.plan.kernels, features);
    if (!context.plan.kernels.shadows) return;
    origins_.emplace(gpu, context.tuning, context.plan.kernels);
    if (!context.shadows) {
        context.shadows = std::make_shared<ShadowScene>(context.gpu, scene);
    }
}

GBuffer SurfacePass::enqueue(const Sample& sample, Measured out) {
    const RenderSettings& settings = context_.settings;
    const Source source{sample.camera,
                        sample.band,
                        settings.width,
                        settings.height,
                        context_.scene->scene().revisions.looks(),
                        sample.needed != nullptr};
    const bool is_kept = is_checked_ && !settings.no_reuse && !source.masked;
    if (is_kept && source_ == source) return gbuffer_;
    source_.reset();  // until it is made
    if (resolve_ && source.masked && !mask_) mask_.emplace(context_.gpu, context_.tuning);
    const std::uint64_t version = gbuffer_.version + 1;
    if (planes_) {
        gbuffer_ = draw_planes(sample, out);
    } else {
        gbuffer_ = triangles_ ? draw_in_opencl(sample, out) : draw_ids(sample, out);
    }
    gbuffer_.version = version;
    source_ = source;
    return gbuffer_;
}

bool SurfacePass::fits(FrameStats& stats) {
    if (is_checked_) return true;
    is_checked_ = triangles_->fits();
    stats.triangle_pairs = triangles_->pairs();
    return is_checked_;
}

GBuffer SurfacePass::draw(const Sample& sample, Measured out) {
    return repeat_until_fits(
        out.timer, [&] { return enqueue(sample, out); }, [&] { return fits(out.stats); });
}

GBuffer SurfacePass::draw_planes(const Sample& sample, Measured out) {
    const RenderSettings& settings = context_.settings;
    const Band band = sample.band;
    const Band tile = raster_tile(settings.height, band.first_row);
    if (sample.redraw) {
        planes_->draw(crop(sample.camera, settings.height, tile), settings.width, tile.rows);
        out.timer.record_host(kGeometryStage, planes_->last_ms());
    }
    GBuffer gbuffer =
        bridge_.transfer(planes_->targets(), context_.plan.gbuffer,
                         view_of(sample.camera, settings.width, settings.height, band),
                         band.first_row - tile.first_row);
    out.timer.record_host(kGBufferBridgeStage, bridge_.last_ms());
    return gbuffer;
}

GBuffer SurfacePass::draw_ids(const Sample& sample, Measured out) {
    const RenderSettings& settings = context_.settings;
    const Band band = sample.band;
    const Band tile = raster_tile(settings.height, band.first_row);
    if (sample.redraw) {
        const auto open = open_tiles(sample, tile.first_row);
        ids_->draw(crop(sample.camera, settings.height, tile), settings.width, tile.rows,
                   open ? &*open : nullptr);
        out.timer.record_host(kGeometryStage, ids_->last_ms());
    }
    const View view = view_of(sample.camera, settings.width, settings.height, band);
    const DeviceArray<uint> ids =
        bridge_.transfer_ids(ids_->targets(), view, band.first_row - tile.first_row);
    out.timer.record_host(kGBufferBridgeStage, bridge_.last_ms());
    return resolve(ids, context_.device_surfaces().at(ids_->draws()), view, sample, out);
}

GBuffer SurfacePass::draw_in_opencl(const Sample& sample, Measured out) {
    const RenderSettings& settings = context_.settings;
    const View view = view_of(sample.camera, settings.width, settings.height, sample.band);
    const auto open = open_tiles(sample, sample.band.first_row);
    const std::vector<Draw> draws =
        triangles_->visible(crop(sample.camera, settings.height, sample.band), settings.width,
                            sample.band.rows, open ? &*open : nullptr);
    const SurfaceBuffers scene = context_.device_surfaces().at(draws);
    const DeviceArray<uint> ids =
        triangles_->enqueue(scene, draws, view, out.timer, open ? &*open : nullptr);
    is_checked_ = false;
    out.stats.triangles = triangles_->triangles();
    return resolve(ids, scene, view, sample, out);
}

GBuffer SurfacePass::resolve(const DeviceArray<uint>& all_ids, const SurfaceBuffers& scene,
                             const View& view, const Sample& sample, Measured out) {
    const DeviceArray<uint> ids =
        sample.needed ? mask_->enqueue(sample.needed->done, view, all_ids, out.timer) : all_ids;
    GBuffer gbuffer = resolve_->enqueue(
        ids, scene, make_gbuffer_layout(context_.plan.gbuffer, view.stride, view.height), view,
        out.timer);
    if (context_.settings.want.counts) count(ids, scene, view, out.stats);
    if (origins_) place_origins(ids, scene, gbuffer, sample, out);
    return gbuffer;
}

// Counts the work of resolving, see FrameStats. Blocks.
void SurfacePass::count(const DeviceArray<uint>& ids, const SurfaceBuffers& scene, const View& view,
                        FrameStats& stats) {
    if (!texels_) {
        texels_.emplace(context_.resolving_gpu(), context_.tuning,
                        context_.device_surfaces().features());
    }
    StageTimer untimed;
    const std::size_t size = std::size_t{view.stride} * view.height;
    const std::vector<uint> texels =
        download<uint>(context_.gpu, texels_->enqueue(ids, scene, view, untimed), size);
    stats.texels = std::accumulate(texels.begin(), texels.end(), std::uint64_t{0});
    stats.seen_triangles = count_seen_triangles(download<uint>(context_.gpu, ids, size), view);
}

void SurfacePass::place_origins(const DeviceArray<uint>& ids, const SurfaceBuffers& scene,
                                const GBuffer& gbuffer, const Sample& sample, Measured out) {
    const auto start = std::chrono::steady_clock::now();
    const std::uint64_t built = context_.shadows->built();
    shadows_.casters = context_.shadows->casters();
    out.stats.shadow_scenes_built += context_.shadows->built() - built;
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start;
    out.timer.record_host(kShadowSceneStage, spent.count());
    shadows_.casters.materials = scene.materials;
    shadows_.casters.textures = scene.textures;
    shadows_.casters.texels = scene.texels;
    shadows_.view = context_.shadows->view(sample.camera);
    shadows_.origins =
        origins_->enqueue(ids, scene, gbuffer, shadows_.casters, shadows_.view, out.timer);
}

ShadowInput SurfacePass::shadows(const Sample& sample) const {
    constexpr uint kSeedStep = 0x9e3779b9u;  // spreads the samples of neighbouring seeds
    ShadowInput out = shadows_;
    out.rays = static_cast<float>(context_.settings.shadow_rays);
    out.seed = context_.settings.seed * kSeedStep + sample.number;
    return out;
}

}  // namespace kilolux
