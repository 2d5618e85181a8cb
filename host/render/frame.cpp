// SPDX-License-Identifier: Apache-2.0
#include "host/render/frame.h"

#include <fmt/format.h>
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

// Reads a band's AOVs, and its surfaces if a view needs them.
void add_pixels(Pipeline& p, const Shot& shot, SharedPicture& picture) {
    const FrameRequest& want = p.context.settings.want;
    if (!reads_pixels(p.context.settings)) return;
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
    std::ranges::move(make_light_layers(pixels, p.context.settings.light_groups),
                      std::back_inserter(layers));
    pixels.light = {};
    const auto width = static_cast<std::size_t>(frame.width);
    const std::scoped_lock lock(picture.placing);
    const std::size_t row = pixels.view.first_row - static_cast<std::size_t>(frame.first_row);
    place_layers(frame.aovs, std::move(layers), width * row,
                 width * static_cast<std::size_t>(frame.height));
    if (want.view != ViewKind::lit) {
        place_surfaces(picture.surfaces, std::move(pixels), frame.height);
    }
}

// Replaces the lit picture by the view that is asked for. Radiance that only views need goes.
void show_view(Pipeline& p, const Shot& shot, SharedPicture& picture) {
    const FrameRequest& want = p.context.settings.want;
    const ViewKind view = want.view;
    Frame& frame = picture.frame;
    std::vector<float> fragments, reference_light;
    if (view == ViewKind::overdraw) {
        fragments = p.reader.overdraw(shot.camera, DrawOrder::front_to_back);
    }
    if (view == ViewKind::difference) {
        reference_light = render_frame(*p.reference, {shot.camera, shot.time}).radiance;
    }
    if (view != ViewKind::lit) {
        frame.display = make_view(view, {picture.surfaces, shot.camera, p.context.scene->box(),
                                         fragments, frame.radiance, reference_light});
    }
    if (!want.radiance) frame.radiance.clear();
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
    PictureKey opengl = key;
    opengl.settings.background.reset();
    opengl.settings.want = {};
    if (!shot.rows || !(opengl == p.last.opengl)) p.last.raster_tile = -1;
    p.last.opengl = std::move(opengl);
    p.samples.begin(key, context.is_whole() ? shot.samples : 0);
    p.picture.begin(shot.display, frame, shot.rows.has_value());
    stats.zero_normals = context.scene->zero_normals();
    LightInput lights = place_lights(p, shot, stats);
    stats.frame_ms += ms_since(start);
    return lights;
}

// The stages from the light of all samples to the frame.
void finish_picture(Pipeline& p, LitBand& band, Frame& frame) {
    p.picture.bloom(band, p.timer);
    p.picture.tonemap(band, p.timer);
    p.picture.read(band, frame, p.timer);
}

// Renders a band sample by sample, in the order of a frame; begin() has placed the lights. Repeats
// the stages whose results had no room.
void render_band(Pipeline& p, const Shot& shot, const LightInput& lights, const Band& band,
                 Frame& frame, Measured out) {
    FrameStages& stages = p.current_stages();
    LitBand& lit = p.last.band;
    bool is_finished = false;
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
            p.environment.fill_behind(lit, p.timer);
            stages.shade(sample, lit, out);
            p.environment.enqueue(lit, p.timer);
            stages.blend(lit, p.environment, out);
            stages.count(out);
            is_finished = p.samples.is_one() && stages.expects_no_more_layers();
            if (is_finished) finish_picture(p, lit, frame);
            room = stages.room(lit, out);  // meanwhile the device copies it
            if (room.surfaces) before = with_surfaces;
        }
        p.reader.count({lit, stages, sample.camera}, out.stats);
        if (stages.blend_rest(lit, p.environment, out)) {
            is_finished = false;
            lit.drop_picture();
        }
        out.stats.shaded_display = sample.display.has_value();
        if (!p.samples.is_one()) p.samples.add(lit.light, out);
    }
    if (!is_finished) {
        lit.light = p.samples.mean(lit.light, p.timer);
        finish_picture(p, lit, frame);
    }
    p.picture.finish(p.timer, out.stats);
}

void render_bands(Pipeline& p, const Shot& shot, SharedPicture& picture, FrameStats& total) {
    Frame& frame = picture.frame;
    const LightInput lights = begin(p, shot, frame, total);
    const int height = p.context.settings.height;
    const Band rows = shot.rows.value_or(Band{0, height});
    for (const Band& band : make_bands(height, p.context.memory.band_rows, rows)) {
        const Clock::time_point start = Clock::now();
        FrameStats stats;
        render_band(p, shot, lights, band, frame, {p.timer, stats});
        add_band(total, stats);
        // Waits for programs may have begun in begin().
        total.frame_ms = std::max(0.0, total.frame_ms + ms_since(start) - stats.build_ms);
        add_pixels(p, shot, picture);
        p.timer = StageTimer();  // frame_ms leaves out the time of add_pixels()
    }
}

// Runs the stages over the whole picture, for rows that several renderers made.
void finish_light(Pipeline& p, Frame& frame, FrameStats& stats) {
    const Clock::time_point start = Clock::now();
    LitBand all;
    p.picture.bloom_rows(frame, all, p.timer);
    p.picture.tonemap(all, p.timer);
    p.picture.read(all, frame, p.timer);
    p.picture.finish(p.timer, stats);
    stats.frame_ms += ms_since(start) - stats.build_ms;
}

Frame make_frame(Pipeline& p, const Shot& shot) {
    SharedPicture picture;
    const QueueDrain drain(p.context.gpu.queue);
    allocate(p, {0, p.context.settings.height}, !shot.display.empty(), false, picture.frame);
    render_bands(p, shot, picture, picture.frame.stats);
    show_view(p, shot, picture);
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

Frame render_crop(Pipeline& pipeline, const Shot& shot, const PixelRect& rect) {
    const RenderContext& context = pipeline.context;
    const RenderSettings& s = context.settings;
    const bool is_inside = rect.x >= 0 && rect.y >= 0 && rect.width > 0 && rect.height > 0 &&
                           rect.width <= s.width - rect.x && rect.height <= s.height - rect.y;
    if (!is_inside) {
        throw Error(fmt::format("render: no crop {},{},{},{} of a picture of {}x{} pixels", rect.x,
                                rect.y, rect.width, rect.height, s.width, s.height));
    }
    Frame out;
    if (!can_make_strips(s)) {
        add_crop(out, rect, render_frame(pipeline, shot));
        return out;
    }
    const int least = context.memory.least_rows;
    const int last = rect.y + rect.height - 1;
    const int end = std::min(s.height, (last / least + 1) * least);
    const int rows = std::max(least, context.memory.strip_rows / least * least);
    for (int row = rect.y / least * least; row < end; row += rows) {
        Shot strip = shot;
        strip.rows = {row, std::min(rows, end - row)};
        add_crop(out, rect, render_strip(pipeline, strip));
    }
    return out;
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
        if (needs_whole_picture(pipeline.context.settings)) {
            finish_light(pipeline, picture.frame, stats);
        }
        show_view(pipeline, shot, picture);
        return stats;
    });
}

}  // namespace kilolux
