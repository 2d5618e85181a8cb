// SPDX-License-Identifier: Apache-2.0
#include "host/render/frame.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"
#include "host/picture/aovs.h"
#include "host/picture/frame_bands.h"
#include "host/picture/sample_pattern.h"
#include "host/picture/views.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Brings the lights at the frame's time to the device and, for OpenGL's fragments, to the host.
LightInput place_lights(Pipeline& p, const Shot& shot, FrameStats& stats) {
    const RenderContext& context = p.context;
    const Clock::time_point start = Clock::now();
    p.lights.update(shot.time, shot.camera, stats);
    p.timer.record_host(kLightInputStage, ms_since(start));
    LightInput input = p.lights.input(shot.camera.position, !context.settings.no_reuse, p.timer);
    if (!context.lights_on_host()) return input;
    const Clock::time_point rows_start = Clock::now();
    p.last.rows = p.lights.rows(shot.camera.position);
    p.timer.record_host(kLightInputStage, ms_since(rows_start));
    return input;
}

Sample make_sample(Pipeline& p, const Shot& shot, LightInput lights, const Band& band,
                   const Samples::Next& next) {
    const RenderSettings& settings = p.context.settings;
    const int tile = raster_tile(settings.height, band.first_row).first_row;
    lights.seed = tail_seed(settings, next.number);
    Sample out{shot.camera, p.last.rows, lights, band};
    out.camera.jitter += sample_offset(next.number);
    out.redraw = !p.samples.is_one() || p.last.raster_tile != tile;
    p.last.raster_tile = tile;
    out.number = next.number;
    out.needed = next.needed;
    if (p.context.shades_display()) {
        out.display = p.picture.target(view_of(out.camera, settings.width, settings.height, band));
    }
    return out;
}

// Runs the stages over the whole picture, tone maps its light and reads it back.
void develop(Pipeline& p, const Radiance& light, Frame& frame) {
    const Radiance shown = p.picture.finished(light, p.timer);
    p.picture.read_light(shown, frame.shown_light, p.timer);
    const std::optional<DisplayTarget> display = p.picture.tonemap(shown, p.timer);
    if (display) p.picture.read_display(*display, p.timer);
}

// Tone maps a band and reads it back; if stages over the whole picture follow, only keeps its light
// for them.
void develop_band(Pipeline& p, const std::optional<DisplayTarget>& shaded, const Radiance& light,
                  Frame& frame) {
    if (shaded) return p.picture.read_display(*shaded, p.timer);
    p.picture.read_light(light, frame.radiance, p.timer);
    if (!p.picture.keep_for_whole(light)) develop(p, light, frame);
}

// Reads a band's AOVs, and its surfaces if a view needs them.
void add_pixels(Pipeline& p, const Shot& shot, SharedPicture& picture) {
    const FrameRequest& want = p.context.settings.want;
    if (!want.pixels()) return;
    DecodedSurfaces pixels = p.reader.pixels({p.last.band, p.current_stages(), shot.camera});
    p.samples.add_counts(pixels);
    Frame& frame = picture.frame;
    const bool is_strip = frame.height < p.context.settings.height;
    std::vector<Layer> layers;
    for (const std::string& name : want.aovs) {
        layers.push_back(is_strip ? make_aov_of_strip(name, pixels, shot.camera,
                                                      picture.frame.stats.lights_given)
                                  : make_aov(name, pixels, shot.camera));
    }
    const auto width = static_cast<std::size_t>(frame.width);
    const std::scoped_lock lock(picture.placing);
    const std::size_t row = pixels.view.first_row - static_cast<std::size_t>(frame.first_row);
    place_layers(frame.aovs, std::move(layers), width * row,
                 width * static_cast<std::size_t>(frame.height));
    if (want.view != ViewKind::lit) {
        place_surfaces(picture.surfaces, std::move(pixels), frame.height);
    }
}

