// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/kernel_choice.h"
#include "host/render/renderer.h"
#include "present/cli/error_budget_options.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_values.h"
#include "present/cli/options.h"
#include "present/cli/picture_advice.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench.h"
#include "present/image/automatic_exposure.h"
#include "present/image/comparison.h"
#include "present/image/image_file.h"
#include "present/program.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
    SharedOptions shared;
    OutputOptions output;
    BudgetOptions budget;
};

// One picture to make: a frame of the sequence, or the only one.
struct Task {
    int frame = 0;
    double time = 0.0;  // [s]
    fs::path file;
    fs::path reference;   // empty: none
    fs::path difference;  // empty: none
};

// The pictures asked for, computed one at a time: a sequence may have 2^31 of them.
class Tasks {
 public:
    explicit Tasks(const RenderOptions& options) : options_(options) {
        if (options.output.frames) frames_.emplace(*options.output.frames, options.output.shard);
    }

    std::size_t size() const { return frames_ ? frames_->size() : 1; }

    Task operator[](std::size_t i) const {
        const OutputOptions& out = options_.output;
        const double time = options_.shared.time;
        if (!frames_) return {0, time, out.output, out.reference, out.difference};
        const int frame = (*frames_)[i];
        return {frame, time + frame / out.frames_per_second, frame_file(out.output, frame),
                frame_file(out.reference, frame), frame_file(out.difference, frame)};
    }

    // Files are written whole, so an existing one counts as done.
    bool is_done(const Task& task) const {
        return options_.output.skip_existing && fs::exists(task.file);
    }

    std::size_t first_to_do() const {
        std::size_t i = 0;
        while (i < size() && is_done((*this)[i])) ++i;
        return i;
    }

 private:
    const RenderOptions& options_;
    std::optional<ShardFrames> frames_;
};

// A summary of the pictures made so far.
struct Made {
    std::size_t count = 0;
    FrameRecord last;
    std::string first_failure;  // of a comparison; empty: none
    std::optional<FrameLog> log;
};

bool is_for_the_eye(const fs::path& output) {
    return is_video(output) || image_meaning(output) == ImageMeaning::display;
}

bool wants_own_display(const RenderOptions& options) {
    return options.output.bits == 16 || uses_ocio(options.output.ocio);
}

ImageNotes notes_of(const RenderOptions& options, const Renderer& renderer, const Camera& camera,
                    const FrameRecord& record) {
    ImageNotes notes = picture_notes(options.shared, renderer.device(), record.stats);
    notes.strings.emplace_back("time", text_of(record.time) + " s");
    if (record.comparison) {
        notes.strings.emplace_back("error", comparison_text(*record.comparison));
    }
    notes.camera = camera;
    return notes;
}

// The renderer's display picture has 8 bits and our tone curves; others are made here.
ImageOptions image_options(const RenderOptions& options, const Frame& frame, const Task& task) {
    const OutputOptions& out = options.output;
    ImageOptions image;
    image.half_colour = out.half_colour;
    image.bits = out.bits;
    if (is_for_the_eye(task.file) && wants_own_display(options)) {
        image.display = options.shared.show_error
                            ? display_codes(frame)
                            : display_colours(frame, options.shared.settings, out.ocio);
    }
    return image;
}

// A task's frame into its file, or the next one of the video.
void write_picture(Frame& frame, const fs::path& file, const ImageNotes& notes,
                   const ImageOptions& image, VideoFile* video) {
    if (video == nullptr) return write_image(file, frame, notes, image);
    if (!image.display.empty()) set_display(frame, image.display);
    video->write(frame);
}

