// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/base/spares.h"
#include "host/picture/frame_reader.h"
#include "host/render/lit_band.h"
#include "host/render/render_context.h"
#include "host/render/whole_picture.h"
#include "host/stages/picture/tonemap.h"

namespace kilolux {

/// Where a frame's display picture goes in place of Frame::display: the caller's memory, see
/// Renderer::render_to(); none where it is empty.
using DisplayMemory = std::span<uint>;

/// From radiance to the pictures on the host: stages over the whole picture, tone mapping, reading
/// back.
class PictureOutput {
 public:
    explicit PictureOutput(const RenderContext& context);

    /// Takes over other settings. Throws Error.
    void set(const RenderSettings& settings);

    /// Gives the frame's pictures room for these rows. `by_rows`: stages over the whole picture
    /// read the light of a picture that is made by rows from Frame::radiance.
    void resize(Frame& frame, Band rows, bool shown_only, bool by_rows) const;

    /// Begins a frame that has its size.
    void begin(DisplayMemory memory, Frame& frame, bool by_rows);

    /// Where shading puts the band's display picture.
    DisplayTarget target(const View& view);

    /// band.shown: the light after the stages over the whole picture. Where these are on, only the
    /// last band has it, that of all bands, and rows have none. Enqueues only.
    void bloom(LitBand& band, StageTimer& timer);

    /// The same of all rows of a picture that is made by rows. Blocks.
    void bloom_rows(const Frame& frame, LitBand& band, StageTimer& timer);

    /// band.display: the display picture of band.shown, where it is wanted. Enqueues only.
    void tonemap(LitBand& band, StageTimer& timer);

    /// Enqueues the reads that the frame wants of the band.
    void read(const LitBand& band, Frame& frame, StageTimer& timer);

    /// Waits for the reads, which fill the frame. Adds their time to the frame's stages.
    void finish(StageTimer& timer, FrameStats& stats);

    /// See Renderer::display_memory().
    DisplayMemory display_memory();

    /// See Renderer::spare_frames().
    std::shared_ptr<Spares<Frame>> spares() const { return spares_; }

 private:
    bool is_written_by_device() const { return context_.gpu.info.is_cpu && !memory_.empty(); }
    bool waits_for_bands() const {
        return needs_whole_picture(context_.settings) && (by_rows_ || !context_.is_whole());
    }
    Radiance whole_light();
    void keep(const Radiance& light);
    void read_light(const Radiance& light, std::vector<float>& to, StageTimer& timer);
    void read_display(const DisplayTarget& display, StageTimer& timer);
    View in_frame(View view) const;

    const RenderContext& context_;
    WholePictureStages stages_;
    int tone_curve_;
    Tonemap tonemap_;
    Backdrop backdrop_;
    GrowingArray<float> whole_light_;  // of all bands, where a stage mixes them
    FrameReader reader_;
    std::shared_ptr<Spares<Frame>> spares_ = std::make_shared<Spares<Frame>>();
    PinnedMemory shown_;            // display_memory() of a device with memory of its own
    std::vector<uint> host_shown_;  // else
    // Of the frame.
    DisplayMemory memory_;
    std::span<uint> display_;  // Frame::display
    bool by_rows_ = false;
    uint first_row_ = 0;  // Frame::first_row
};

}  // namespace kilolux
