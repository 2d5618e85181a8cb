// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "host/measure/bench/known_costs.h"
#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/renderer.h"
#include "present/cli/error_budget_options.h"
#include "present/cli/frame_summary.h"
#include "present/cli/options.h"
#include "present/cli/progress.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/commands/commands.h"
#include "present/image/comparison.h"
#include "present/image/image_file.h"

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
    fs::path reference;  // empty: none
};

std::vector<Task> tasks_of(const RenderOptions& options) {
    const OutputOptions& out = options.output;
    if (!out.frames) {
        const Task only{0, options.shared.time, out.output, out.reference};
        return out.skip_existing && fs::exists(only.file) ? std::vector<Task>{} : std::vector{only};
    }
    std::vector<Task> tasks;
    for (const int frame : frames_of_shard(*out.frames, out.shard)) {
        const Task task{frame, options.shared.time + frame / out.frames_per_second,
                        frame_file(out.output, frame), frame_file(out.reference, frame)};
        // A file that is there is whole, so an interrupted sequence goes on where it stopped.
        if (!out.skip_existing || !fs::exists(task.file)) tasks.push_back(task);
    }
    return tasks;
}

bool wants_own_display(const RenderOptions& options) {
    return options.output.bits == 16 || uses_ocio(options.output.ocio);
}

ImageNotes notes_of(const RenderOptions& options, const Renderer& renderer, const Camera& camera,
                    const Task& task, const FrameRecord& record) {
    ImageNotes notes = picture_notes(options.shared, renderer.device(), record.stats);
    notes.strings.emplace_back("time", number_text(task.time) + " s");
    if (record.comparison) {
        notes.strings.emplace_back("error", comparison_text(*record.comparison));
    }
    notes.camera = camera;
    return notes;
}

// The display picture is made anew where the renderer's, of 8 bits and by our tone curves, is not
// what was asked for.
ImageOptions image_options(const RenderOptions& options, const Frame& frame, const Task& task) {
    const OutputOptions& out = options.output;
    ImageOptions image;
    image.half_colour = out.half_colour;
    image.bits = out.bits;
    if (image_meaning(task.file) == ImageMeaning::display && wants_own_display(options)) {
        image.display = display_colours(frame, options.shared.settings, out.ocio);
    }
    return image;
}

FrameRecord render_task(const RenderOptions& options, Renderer& renderer, const Camera& camera,
                        const Task& task) {
    const OutputOptions& out = options.output;
    std::optional<Reference> reference;
    if (!task.reference.empty()) reference.emplace(task.reference);
    const Frame frame = renderer.render(camera, task.time, check_interrupt);
    check_interrupt();
    FrameRecord record{task.frame, task.time, task.file.string(), frame.stats, std::nullopt};
    if (reference) record.comparison = reference->compare(frame, out.metric, out.threshold);
    write_image(task.file, frame, notes_of(options, renderer, camera, task, record),
                image_options(options, frame, task));
    return record;
}

std::vector<FrameRecord> render_tasks(const RenderOptions& options, AnimatedScene& scene,
                                      Renderer& renderer, const std::vector<Task>& tasks) {
    std::vector<FrameRecord> records;
    Progress progress("rendering", tasks.size(), !options.shared.quiet);
    for (const Task& task : tasks) {
        check_interrupt();
        scene.set_time(task.time);
        const Camera camera = choose_camera(options.shared.camera, scene.scene());
        records.push_back(render_task(options, renderer, camera, task));
        progress.advance();
    }
    return records;
}

// What would fail after the work is asked before it.
void check_files(const RenderOptions& options, const std::vector<Task>& tasks) {
    if (!tasks.empty()) check_can_write(tasks.front().file);
    if (!options.output.stats.empty() && options.output.stats != "-") {
        check_can_write(options.output.stats);
    }
    for (const Task& task : tasks) {
        if (!task.reference.empty() && !fs::exists(task.reference)) {
            throw Error(task.reference.string() + ": no such reference");
        }
    }
}

void require_passed(const std::vector<FrameRecord>& records) {
    for (const FrameRecord& record : records) {
        if (record.comparison && !record.comparison->passed()) {
            throw ComparisonFailed(record.file + ": " + comparison_text(*record.comparison));
        }
    }
}

// What the files and the comparison read. Counting useful evaluations costs a pass of its own.
FrameRequest request_of(const RenderOptions& options, const FrameRequest& asked) {
    const OutputOptions& out = options.output;
    const bool own_display = wants_own_display(options);
    const bool for_the_eye = image_meaning(out.output) == ImageMeaning::display;
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

// What each stage would take at the device's measured limits; measures them once a device.
void fill_limits(std::vector<FrameRecord>& records, const Renderer& renderer) {
    const DeviceLimits limits =
        cached_device_limits(Gpu(choose_device(renderer.settings().device)));
    const FrameSetup setup = frame_setup(renderer.settings(), renderer.plan(), renderer.device());
    for (FrameRecord& record : records) fill_limits(record.stats, limits, setup);
}

void run_render(const RenderOptions& options) {
    const OutputOptions& out = options.output;
    check_output_options(options.shared, out);
    set_verbosity(verbosity_of(options.shared));
    const std::vector<Task> tasks = tasks_of(options);
    if (tasks.empty()) return note("nothing to render: every file is there");
    check_files(options, tasks);
    check_light_memory(options.shared.settings);
    AnimatedScene scene = open_animated_scene(options.shared, tasks.front().time);
    const Camera camera = choose_camera(options.shared.camera, scene.scene());
    check_interrupt();
    Renderer renderer(scene.scene(),
                      settings_of(options, {scene.scene(), camera, tasks.front().time}));
    check_interrupt();
    std::vector<FrameRecord> records = render_tasks(options, scene, renderer, tasks);
    if (!out.stats.empty()) {
        fill_limits(records, renderer);
        write_json(out.stats,
                   stats_json(renderer.device(), renderer.plan(), records, out.frames.has_value(),
                              known_feature_costs(renderer.device(), scene.scene(),
                                                  options.shared.settings)));
    }
    note(frame_summary(scene.scene(), renderer.device(), records));
    require_passed(records);
}

constexpr const char* kExamples =
    "  kilolux render -o atrium.png\n"
    "  kilolux render -o atrium.exr --lights 100000 --aov depth,normal,light-count\n"
    "  kilolux render town.glb -o town.png --lights 0 --camera-index 1 --resolution 3840,2160\n"
    "  kilolux render -o frame.####.exr --frames 0:239 --fps 24 --shard 3/8 --skip-existing\n"
    "  kilolux render -o now.exr --renderer deferred --reference all.exr --threshold 0\n"
    "  kilolux render -o atrium.png --stats - --quiet";

}  // namespace

void add_render_command(Program& program) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App& command =
        program.add_command("render", "Render a scene to an image file or a sequence of them",
                            kExamples, [options] { run_render(*options); });
    add_shared_options(command, options->shared);
    add_output_options(command, options->output);
    add_budget_options(command, options->budget);
}

}  // namespace kilolux
