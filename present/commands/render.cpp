// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_values.h"
#include "present/cli/options.h"
#include "present/commands/camera_motion.h"
#include "present/commands/made_picture.h"
#include "present/commands/picture_advice.h"
#include "present/commands/picture_files.h"
#include "present/commands/scene_renderer.h"
#include "present/image/comparison.h"
#include "present/image/image_file.h"
#include "present/program.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

std::string noted_time(double time) { return text_of(time) + " s"; }

// The pictures asked for, computed one at a time: a sequence may have 2^31 of them.
class Tasks {
 public:
    explicit Tasks(const RenderOptions& options) : options_(options) {
        const OutputOptions& out = options.output;
        if (out.frames) frames_.emplace(*out.frames, out.shard);
        has_video_ = out.skip_existing && is_video(out.output) &&
                     is_made(wanted_video(options.shared.settings, out, options.command));
    }

    std::size_t size() const { return frames_ ? frames_->size() : 1; }

    PictureTask operator[](std::size_t i) const {
        const OutputOptions& out = options_.output;
        const double time = options_.shared.time;
        if (!frames_) return {0, time, out.output, out.reference, out.difference};
        const int frame = (*frames_)[i];
        return {frame, time + frame / out.frames_per_second, frame_file(out.output, frame),
                frame_file(out.reference, frame), frame_file(out.difference, frame)};
    }

    bool is_done(const PictureTask& task) const {
        if (is_video(task.file)) return has_video_;
        const RenderSettings& s = options_.shared.settings;
        return options_.output.skip_existing &&
               is_made({task.file, s.width, s.height, options_.command, noted_time(task.time)});
    }

    std::size_t first_to_do() const {
        std::size_t i = 0;
        while (i < size() && is_done((*this)[i])) ++i;
        return i;
    }

 private:
    const RenderOptions& options_;
    std::optional<ShardFrames> frames_;
    bool has_video_ = false;  // the one that is asked for is there
};

ImageNotes notes_of(const RenderOptions& options, SceneRenderer& pictures,
                    const FrameRecord& record) {
    ImageNotes notes = picture_notes(options.shared, pictures.renderer().device(), record.stats);
    notes.strings.emplace_back("command", options.command);
    std::erase_if(notes.strings, [](const auto& entry) { return entry.first == "time"; });
    notes.strings.emplace_back("time", noted_time(record.time));
    if (record.comparison) {
        notes.strings.emplace_back("error", comparison_text(*record.comparison));
    }
    notes.camera = pictures.camera();
    return notes;
}

// Says where a layer is stored as the options did not ask for.
void note_layers(const RenderOptions& options, const Frame& frame, const fs::path& file) {
    for (const Layer& layer : frame.aovs) {
        if (options.output.uint_ids || float_holds(layer)) continue;
        note(fmt::format("{}: layer {} is UINT: a float does not hold its largest numbers",
                         file.string(), layer.name));
    }
}

// Renders a task's picture; returns its record.
FrameRecord render_task(const RenderOptions& options, SceneRenderer& pictures,
                        RenderedPicture& picture) {
    const OutputOptions& out = options.output;
    const PictureTask& task = picture.task;
    std::optional<Reference> reference;
    if (!task.reference.empty()) {
        const RenderSettings& settings = pictures.renderer().settings();
        require_reference_size(task.reference, settings.width, settings.height);
        reference.emplace(task.reference);
    }
    Frame& frame = picture.frame;
    frame = pictures.render(task.time, task.frame);
    check_interrupt();
    FrameRecord record{task.frame, task.time, output_name(task.file), frame.stats, std::nullopt};
    if (reference) {
        record.comparison = reference->compare(frame, out.metric, out.threshold.value_or(0.0));
    }
    if (!task.difference.empty()) picture.difference = reference->difference(frame);
    if (options.shared.show_error) frame.display = reference->error_map(frame).rgba;
    if (options.has_alpha) picture.alpha = pictures.coverage(frame, task.time, task.frame);
    note_layers(options, frame, task.file);
    picture.notes = notes_of(options, pictures, record);
    return record;
}

void advise(SceneRenderer& pictures, const FrameRecord& record) {
    const std::string advice =
        picture_advice(pictures.scene().scene(), pictures.camera(), pictures.renderer().settings(),
                       record.stats, pictures.is_framed());
    if (!advice.empty()) note(record.file + ": " + advice);
}

WrittenPictures render_tasks(const RenderOptions& options, const Tasks& tasks,
                             SceneRenderer& pictures) {
    const bool counted = !options.output.stats.empty();
    const std::size_t first = tasks.first_to_do();
    PictureFiles files(options, tasks.size() - first, pictures.renderer());
    bool is_first = true;
    for (std::size_t i = first; i < tasks.size(); ++i) {
        check_interrupt();
        RenderedPicture picture;
        picture.task = tasks[i];
        if (tasks.is_done(picture.task)) {
            files.skip();
            continue;
        }
        FrameRecord record = render_task(options, pictures, picture);
        if (std::exchange(is_first, false)) advise(pictures, record);
        if (counted) pictures.fill_limits(record);
        files.add(std::move(picture), std::move(record));
    }
    return files.finish();
}

// Exposes by the sequence's first frame, also in a shard that does not contain it.
void expose_automatically(const RenderOptions& options, SceneRenderer& pictures) {
    const OutputOptions& out = options.output;
    const double time = options.shared.time;
    if (!out.frames) return pictures.expose_automatically(time);
    const int first = out.frames->first;
    pictures.expose_automatically(time + first / out.frames_per_second, first,
                                  ", of the sequence's first frame");
}

