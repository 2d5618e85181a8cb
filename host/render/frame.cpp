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
#include "host/render/host_stages.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// The lights at the frame's time, on the device and, for OpenGL's fragments, on the host.
LightInput place_lights(Pipeline& p, const Shot& shot, FrameStats& stats) {
    const RenderContext& context = p.context;
    const Clock::time_point start = Clock::now();
    p.lights.update(shot.time, shot.camera, stats);
    p.timer.record_host(kLightInputStage, ms_since(start));
    const LightInput input =
        p.lights.input(shot.camera.position, !context.settings.no_reuse, p.timer);
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
    out.redraw = !p.samples.is_one() || tile == band.first_row;
    out.number = next.number;
    out.needed = next.needed;
    if (p.context.shades_display()) {
        out.display = p.picture.target(view_of(out.camera, settings.width, settings.height, band));
    }
    return out;
}

// Bloom -> tonemap -> picture.
void develop(Pipeline& p, const Radiance& light, Frame& frame) {
    const Radiance glowing = p.picture.bloom(light, p.timer);
    p.picture.read_light(glowing, frame.bloomed, p.timer);
    const std::optional<DisplayTarget> display = p.picture.tonemap(glowing, p.timer);
    if (display) p.picture.read_display(*display, p.timer);
}

// Tone maps a band. Bloom over several bands waits for the last one.
void develop_band(Pipeline& p, const std::optional<DisplayTarget>& shaded, const Radiance& light,
                  Frame& frame) {
    if (shaded) return p.picture.read_display(*shaded, p.timer);
    p.picture.read_light(light, frame.radiance, p.timer);
    if (!p.picture.gathers(light)) develop(p, light, frame);
}

// A band's AOVs, and its surfaces for a view.
void add_pixels(Pipeline& p, const Shot& shot, DecodedSurfaces& surfaces, Frame& frame) {
    const FrameRequest& want = p.context.settings.want;
    if (!want.pixels()) return;
    DecodedSurfaces pixels = p.reader.pixels({p.last.band, p.current_stages(), shot.camera});
    p.samples.add_counts(pixels);
    std::vector<Layer> layers;
    for (const std::string& name : want.aovs) layers.push_back(make_aov(name, pixels, shot.camera));
    append_layers(frame.aovs, std::move(layers),
                  static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
    if (want.view != ViewKind::lit) place_surfaces(surfaces, std::move(pixels), frame.height);
}

// Replaces the lit picture by the view.
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

// The frame's size, and its lights on the device.
LightInput begin(Pipeline& p, const Shot& shot, Frame& frame) {
    const RenderContext& context = p.context;
    context.scene->make_current();
    context.scene->take_up_changes();
    const Clock::time_point start = Clock::now();
    p.timer = StageTimer();  // drops times of a frame that failed
    p.last.band = {};
    p.last.camera = shot.camera;
    p.samples.begin({context.settings, shot.camera, shot.time, context.scene->scene().revisions},
                    context.is_whole() ? shot.samples : 0);
    const Clock::time_point allocate_start = Clock::now();
    p.picture.begin(shot.display, frame);
    p.timer.record_host(kAllocateStage, ms_since(allocate_start));
    frame.stats.zero_normals = context.scene->zero_normals();
    const LightInput lights = place_lights(p, shot, frame.stats);
    frame.stats.frame_ms = ms_since(start);
    return lights;
}

// Lights -> surfaces -> lists -> visibility -> shading -> environment -> picture, sample by sample
// of each band. Stages whose results had no room are repeated.
void render_bands(Pipeline& p, const Shot& shot, DecodedSurfaces& surfaces, Frame& frame) {
    const LightInput lights = begin(p, shot, frame);
    FrameStages& stages = p.current_stages();
    LitBand& lit = p.last.band;
    const bool is_one = p.samples.is_one() && !stages.blends();
    for (const Band& band : make_bands(frame.height, p.context.memory.band_rows)) {
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
        add_band(frame.stats, stats);
        frame.stats.frame_ms += std::max(0.0, ms_since(start) - stats.build_ms);
        add_pixels(p, shot, surfaces, frame);
        // What the pixels took is no part of frame_ms.
        p.context.gpu.programs->take_builds();
        p.timer = StageTimer();
    }
}

Frame make_frame(Pipeline& p, const Shot& shot) {
    Frame frame;
    DecodedSurfaces surfaces;
    const QueueDrain drain(p.context.gpu.queue);
    render_bands(p, shot, surfaces, frame);
    if (const auto light = p.picture.gathered(shot.camera)) {
        const Clock::time_point start = Clock::now();
        develop(p, *light, frame);
        const double built_ms = frame.stats.build_ms;
        p.picture.finish(p.timer, frame.stats);
        frame.stats.frame_ms += ms_since(start) - (frame.stats.build_ms - built_ms);
    }
    show_view(p, shot, surfaces, frame);
    if (!p.context.settings.want.radiance) frame.radiance.clear();
    p.samples.keep();
    return frame;
}

}  // namespace

Frame render_frame(Pipeline& pipeline, const Shot& shot) {
    try {
        return make_frame(pipeline, shot);
    } catch (const Interrupted&) {
        throw;
    } catch (...) {
        pipeline.last.is_sound = false;
        throw;
    }
}

}  // namespace kilolux
