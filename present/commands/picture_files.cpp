// SPDX-License-Identifier: Apache-2.0
#include "present/commands/picture_files.h"

#include <algorithm>
#include <new>

#include "host/base/system/atomic_write.h"
#include "present/cli/frame_summary.h"
#include "present/commands/made_picture.h"
#include "present/commands/picture_strips.h"
#include "present/image/display_picture.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// Display colours of the surfaces, without the black background that shows through them. Pixels
// that surfaces cover completely keep their codes.
std::vector<float> covered_colours(const RenderOptions& options, const Frame& frame,
                                   const std::vector<float>& alpha, std::vector<float> whole) {
    Frame covered;
    covered.width = frame.width;
    covered.height = frame.height;
    covered.radiance = frame.radiance;
    for (std::size_t i = 0; i < covered.radiance.size(); ++i) {
        if (alpha[i / 3] > 0.0f) covered.radiance[i] /= alpha[i / 3];
    }
    const std::vector<float> colours =
        display_colours(covered, options.shared.settings, options.output.ocio);
    if (whole.empty()) whole = display_codes(frame);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (alpha[i / 3] < 1.0f) whole[i] = colours[i];
    }
    return whole;
}

// Writes a temporary file beside `file`; the function returned renames it. So several files are
// written at once, and appear in their order. A pipe gets its bytes only from the function
// returned.
OrderedWriter::Write write_beside(const fs::path& file, std::vector<unsigned char> bytes) {
    if (is_special(file)) {
        return [file, bytes = std::move(bytes)] { write_atomically(file, bytes); };
    }
    const auto out = std::make_shared<AtomicFile>(file);
    out->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    begin_flush(out->descriptor());
    return [out] { out->commit(); };
}

// Codes a picture. The function returned puts it in its place, or appends it to the video.
OrderedWriter::Write coded(const RenderOptions& options, RenderedPicture& picture,
                           VideoFile* video) {
    const ImageOptions image = image_options(options, picture);
    const PictureTask& task = picture.task;
    OrderedWriter::Write write_difference = [] {};
    if (picture.difference) {
        write_difference =
            write_beside(task.difference, encode_image(task.difference, *picture.difference, {},
                                                       ImageOptions{options.output.encoding}));
    }
    if (video != nullptr) {
        if (!image.display.empty()) set_display(picture.frame, image.display);
        std::string bytes = video->spares().take();
        y4m_frame(picture.frame.display, bytes);
        return [video, write_difference, bytes = std::move(bytes)]() mutable {
            write_difference();
            video->write(bytes);
            video->spares().give(std::move(bytes));
        };
    }
    return [write_difference, write = write_beside(task.file, encode_image(task.file, picture.frame,
                                                                           picture.notes, image))] {
        write_difference();
        write();
    };
}

void count(WrittenPictures& made, FrameRecord record) {
    if (made.log) made.log->add(record);
    const bool failed = record.comparison && !record.comparison->passed();
    if (failed && made.first_failure.empty()) {
        made.first_failure = record.file + ": " + comparison_text(*record.comparison);
    }
    ++made.count;
    made.last = std::move(record);
}

// The video that is asked for; null if pictures are.
std::unique_ptr<VideoFile> open_video(const RenderOptions& options) {
    const OutputOptions& out = options.output;
    if (!is_video(out.output)) return nullptr;
    const WantedVideo wanted = wanted_video(options);
    return std::make_unique<VideoFile>(out.output, wanted.format, wanted.note);
}

// A single picture in strips shows the progress of its strips instead.
ProgressKind shown_progress(const RenderOptions& options, std::size_t count,
                            const Renderer& renderer) {
    const OutputOptions& out = options.output;
    const bool shows_strips =
        count == 1 && !out.crop && !out.tiles && !out.frames && renderer.strips().size() > 1;
    return shows_strips ? ProgressKind::none : options.shared.shown_progress();
}

// Of the largest part of the picture that has a file of its own; 0: the whole has one.
std::uint64_t crop_pixels(const OutputOptions& out, const RenderSettings& s) {
    const auto up = [](int pixels, int parts) {
        return static_cast<std::uint64_t>((pixels - 1) / parts + 1);
    };
    if (out.tiles) return up(s.width, out.tiles->columns) * up(s.height, out.tiles->rows);
    return out.crop ? up(out.crop->width, 1) * up(out.crop->height, 1) : 0;
}

std::size_t bytes_of(const Frame& frame) {
    std::size_t bytes = (frame.radiance.size() + frame.shown_light.size()) * sizeof(float);
    for (const Layer& layer : frame.aovs) {
        bytes += layer.values.size() * sizeof(float) + layer.ids.size() * sizeof(std::uint32_t);
    }
    return bytes + frame.display.size();
}

}  // namespace

