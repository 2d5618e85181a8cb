// SPDX-License-Identifier: Apache-2.0
#include "present/commands/picture_strips.h"

#include <algorithm>
#include <utility>

namespace kilolux {

bool can_write_strips(const RenderOptions& options) {
    const OutputOptions& out = options.output;
    return !is_video(out.output) && can_stream(out.output) && !is_special(out.output) &&
           out.reference.empty();
}

StripsJob::StripsJob(const Renderer& renderer, const Camera& camera, double time, bool has_alpha,
                     std::size_t devices, std::function<void(RenderedPicture)> take)
    : settings_(renderer.settings()),
      camera_(camera),
      time_(time),
      has_alpha_(has_alpha),
      strips_(renderer.strips()),
      take_(std::move(take)),
      queue_(0, strips_.size(), 2 * devices) {}

void StripsJob::work(Renderer& renderer, std::size_t, DeviceShare& share) {
    while (const std::optional<std::size_t> i = queue_.take()) {
        const auto strip = std::make_shared<RenderedPicture>();
        try {
            *strip = make(renderer, strips_[*i]);
        } catch (...) {
            queue_.give_back(*i);
            throw;
        }
        count_rows(share, strips_[*i], strip->frame.stats);
        queue_.deliver(*i, [this, strip] { take_(std::move(*strip)); });
    }
}

RenderedPicture StripsJob::make(Renderer& renderer, Band rows) const {
    RenderedPicture out;
    take_settings(renderer, settings_);
    out.frame = renderer.render_strip(camera_, time_, rows);
    out.spares = renderer.spare_frames();
    if (!has_alpha_) return out;
    take_settings(renderer, before_white(settings_));
    out.alpha = coverage_of(out.frame, renderer.render_strip(camera_, time_, rows));
    return out;
}

void StripsJob::fail(std::exception_ptr failure) { queue_.fail(std::move(failure)); }

void StripsJob::rethrow() { queue_.rethrow(); }

StripFile::StripFile(const RenderOptions& options, const PictureTask& task,
                     const MemoryPlan& memory, std::size_t strips,
                     std::function<ImageNotes(const RenderedPicture&)> notes)
    : options_(options),
      task_(task),
      held_bytes_(memory.held_bytes),
      progress_("strips", strips,
                options.output.frames ? ProgressKind::none : options.shared.shown_progress()),
      notes_of_(std::move(notes)),
      file_(task.file) {}

StripFile::~StripFile() {
    if (writer_) writer_->give_up();
}

void StripFile::add(RenderedPicture strip) {
    constexpr std::size_t kPlanned = 2;  // are coded or wait, for which plan_memory() has room
    if (!writer_) {
        notes_ = std::make_shared<const ImageNotes>(notes_of_(strip));
        writer_.emplace(kPlanned + most_held(strip, held_bytes_));
    }
    strip.task = task_;
    strip.notes = *notes_;
    const auto held = std::make_shared<const RenderedPicture>(std::move(strip));
    const int height = options_.shared.settings.height;
    writer_->add([this, held, height] {
        auto rows = std::make_shared<const FileRows>(file_rows(
            held->task.file, height, held->frame, held->notes, image_options(options_, *held)));
        return [this, held, rows = std::move(rows)] { file_.write(*rows); };
    });
    progress_.advance();
}

void StripFile::finish() {
    while (writer_->wait_for_next()) {
    }
    file_.commit();
}

}  // namespace kilolux