// Replaces the lit picture by the view that is asked for.
void show_view(Pipeline& p, const Shot& shot, const DecodedSurfaces& surfaces, Frame& frame) {
    const ViewKind view = p.context.settings.want.view;
    if (view == ViewKind::lit) return;
    std::vector<float> fragments, reference_light;
    if (view == ViewKind::overdraw) {
        fragments = p.reader.overdraw(shot.camera, DrawOrder::front_to_back);
    }
    if (view == ViewKind::difference) {
        reference_light = render_frame(*p.reference, {shot.camera, shot.time}).radiance;
    }
    frame.display = make_view(view, {surfaces, shot.camera, p.context.scene->box(), fragments,
                                     frame.radiance, reference_light});
}

// Gives the frame memory for the pixels of these rows.
void allocate(const Pipeline& p, Band rows, bool shown_only, bool by_rows, Frame& frame) {
    const Clock::time_point start = Clock::now();
    p.picture.resize(frame, rows, shown_only, by_rows);
    const double ms = ms_since(start);
    add_stage_time(frame.stats.stages, kAllocateStage.name, ms);
    frame.stats.frame_ms += ms;
}

// Prepares the pipeline for the frame, and brings its lights to the device.
LightInput begin(Pipeline& p, const Shot& shot, Frame& frame, FrameStats& stats) {
    const RenderContext& context = p.context;
    context.scene->make_current();
    context.scene->take_up_changes();
    const Clock::time_point start = Clock::now();
    p.timer = StageTimer();  // drops times of a frame that failed
    p.last.band = {};
    p.last.camera = shot.camera;
    const PictureKey key{context.settings, shot.camera, shot.time,
                         context.scene->scene().revisions};
    // OpenGL's targets still hold the tile of the last rows, which further rows of the same picture
    // need. Background and results that are asked for do not change it.
    PictureKey drawn = key;
    drawn.settings.background.reset();
    drawn.settings.want = {};
    if (!shot.rows || !(drawn == p.last.drawn)) p.last.raster_tile = -1;
    p.last.drawn = std::move(drawn);
    p.samples.begin(key, context.is_whole() ? shot.samples : 0);
    p.picture.begin(shot.display, frame, shot.rows.has_value());
    stats.zero_normals = context.scene->zero_normals();
    LightInput lights = place_lights(p, shot, stats);
    stats.frame_ms += ms_since(start);
    return lights;
}

// Renders each band sample by sample: lights -> surfaces -> lists -> visibility -> shading ->
// environment -> picture. Repeats the stages whose results had no room.
void render_bands(Pipeline& p, const Shot& shot, SharedPicture& picture, FrameStats& total) {
    Frame& frame = picture.frame;
    const LightInput lights = begin(p, shot, frame, total);
    FrameStages& stages = p.current_stages();
    LitBand& lit = p.last.band;
    const bool is_one = p.samples.is_one() && !stages.blends();
    const int height = p.context.settings.height;
    const Band rows = shot.rows.value_or(Band{0, height});
    for (const Band& band : make_bands(height, p.context.memory.band_rows, rows)) {
        const Clock::time_point start = Clock::now();
        FrameStats stats;
        const Measured out{p.timer, stats};
        p.samples.begin_band();
        while (const auto next = p.samples.next()) {
            check_interrupt();
            const Sample sample = make_sample(p, shot, lights, band, *next);
            StageTimer before = p.timer;
            Room room;
            while (!room.enough()) {
                p.timer.drop_commands_since(before);  // stages that lacked room
                lit.drop_lists();
                if (!room.surfaces) stages.draw_surfaces(sample, lit, out);
                const StageTimer with_surfaces = p.timer;
                stages.list_lights(sample, lit, out);
                stages.find_visible(lit, out);
                stages.shade(sample, lit, p.environment, out);
                p.environment.enqueue(lit, p.timer);
                if (is_one) develop_band(p, sample.display, lit.light, frame);
                room = stages.room(lit, out);  // waits for the device
                if (room.surfaces) before = with_surfaces;
            }
            p.reader.count({lit, stages, sample.camera}, stats);
            stages.blend(sample, lit, out);
            stats.shaded_display = sample.display.has_value();
            if (!p.samples.is_one()) p.samples.add(lit.light, out);
        }
        if (!is_one) develop_band(p, {}, p.samples.mean(lit.light, p.timer), frame);
        p.picture.finish(p.timer, stats);
        add_band(total, stats);
        total.frame_ms += std::max(0.0, ms_since(start) - stats.build_ms);
        add_pixels(p, shot, picture);
        // frame_ms leaves out the time of add_pixels().
        p.context.gpu.programs->take_builds();
        p.timer = StageTimer();
    }
}