RenderedPicture::~RenderedPicture() {
    if (!spares) return;
    frame.aovs.clear();
    try {
        spares->give(std::move(frame));
    } catch (const std::bad_alloc&) {  // it is freed instead
    }
}

// Makes the display colours that the renderer's display picture does not have: of 16 bits, by
// OpenColorIO, or of surfaces without background.
ImageOptions image_options(const RenderOptions& options, const RenderedPicture& picture) {
    const OutputOptions& out = options.output;
    const bool for_the_eye = is_for_the_eye(picture.task.file);
    ImageOptions image{out.encoding};
    image.alpha = picture.alpha;
    image.crop = picture.task.crop;
    image.full_width = options.shared.settings.width;
    image.full_height = options.shared.settings.height;
    if (for_the_eye && wants_own_display(options)) {
        RenderSettings settings = options.shared.settings;
        settings.background = options.shared.shown_background;
        image.display = options.shared.show_error
                            ? display_codes(picture.frame)
                            : display_colours(picture.frame, settings, out.ocio);
    }
    if (for_the_eye && options.has_alpha) {
        image.display =
            covered_colours(options, picture.frame, picture.alpha, std::move(image.display));
    }
    return image;
}

std::size_t most_held(const RenderedPicture& picture, std::size_t bytes) {
    constexpr std::size_t kCopies = 3;  // of its pixels while it is coded
    const std::size_t one = bytes_of(picture.frame) + picture.alpha.size() * sizeof(float) +
                            (picture.difference ? bytes_of(*picture.difference) : 0);
    return std::min<std::size_t>(2 * coding_threads(), bytes / (kCopies * one));
}

void visit_settings(RenderOptions& options, const SettingVisitor& visit) {
    visit_settings(options.shared, visit);
    visit_settings(options.output, visit);
    visit_settings(options.budget, visit);
}

bool is_for_the_eye(const fs::path& output) {
    return is_video(output) || image_meaning(output) == ImageMeaning::display;
}

bool wants_own_display(const RenderOptions& options) {
    return options.output.encoding.bits == 16 || uses_ocio(options.output.ocio);
}

FrameRequest request_of(const RenderOptions& options, const FrameRequest& asked) {
    const OutputOptions& out = options.output;
    const bool own_display = wants_own_display(options) || options.has_alpha;
    const bool for_the_eye = is_for_the_eye(out.output);
    FrameRequest want = asked;
    want.display = for_the_eye || !out.reference.empty();
    want.radiance = !for_the_eye || own_display || !out.reference.empty();
    want.shown_light = own_display;
    want.strip_makers = can_write_strips(options) || out.crop || out.tiles ? 1 : 0;
    want.crop_pixels = crop_pixels(out, options.shared.settings);
    want.counts =
        !out.stats.empty() || std::ranges::find(want.aovs, "light-count") != want.aovs.end();
    return want;
}

PictureFiles::PictureFiles(const RenderOptions& options, std::size_t count,
                           const Renderer& renderer)
    : options_(options),
      video_(open_video(options)),
      progress_("rendering", count, shown_progress(options, count, renderer)),
      memory_(renderer.memory()),
      count_(count) {
    const OutputOptions& out = options.output;
    if (!out.stats.empty() && (out.frames || out.tiles)) written_.log.emplace();
}

PictureFiles::~PictureFiles() {
    if (video_ && writer_) writer_->give_up();
}

void PictureFiles::add(RenderedPicture picture, FrameRecord record) {
    if (!writer_) writer_.emplace(count_ < 2 ? 0 : most_held(picture, memory_.held_bytes));
    const auto shared = std::make_shared<RenderedPicture>(std::move(picture));
    writer_->add([this, shared] { return coded(options_, *shared, video_.get()); });
    records_.push_back(std::move(record));
    count_written();
}

void PictureFiles::add_written(FrameRecord record) {
    while (writer_ && writer_->wait_for_next()) {
    }  // of earlier pictures
    count_written();
    count(written_, std::move(record));
    progress_.advance();
}

void PictureFiles::skip() {
    progress_.advance();
    count_written();
}

WrittenPictures PictureFiles::finish() {
    while (writer_ && writer_->wait_for_next()) count_written();
    count_written();
    if (video_) video_->commit();
    return std::move(written_);
}

void PictureFiles::count_written() {
    if (!writer_) return;
    for (const std::size_t written = writer_->written(); counted_ < written; ++counted_) {
        count(written_, std::move(records_.front()));
        records_.pop_front();
        progress_.advance();
    }
}

}  // namespace kilolux