FrameRecord render_task(const RenderOptions& options, Renderer& renderer, const Camera& camera,
                        const Task& task, VideoFile* video) {
    const OutputOptions& out = options.output;
    std::optional<Reference> reference;
    if (!task.reference.empty()) {
        require_reference_size(task.reference, renderer.settings().width,
                               renderer.settings().height);
        reference.emplace(task.reference);
    }
    Frame frame = renderer.render(camera, task.time, check_interrupt);
    check_interrupt();
    FrameRecord record{task.frame, task.time, output_name(task.file), frame.stats, std::nullopt};
    if (reference) {
        record.comparison = reference->compare(frame, out.metric, out.threshold.value_or(0.0));
    }
    if (!task.difference.empty()) write_image(task.difference, reference->difference(frame));
    if (options.shared.show_error) frame.display = reference->error_map(frame).rgba;
    write_picture(frame, task.file, notes_of(options, renderer, camera, record),
                  image_options(options, frame, task), video);
    return record;
}

void advise(const Scene& scene, const Camera& camera, const Renderer& renderer,
            const FrameRecord& record) {
    const std::string advice = picture_advice(scene, camera, renderer.settings(), record.stats);
    if (!advice.empty()) note(record.file + ": " + advice);
}

void add(Made& made, FrameRecord record) {
    if (made.log) made.log->add(record);
    const bool failed = record.comparison && !record.comparison->passed();
    if (failed && made.first_failure.empty()) {
        made.first_failure = record.file + ": " + comparison_text(*record.comparison);
    }
    ++made.count;
    made.last = std::move(record);
}

Made render_tasks(const RenderOptions& options, const Tasks& tasks, AnimatedScene& scene,
                  Renderer& renderer) {
    Made made;
    // What each stage would take at the device's limits, which are measured once a device.
    std::optional<DeviceLimits> limits;
    if (!options.output.stats.empty()) {
        limits = cached_device_limits(Gpu(choose_device(renderer.settings().device)));
        if (options.output.frames) made.log.emplace();
    }
    std::optional<VideoFile> video;
    if (const OutputOptions& out = options.output; is_video(out.output)) {
        const RenderSettings& s = renderer.settings();
        video.emplace(out.output, VideoFormat{s.width, s.height, out.frames_per_second});
    }
    const std::size_t first = tasks.first_to_do();
    Progress progress("rendering", tasks.size() - first, !options.shared.quiet);
    for (std::size_t i = first; i < tasks.size(); ++i) {
        check_interrupt();
        const Task task = tasks[i];
        if (!tasks.is_done(task)) {
            scene.set_time(task.time);
            const Camera camera = choose_camera(options.shared, scene.scene());
            FrameRecord record =
                render_task(options, renderer, camera, task, video ? &*video : nullptr);
            if (made.count == 0) advise(scene.scene(), camera, renderer, record);
            if (limits) {
                fill_limits(record.stats, *limits,
                            frame_setup(renderer.settings(), renderer.plan(), renderer.device()));
            }
            add(made, std::move(record));
        }
        progress.advance();
    }
    if (video) video->commit();
    return made;
}

// By the sequence's first frame, also in a shard that does not have it.
void expose_automatically(RenderOptions& options, AnimatedScene& scene, Renderer& renderer) {
    const OutputOptions& out = options.output;
    const double time =
        options.shared.time + (out.frames ? out.frames->first / out.frames_per_second : 0.0);
    scene.set_time(time);
    const RenderSettings wanted = renderer.settings();
    RenderSettings settings = wanted;
    settings.want = radiance_only();
    renderer.change(settings);
    const Frame frame =
        renderer.render(choose_camera(options.shared, scene.scene()), time, check_interrupt);
    settings = wanted;
    settings.exposure = options.shared.settings.exposure = automatic_exposure(frame.radiance);
    renderer.change(settings);
    note(fmt::format("exposure {} EV (automatic{}): --exposure {} makes it again",
                     settings.exposure, out.frames ? ", of the sequence's first frame" : "",
                     settings.exposure));
}

