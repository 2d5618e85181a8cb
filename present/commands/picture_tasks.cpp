// SPDX-License-Identifier: Apache-2.0
#include "present/commands/picture_tasks.h"

#include <fmt/format.h>

#include "present/cli/option_values.h"
#include "present/commands/made_picture.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// The command as a picture notes it: an automatic exposure is that of a sequence's first frame.
std::string noted_command(const RenderOptions& options, const std::string& command) {
    const auto& frames = options.output.frames;
    if (!options.shared.automatic_exposure || !frames) return command;
    return fmt::format("{} # exposed by frame {}", command, frames->first());
}

}  // namespace

std::string noted_time(double time) { return text_of(time) + " s"; }

PictureTasks::PictureTasks(const RenderOptions& options) : options_(options) {
    const OutputOptions& out = options.output;
    if (out.frames) numbers_.emplace(*out.frames, out.shard);
    if (out.tiles) {
        numbers_.emplace(FrameRange{0, static_cast<int>(options.tiles.size()) - 1}, out.shard);
    }
    has_video_ = out.skip_existing && is_video(out.output) && is_made(wanted_video(options));
}

PictureTask PictureTasks::operator[](std::size_t i) const {
    const OutputOptions& out = options_.output;
    const double time = options_.shared.time;
    PictureTask task{0,
                     time,
                     out.output,
                     out.reference,
                     out.difference,
                     out.crop,
                     noted_command(options_, options_.command)};
    if (!numbers_) return task;
    const int number = (*numbers_)[i];
    task.number = number;
    for (fs::path* file : {&task.file, &task.reference, &task.difference})
        *file = numbered_file(*file, number);
    if (out.tiles) {
        const PictureTile& tile = options_.tiles[static_cast<std::size_t>(number)];
        task.crop = tile.crop;
        task.command = tile.command;
    } else {
        task.time += number / out.frames_per_second;
    }
    return task;
}

bool PictureTasks::is_done(const PictureTask& task) const {
    if (is_video(task.file)) return has_video_;
    const auto [width, height] = written_size(options_.shared.settings, task.crop);
    return options_.output.skip_existing &&
           is_made({task.file, width, height, task.command, noted_time(task.time)});
}

std::size_t PictureTasks::first_to_do() const {
    std::size_t i = 0;
    while (i < size() && is_done((*this)[i])) ++i;
    return i;
}

}  // namespace kilolux
