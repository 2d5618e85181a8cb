// SPDX-License-Identifier: Apache-2.0
#include "present/commands/picture_tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <thread>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_values.h"
#include "present/commands/made_picture.h"
#include "present/commands/picture_advice.h"
#include "present/commands/shared_tasks.h"
#include "present/image/comparison.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

std::string noted_time(double time) { return text_of(time) + " s"; }

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

// One of several renderers, with what its thread has come to.
struct Worker {
    DeviceShare share;
    std::exception_ptr failure{};
};

// What the threads of render_tasks() share.
struct Job {
    const RenderOptions& options;
    const PictureTasks& tasks;
    PictureFiles& files;
    SharedTasks& shared;
    std::size_t first;  // task that is to do
};

void make_picture(const Job& job, SceneRenderer& pictures, Worker& worker, std::size_t i) {
    const auto picture = std::make_shared<RenderedPicture>();
    picture->task = job.tasks[i];
    if (job.tasks.is_done(picture->task)) {
        return job.shared.deliver(i, [&job] { job.files.skip(); });
    }
    FrameRecord record = render_task(job.options, pictures, *picture);
    if (i == job.first) advise(pictures, record);
    if (!job.options.output.stats.empty()) pictures.fill_limits(record);
    ++worker.share.pictures;
    job.shared.deliver(i, [&job, picture, record = std::move(record)]() mutable {
        job.files.add(std::move(*picture), std::move(record));
    });
}

// Makes pictures until none is left, or this renderer fails.
void make_pictures(const Job& job, SceneRenderer& pictures, Worker& worker) {
    while (const std::optional<std::size_t> i = job.shared.take()) {
        check_interrupt();
        try {
            make_picture(job, pictures, worker, *i);
        } catch (...) {
            job.shared.give_back(*i);
            throw;
        }
    }
}

// Runs a worker; its failure is kept. `left`: workers that have not failed.
template <typename Run>
void run_worker(SharedTasks& shared, std::atomic<std::size_t>& left, Worker& worker,
                const Run& run) noexcept {
    try {
        run();
    } catch (const Interrupted&) {
        worker.failure = std::current_exception();
        shared.stop();
    } catch (const std::exception& error) {
        worker.failure = std::current_exception();
        worker.share.failure = error.what();
        if (--left == 0) return shared.stop();
        note(fmt::format("device {} is left out: {}", worker.share.device, error.what()));
    }
}

// Throws what ended the job before its last picture.
void require_done(const std::vector<Worker>& workers, SharedTasks& shared, std::size_t left) {
    shared.rethrow();
    for (const Worker& worker : workers) {
        const bool interrupted = worker.failure && worker.share.failure.empty();
        if (worker.failure && (interrupted || left == 0)) std::rethrow_exception(worker.failure);
    }
}

std::string device_text(const std::string& choice) {
    return fmt::format("{} ({})", choice, describe(choose_device(choice)).name);
}

}  // namespace

PictureTasks::PictureTasks(const RenderOptions& options) : options_(options) {
    const OutputOptions& out = options.output;
    if (out.frames) frames_.emplace(*out.frames, out.shard);
    has_video_ = out.skip_existing && is_video(out.output) &&
                 is_made(wanted_video(options.shared.settings, out, options.command));
}

PictureTask PictureTasks::operator[](std::size_t i) const {
    const OutputOptions& out = options_.output;
    const double time = options_.shared.time;
    if (!frames_) return {0, time, out.output, out.reference, out.difference};
    const int frame = (*frames_)[i];
    return {frame, time + frame / out.frames_per_second, frame_file(out.output, frame),
            frame_file(out.reference, frame), frame_file(out.difference, frame)};
}

bool PictureTasks::is_done(const PictureTask& task) const {
    if (is_video(task.file)) return has_video_;
    const RenderSettings& s = options_.shared.settings;
    return options_.output.skip_existing &&
           is_made({task.file, s.width, s.height, options_.command, noted_time(task.time)});
}

std::size_t PictureTasks::first_to_do() const {
    std::size_t i = 0;
    while (i < size() && is_done((*this)[i])) ++i;
    return i;
}
std::vector<std::string> render_devices(const std::string& choice, bool mixed) {
    std::vector<std::string> out;
    if (choice == "all") {
        const std::size_t count = all_devices().size();
        for (std::size_t i = 0; i < count; ++i) out.push_back(fmt::to_string(i));
    } else if (choice.find_first_not_of("0123456789,") == std::string::npos) {
        for (const std::string_view index : split(choice, ',')) out.emplace_back(index);
    }
    if (out.size() < 2) return {out.empty() || choice != "all" ? choice : out.front()};
    if (std::ranges::count(out, "") > 0)
        throw UsageError(fmt::format("--device {}: '' is no index", choice));
    const DeviceInfo first = describe(choose_device(out.front()));
    for (std::size_t i = 1; i < out.size(); ++i) {
        if (std::count(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(i), out[i]) > 0)
            throw UsageError(fmt::format("--device {}: {} is there twice", choice, out[i]));
        const DeviceInfo other = describe(choose_device(out[i]));
        const bool equal = other.name == first.name && other.platform == first.platform &&
                           other.driver == first.driver;
        if (equal || mixed) continue;
        throw UsageError(
            fmt::format("--device {}: {} ({}) and {} ({}) may differ in digits; "
                        "--mixed-devices allows that",
                        choice, out.front(), first.name, out[i], other.name));
    }
    return out;
}

MadePictures render_tasks(const RenderOptions& options, const PictureTasks& tasks,
                          SceneRenderer& pictures, const FirstPicture& start,
                          const std::vector<std::string>& more_devices) {
    const std::size_t first = tasks.first_to_do();
    PictureFiles files(options, tasks.size() - first, pictures.renderer());
    constexpr std::size_t kAhead = 2;  // pictures of each device that wait for an earlier one
    const std::size_t count = 1 + more_devices.size();
    SharedTasks shared(first, tasks.size(), kAhead * count);
    const Job job{options, tasks, files, shared, first};
    std::vector<Worker> workers(count);
    std::atomic<std::size_t> left = count;
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < count; ++i) {
        workers[i].share.device = device_text(more_devices[i - 1]);
        threads.emplace_back([&, i] {
            run_worker(shared, left, workers[i], [&] {
                SharedOptions own = options.shared;
                own.settings.device = more_devices[i - 1];
                SceneRenderer renderer(own, options.budget, start);
                make_pictures(job, renderer, workers[i]);
            });
        });
    }
    workers[0].share.device = device_text(options.shared.settings.device);
    run_worker(shared, left, workers[0], [&] { make_pictures(job, pictures, workers[0]); });
    threads.clear();  // waits for them
    require_done(workers, shared, left);
    MadePictures out{files.finish(), {}};
    for (Worker& worker : workers) {
        if (count > 1) out.shares.push_back(std::move(worker.share));
    }
    return out;
}

}  // namespace kilolux