// Checks before rendering what would fail after it.
void check_files(const RenderOptions& options, const Tasks& tasks, const Task& first) {
    const OutputOptions& out = options.output;
    if (is_video(out.output)) {
        check_can_write_video(out.output);
    } else {
        check_can_write(first.file);
    }
    if (!out.difference.empty()) check_can_write(first.difference);
    if (!out.stats.empty() && out.stats != "-") check_can_write(out.stats);
    if (out.reference.empty()) return;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const fs::path reference = tasks[i].reference;
        if (!fs::exists(reference)) throw Error(reference.string() + ": no such reference");
    }
    const RenderSettings& settings = options.shared.settings;
    require_reference_size(first.reference, settings.width, settings.height);
}

// What the files and the comparison read. Counting useful evaluations costs a pass of its own.
FrameRequest request_of(const RenderOptions& options, const FrameRequest& asked) {
    const OutputOptions& out = options.output;
    const bool own_display = wants_own_display(options);
    const bool for_the_eye = is_for_the_eye(out.output);
    FrameRequest want = asked;
    want.display = for_the_eye || !out.reference.empty();
    want.radiance = !for_the_eye || own_display || !out.reference.empty();
    want.bloomed = own_display;
    want.counts =
        !out.stats.empty() || std::ranges::find(want.aovs, "light-count") != want.aovs.end();
    return want;
}

RenderSettings settings_of(const RenderOptions& options, const ReportView& view) {
    RenderSettings settings = settings_within_budget(options.shared, options.budget, view);
    settings.want = request_of(options, settings.want);
    return settings;
}

void run_render(RenderOptions& options) {
    const OutputOptions& out = options.output;
    check_output_options(options.shared, out);
    begin_command(options.shared, !out.reference.empty());
    const Tasks tasks(options);
    const std::size_t begin = tasks.first_to_do();
    if (begin == tasks.size()) return note("nothing to render: every file is there");
    const Task first = tasks[begin];
    check_files(options, tasks, first);
    check_light_memory(options.shared.settings);
    AnimatedScene scene = open_animated_scene(options.shared, first.time);
    const std::string rig = light_scene(options.shared, scene);
    const Camera camera = choose_camera(options.shared, scene.scene());
    check_interrupt();
    Renderer renderer(scene.scene(), settings_of(options, {scene.scene(), camera, first.time}));
    check_interrupt();
    if (options.shared.automatic_exposure) expose_automatically(options, scene, renderer);
    const Made made = render_tasks(options, tasks, scene, renderer);
    if (!out.stats.empty()) {
        auto document = stats_json(renderer.device(), renderer.plan(), made.last);
        document["program"] = program_json();
        document["tuning"] =
            tuning_json(choose_tuning(renderer.device(), renderer.settings().kernels));
        write_json(out.stats, document, made.log ? &*made.log : nullptr);
    }
    note(rig + "\n" + frame_summary(scene.scene(), renderer.device(), made.last, made.count));
    if (!made.first_failure.empty()) throw ComparisonFailed(made.first_failure);
}

void add_render_options(CLI::App& command, RenderOptions& options) {
    options.shared.takes_automatic_exposure = true;
    add_shared_options(command, options.shared);
    add_output_options(command, options.output);
    add_budget_options(command, options.budget);
}

constexpr const char* kExamples =
    "  kilolux render -o atrium.png\n"
    "  kilolux render -o atrium.exr --lights 100000 --aov depth,normal,light-count\n"
    "  kilolux render town.glb -o town.png --lights 0 --camera-index 1 --resolution 3840x2160\n"
    "  kilolux render -o frame.####.exr --frames 0:239 --fps 24 --shard 3/8 --skip-existing\n"
    "  kilolux render -o flight.mp4 --frames 0:239 --fps 24\n"
    "  kilolux render -o - --frames 0:239 --quiet | mpv -\n"
    "  kilolux render -o now.exr --reference all.exr --threshold 0 --difference where.png\n"
    "  kilolux render -o atrium.png --stats - --quiet";

}  // namespace

void add_render_command(Program& program) {
    program.add_command("render", "Render a scene to an image file, a sequence of them or a video",
                        kExamples, add_render_options, run_render);
}

}  // namespace kilolux