// Checks before rendering what would otherwise fail after it.
void check_files(const RenderOptions& options, const Tasks& tasks, const PictureTask& first) {
    const OutputOptions& out = options.output;
    if (is_video(out.output)) {
        check_can_write_video(out.output);
    } else {
        check_can_write_image(first.file);
    }
    if (!out.difference.empty()) check_can_write_image(first.difference);
    if (!out.stats.empty() && out.stats != "-") check_can_write(out.stats);
    if (out.reference.empty()) return;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const fs::path reference = tasks[i].reference;
        if (!fs::exists(reference)) throw Error(reference.string() + ": no such reference");
    }
    const RenderSettings& settings = options.shared.settings;
    require_reference_size(first.reference, settings.width, settings.height);
}

// The results that files and the comparison need. Counting useful evaluations takes a pass of its
// own.
FrameRequest request_of(const RenderOptions& options, const FrameRequest& asked) {
    const OutputOptions& out = options.output;
    const bool own_display = wants_own_display(options) || options.has_alpha;
    const bool for_the_eye = is_for_the_eye(out.output);
    FrameRequest want = asked;
    want.display = for_the_eye || !out.reference.empty();
    want.radiance = !for_the_eye || own_display || !out.reference.empty();
    want.bloomed = own_display;
    want.counts =
        !out.stats.empty() || std::ranges::find(want.aovs, "light-count") != want.aovs.end();
    return want;
}

void warn_of_exposure(const RenderOptions& options) {
    const bool exposes =
        options.shared.automatic_exposure || options.shared.settings.exposure != 0.0f;
    if (!exposes || is_for_the_eye(options.output.output)) return;
    note(options.output.output.string() + ": holds linear light, which --exposure does not change");
}

// Whether the picture has transparent background: --background none, where the format has alpha.
// Bloom reaches beyond surfaces, and debug views show no light, so neither has.
bool wants_alpha(const RenderOptions& options) {
    const SharedOptions& shared = options.shared;
    return shared.background.kind == BackgroundChoice::Kind::none &&
           !is_video(options.output.output) && holds_alpha(options.output.output) &&
           shared.settings.bloom == 0.0f && shared.settings.want.view == ViewKind::lit &&
           !shared.show_error;
}

void run_render(RenderOptions& options) {
    const OutputOptions& out = options.output;
    check_output_options(options.shared, out);
    options.command = picture_command(options.shared, out);
    options.has_alpha = wants_alpha(options);  // lighting the scene may change the background
    begin_command(options.shared, !out.reference.empty());
    check_budget(options.shared, options.budget);
    const Tasks tasks(options);
    if (tasks.size() == 0) {
        return note(fmt::format("nothing to render: shard {}/{} has none of the frames {}:{}",
                                out.shard.index, out.shard.count, out.frames->first,
                                out.frames->last));
    }
    const std::size_t begin = tasks.first_to_do();
    if (begin == tasks.size()) return note("nothing to render: every file is there");
    const PictureTask first = tasks[begin];
    check_files(options, tasks, first);
    check_light_memory(options.shared.lights_given ? options.shared.settings.lights.count : 0,
                       options.shared.settings);
    warn_of_exposure(options);
    const CameraMotion motion(options.shared, out);
    const auto camera = [&motion](const Scene& scene, int frame, double time) {
        return motion.at(scene, frame, time);
    };
    SceneRenderer pictures(options.shared, options.budget,
                           {request_of(options, options.shared.settings.want), first.time,
                            first.frame, camera, std::nullopt});
    note(pictures.rig_lines());  // before the frames, which may take minutes
    if (options.shared.automatic_exposure) expose_automatically(options, pictures);
    const WrittenPictures made = render_tasks(options, tasks, pictures);
    if (!out.stats.empty()) {
        write_json(out.stats, pictures.stats(made.last, false), made.log ? &*made.log : nullptr);
    }
    note(frame_summary(pictures.scene().scene(), pictures.renderer().device(), made.last,
                       made.count));
    if (!made.first_failure.empty()) throw ComparisonFailed(made.first_failure);
}

void add_render_options(CLI::App& command, RenderOptions& options) {
    options.shared.takes_automatic_exposure = true;
    options.shared.takes_automatic_samples = true;
    options.shared.shows_environment = true;
    add_shared_options(command, options.shared);
    add_output_options(command, options.output);
    add_budget_options(command, options.budget);
}

constexpr const char* kRenderExamples =
    "  kilolux render -o atrium.png\n"
    "  kilolux render -o atrium.exr --lights 100000 --aov depth,normal,light-count\n"
    "  kilolux render town.glb -o town.png --lights 0 --camera-index 1 --resolution 3840x2160\n"
    "  kilolux render mug.glb -o turn.###.png --frames 0:119 --turntable 360\n"
    "  kilolux render -o frame.####.exr --frames 0:239 --fps 24 --shard 3/8 --skip-existing\n"
    "  kilolux render -o flight.mp4 --frames 0:239 --fps 24\n"
    "  kilolux render -o - --frames 0:239 --quiet | mpv -\n"
    "  kilolux render -o now.exr --reference all.exr --threshold 0 --difference where.png\n"
    "  kilolux render -o atrium.png --stats - --quiet";

}  // namespace

void add_render_command(Program& program) {
    program.add_command("render", "Render a scene to an image file, a sequence of them or a video",
                        kRenderExamples, add_render_options, run_render);
}

}  // namespace kilolux
