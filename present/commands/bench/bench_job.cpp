// SPDX-License-Identifier: Apache-2.0
// Pictures a second from the command to the file, beside the frames alone.
#include "present/commands/bench/bench_job.h"

#include <chrono>

#include "host/base/system/temporary_folder.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/bench/bench_sweep.h"
#include "present/commands/made_picture.h"
#include "present/commands/render_tasks.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

struct JobRow {
    SweepPoint point;
    std::string type;
    int pictures = 0;
    double start_s = 0.0;   // scene, kernels, the library of images
    double job_s = 0.0;     // pictures until the last file is there
    double frames_s = 0.0;  // the same frames, not coded
    double file_bytes = 0.0;

    double frame_rate() const { return pictures / frames_s; }
    double job_rate() const { return pictures / job_s; }
    double ratio() const { return frames_s / job_s; }
    double rate_from_command() const { return pictures / (start_s + job_s); }
    double picture_mebibytes() const { return file_bytes / pictures / (1 << 20); }
};

Table job_table(const std::vector<JobRow>& rows) {
    std::vector<Column<JobRow>> columns;
    for (const auto& [field, text] : fields_of(SweepPoint{})) {
        columns.push_back(
            {field, [name = field](const JobRow& row) { return field_text(row.point, name); }});
    }
    for (Column<JobRow> column : {Column<JobRow>{"job", &JobRow::type},
                                  {"pictures", &JobRow::pictures},
                                  {"frames/s alone", &JobRow::frame_rate},
                                  {"pictures/s", &JobRow::job_rate},
                                  {"ratio", &JobRow::ratio},
                                  {"start [s]", &JobRow::start_s},
                                  {"pictures/s with start", &JobRow::rate_from_command},
                                  {"MiB/picture", &JobRow::picture_mebibytes}}) {
        columns.push_back(std::move(column));
    }
    return make_table(columns, rows);
}

// Seconds that a call takes.
template <typename Call>
double seconds_of(const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The command `kilolux render` of a sequence, whose lights move.
RenderOptions job_options(const BenchOptions& bench, const JobRow& job, const fs::path& folder) {
    RenderOptions out;
    out.shared = bench.shared;
    out.shared.settings = settings_at(bench.shared.settings, job.point);
    out.budget = bench.budget;
    out.output.output = folder / ("job." + job.type);
    if (!is_video(out.output.output)) out.output.output = folder / ("job.####." + job.type);
    out.output.frames = FrameRange{0, job.pictures - 1};
    out.command = picture_command(out);
    return out;
}

double file_bytes_in(const fs::path& folder) {
    double bytes = 0.0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        bytes += static_cast<double>(entry.file_size());
    }
    return bytes;
}

// Measures `job`. `on_ready` gets what renders it.
template <typename OnReady>
void measure_job(const BenchOptions& bench, int warm_up, JobRow& job, const OnReady& on_ready) {
    const TemporaryFolder folder;
    RenderOptions options = job_options(bench, job, folder.path());
    const PictureTasks tasks(options);
    const FirstPicture start{request_of(options, options.shared.settings.want), tasks[0].time,
                             tasks[0].number};
    std::optional<SceneRenderer> pictures;
    job.start_s = seconds_of([&] {
        if (!is_video(options.output.output)) check_can_write_image(tasks[0].file);
        pictures.emplace(options.shared, options.budget, start);
    });
    on_ready(options.shared, *pictures);
    for (int i = 0; i < warm_up; ++i) pictures->render(options.shared.time);
    job.job_s = seconds_of([&] { render_tasks(options, tasks, 0, *pictures, start, {}); });
    job.file_bytes = file_bytes_in(folder.path());
    const auto frames = pictures->renderer().spare_frames();
    job.frames_s = seconds_of([&] {
        for (std::size_t i = 0; i < tasks.size(); ++i) {
            frames->give(pictures->render(tasks[i].time, tasks[i].number));
        }
    });
}

}  // namespace

void run_jobs(BenchOptions& options) {
    constexpr int kWarmUp = 2;
    const BenchFrames frames{options.warm_up.value_or(kWarmUp),
                             options.frames.value_or(kJobPictures), BenchMotion::lights};
    nlohmann::ordered_json context;
    std::vector<JobRow> rows;
    for (const SweepPoint& point : bench_points(options)) {
        for (const std::string& type : options.jobs) {
            JobRow& row = rows.emplace_back(JobRow{point, type, frames.measured});
            measure_job(options, frames.warm_up, row,
                        [&](const SharedOptions& shared, SceneRenderer& pictures) {
                            if (!context.empty()) return;
                            context =
                                bench_context(shared, frames, pictures.scene().scene(),
                                              pictures.camera(), pictures.renderer().device());
                        });
        }
    }
    put_table(options, "job", job_table(rows), context);
}

}  // namespace kilolux
