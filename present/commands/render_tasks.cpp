// SPDX-License-Identifier: Apache-2.0
#include "present/commands/render_tasks.h"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/picture/frame_bands.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_values.h"
#include "present/commands/devices/picture_by_rows.h"
#include "present/commands/devices/shared_tasks.h"
#include "present/commands/picture_advice.h"
#include "present/commands/picture_strips.h"
#include "present/image/comparison.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

ImageNotes notes_of(const RenderOptions& options, const DeviceInfo& device, const Camera& camera,
                    const FrameRecord& record, const PictureTask& task) {
    ImageNotes notes = picture_notes(options.shared, device, record.stats);
    notes.strings.emplace_back("command", task.command);
    if (task.crop) notes.strings.emplace_back("crop", text_of(*task.crop));
    std::erase_if(notes.strings, [](const auto& entry) { return entry.first == "time"; });
    notes.strings.emplace_back("time", noted_time(record.time));
    if (record.comparison) {
        notes.strings.emplace_back("error", comparison_text(*record.comparison));
    }
    notes.camera = camera;
    return notes;
}

// Says where a layer is stored as the options did not ask for.
void note_layers(const RenderOptions& options, const Frame& frame, const fs::path& file) {
    for (const Layer& layer : frame.aovs) {
        if (options.output.encoding.uint_ids || float_holds(layer)) continue;
        note(fmt::format("{}: layer {} is UINT: a float does not hold its largest numbers",
                         file.string(), layer.name));
    }
}

// What a device failed with: another one may make the picture.
class DeviceFailure : public Error {
 public:
    using Error::Error;
};

template <typename Call>
auto on_device(const Call& call) {
    try {
        return call();
    } catch (const UsageError&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        throw DeviceFailure(error.what());
    }
}

// Makes the task's frame and alpha.
using MakeFrame = std::function<void(RenderedPicture&)>;

// Renders a task's picture; returns its record.
FrameRecord render_task(const RenderOptions& options, SceneRenderer& pictures,
                        RenderedPicture& picture, const MakeFrame& make) {
    const OutputOptions& out = options.output;
    const PictureTask& task = picture.task;
    std::optional<Reference> reference;
    if (!task.reference.empty()) {
        const auto [width, height] = written_size(pictures.renderer().settings(), task.crop);
        require_reference_size(task.reference, width, height);
        reference.emplace(task.reference);
    }
    make(picture);
    Frame& frame = picture.frame;
    check_interrupt();
    FrameRecord record{task.number, task.time, output_name(task.file), frame.stats, std::nullopt};
    if (reference) {
        record.comparison = reference->compare(frame, out.metric, out.threshold.value_or(0.0));
    }
    if (!task.difference.empty()) picture.difference = reference->difference(frame);
    if (options.shared.show_error) frame.display = reference->error_map(frame).rgba;
    note_layers(options, frame, task.file);
    picture.notes =
        notes_of(options, pictures.renderer().device(), pictures.camera(), record, task);
    return record;
}

void advise(SceneRenderer& pictures, const FrameRecord& record) {
    const std::string advice =
        picture_advice(pictures.scene().scene(), pictures.camera(), pictures.renderer().settings(),
                       record.stats, pictures.is_framed());
    if (!advice.empty()) note(record.file + ": " + advice);
}

// What the renderers of render_tasks() share.
struct Job {
    const RenderOptions& options;
    const PictureTasks& tasks;
    PictureFiles& files;
    SharedTasks& queue;
    std::size_t first;      // task that is to do
    bool measures_devices;  // for the limits of --stats: where one device is all there is
};

// Replaces the noted device by the kinds of these.
void note_devices(ImageNotes& notes, const std::vector<DeviceShare>& shares) {
    std::vector<std::string> kinds;
    for (const DeviceShare& share : shares) {
        const std::string kind = share.info.name + ", " + share.info.version;
        if (std::ranges::count(kinds, kind) == 0) kinds.push_back(kind);
    }
    for (auto& [name, value] : notes.strings) {
        if (name == "device") value = fmt::format("{}", fmt::join(kinds, "; "));
    }
}

// Makes strips by the renderer alone, which gets its settings back.
std::vector<DeviceShare> make_alone(StripsJob& job, Renderer& renderer) {
    const RenderSettings settings = renderer.settings();
    std::vector<DeviceShare> shares(1);
    on_device([&] {
        job.work(renderer, 0, shares.front());
        renderer.change(settings);
    });
    job.rethrow();
    return shares;
}

// Makes a task's picture strip by strip and writes it. Its file notes all devices that were asked
// for: the first strip is written before others are made. `shares` get what each did.
FrameRecord write_strips(const RenderOptions& options, SceneRenderer& pictures,
                         const PictureTask& task, DeviceHelpers* helpers,
                         std::vector<DeviceShare>& shares) {
    pictures.place(task.time, task.number);
    Renderer& renderer = pictures.renderer();
    FrameRecord record{task.number, task.time, output_name(task.file), {}, std::nullopt};
    // Called by any device's thread, while the renderer works.
    const auto notes = [&, device = renderer.device(),
                        camera = pictures.camera()](const RenderedPicture& first) {
        note_layers(options, first.frame, task.file);
        record.stats = first.frame.stats;
        ImageNotes out = notes_of(options, device, camera, record, task);
        if (helpers != nullptr) note_devices(out, helpers->shares());
        return out;
    };
    StripFile file(options, task, renderer.memory(), renderer.strips().size(), notes);
    StripsJob job(renderer, pictures.camera(), task.time, options.has_alpha,
                  helpers != nullptr ? helpers->shares().size() : 1,
                  [&file](RenderedPicture strip) { file.add(std::move(strip)); });
    shares = helpers != nullptr ? helpers->run(job, renderer) : make_alone(job, renderer);
    file.finish();
    std::vector<FrameStats> parts;
    for (const DeviceShare& share : shares) {
        if (share.rows > 0) parts.push_back(share.stats);
    }
    record.stats = joined(parts);
    return record;
}