// Does what needs all rows: stages over the whole picture, and views.
void finish(Pipeline& p, const Shot& shot, SharedPicture& picture, FrameStats& stats) {
    Frame& frame = picture.frame;
    const Clock::time_point start = Clock::now();
    if (const auto light = p.picture.whole_light(shot.camera, frame)) {
        develop(p, *light, frame);
        const double built_ms = stats.build_ms;
        p.picture.finish(p.timer, stats);
        stats.frame_ms += ms_since(start) - (stats.build_ms - built_ms);
    }
    show_view(p, shot, picture.surfaces, frame);
    if (!p.context.settings.want.radiance) frame.radiance.clear();
}

Frame make_frame(Pipeline& p, const Shot& shot) {
    SharedPicture picture;
    const QueueDrain drain(p.context.gpu.queue);
    allocate(p, {0, p.context.settings.height}, !shot.display.empty(), false, picture.frame);
    render_bands(p, shot, picture, picture.frame.stats);
    finish(p, shot, picture, picture.frame.stats);
    p.samples.keep();
    return std::move(picture.frame);
}

// Calls `call`. If it fails, the pipeline is marked, and not used again.
template <typename Call>
auto soundly(Pipeline& pipeline, const Call& call) {
    try {
        return call();
    } catch (const Interrupted&) {
        throw;
    } catch (...) {
        pipeline.last.is_sound = false;
        throw;
    }
}

}  // namespace

Frame render_frame(Pipeline& pipeline, const Shot& shot) {
    return soundly(pipeline, [&] { return make_frame(pipeline, shot); });
}

Frame render_strip(Pipeline& pipeline, const Shot& shot) {
    return soundly(pipeline, [&] {
        SharedPicture strip;
        const QueueDrain drain(pipeline.context.gpu.queue);
        allocate(pipeline, *shot.rows, false, false, strip.frame);
        render_bands(pipeline, shot, strip, strip.frame.stats);
        return std::move(strip.frame);
    });
}

std::unique_ptr<SharedPicture> begin_rows(const Pipeline& pipeline) {
    auto picture = std::make_unique<SharedPicture>();
    allocate(pipeline, {0, pipeline.context.settings.height}, false, true, picture->frame);
    return picture;
}

FrameStats render_rows(Pipeline& pipeline, const Shot& shot, SharedPicture& picture) {
    return soundly(pipeline, [&] {
        FrameStats stats;
        const QueueDrain drain(pipeline.context.gpu.queue);
        render_bands(pipeline, shot, picture, stats);
        return stats;
    });
}

FrameStats finish_rows(Pipeline& pipeline, const Shot& shot, SharedPicture& picture) {
    return soundly(pipeline, [&] {
        FrameStats stats;
        const QueueDrain drain(pipeline.context.gpu.queue);
        // As begin() does, which this renderer has not called if others made all rows.
        pipeline.context.scene->make_current();
        pipeline.context.scene->take_up_changes();
        pipeline.timer = StageTimer();
        pipeline.picture.begin({}, picture.frame, true);
        finish(pipeline, shot, picture, stats);
        return stats;
    });
}

}  // namespace kilolux