void make_strips(const Job& job, SceneRenderer& pictures, DeviceShare& share, std::size_t i) {
    std::vector<DeviceShare> own;
    FrameRecord record = write_strips(job.options, pictures, job.tasks[i], nullptr, own);
    if (i == job.first) advise(pictures, record);
    if (job.measures_devices) pictures.fill_limits(record);
    ++share.finished;
    job.queue.deliver(i, [&job, record = std::move(record)]() mutable {
        job.files.add_written(std::move(record));
    });
}

void make_picture(const Job& job, SceneRenderer& pictures, DeviceShare& share, std::size_t i) {
    const auto picture = std::make_shared<RenderedPicture>();
    picture->task = job.tasks[i];
    if (job.tasks.is_done(picture->task)) {
        return job.queue.deliver(i, [&job] { job.files.skip(); });
    }
    if (!picture->task.crop && pictures.renderer().strips().size() > 1)
        return make_strips(job, pictures, share, i);
    FrameRecord record = render_task(job.options, pictures, *picture, [&](RenderedPicture& made) {
        const PictureTask& task = made.task;
        made.frame = on_device([&] { return pictures.render(task.time, task.number, task.crop); });
        made.spares = pictures.renderer().spare_frames();
        if (!job.options.has_alpha) return;
        made.alpha = on_device(
            [&] { return pictures.coverage(made.frame, task.time, task.number, task.crop); });
    });
    if (i == job.first) advise(pictures, record);
    if (job.measures_devices) pictures.fill_limits(record);
    ++share.finished;
    job.queue.deliver(i, [&job, picture, record = std::move(record)]() mutable {
        job.files.add(std::move(*picture), std::move(record));
    });
}

// Makes pictures until none is left, or the device fails, which throws.
void make_pictures(const Job& job, SceneRenderer& pictures, DeviceShare& share) {
    while (const std::optional<std::size_t> i = job.queue.take()) {
        try {
            check_interrupt();
            make_picture(job, pictures, share, *i);
        } catch (const DeviceFailure&) {
            job.queue.give_back(*i);
            throw;
        } catch (...) {
            return job.queue.fail(std::current_exception());
        }
    }
}

}  // namespace

MadePictures render_tasks(const RenderOptions& options, const PictureTasks& tasks,
                          std::size_t first, SceneRenderer& pictures, const FirstPicture& start,
                          const std::vector<std::string>& more_devices) {
    constexpr std::size_t kAhead = 2;  // pictures of each device that wait for an earlier one
    const std::size_t count = std::min(1 + more_devices.size(), tasks.size() - first);
    PictureFiles files(options, tasks.size() - first, pictures.renderer());
    SharedTasks queue(first, tasks.size(), kAhead * count);
    const bool has_stats = !options.output.stats.empty();
    const Job job{options, tasks, files, queue, first, has_stats && count == 1};
    std::vector<std::string> devices = more_devices;
    devices.insert(devices.begin(), options.shared.settings.device);
    devices.resize(count);
    std::vector<DeviceShare> shares(1);
    if (count > 1) shares = shares_of(devices);
    std::atomic<std::size_t> left = count;
    run_shares(shares, left, queue, [&](std::size_t i) {
        if (i == 0) return make_pictures(job, pictures, shares[0]);
        SharedOptions own = options.shared;
        own.settings.device = devices[i];
        SceneRenderer renderer(own, options.budget, start);
        make_pictures(job, renderer, shares[i]);
    });
    if (count == 1) shares.clear();
    return {files.finish(), std::move(shares)};
}

MadePictures render_with_helpers(const RenderOptions& options, const PictureTask& task,
                                 SceneRenderer& pictures, DeviceHelpers& helpers) {
    PictureFiles files(options, 1, pictures.renderer());
    MadePictures made;
    if (pictures.renderer().strips().size() > 1) {
        FrameRecord record = write_strips(options, pictures, task, &helpers, made.shares);
        advise(pictures, record);
        files.add_written(std::move(record));
        made.written = files.finish();
        return made;
    }
    RenderedPicture picture;
    picture.task = task;
    FrameRecord record = render_task(options, pictures, picture, [&](RenderedPicture& out) {
        PictureByRows by_rows =
            render_by_rows(helpers, pictures, options.has_alpha, task.time, task.number);
        out.frame = std::move(by_rows.frame);
        out.alpha = std::move(by_rows.alpha);
        made.shares = std::move(by_rows.shares);
    });
    std::vector<DeviceShare> makers = made.shares;
    std::erase_if(makers, [](const DeviceShare& share) { return share.rows == 0; });
    note_devices(picture.notes, makers);
    advise(pictures, record);
    files.add(std::move(picture), std::move(record));
    made.written = files.finish();
    return made;
}

}  // namespace kilolux
