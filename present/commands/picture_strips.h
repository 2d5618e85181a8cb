// SPDX-License-Identifier: Apache-2.0
// Pictures that are made and written strip by strip: see MemoryPlan::strip_rows.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "present/cli/progress.h"
#include "present/commands/devices/device_helpers.h"
#include "present/commands/devices/shared_tasks.h"
#include "present/commands/picture_files.h"
#include "present/commands/scene_renderer.h"
#include "present/image/ordered_writer.h"

namespace kilolux {

/// Whether the file can be written strip by strip (some formats seek, which pipes cannot), and no
/// reference needs the whole picture.
bool can_write_strips(const RenderOptions& options);

/// Makes the strips of a picture, on one device or several: a free device takes the next one.
class StripsJob : public DeviceJob {
 public:
    /// The picture of `renderer` at `time` [s]; with alpha where that is asked for. `take` gets the
    /// strips from the top down, one at a time, maybe in another thread.
    StripsJob(const Renderer& renderer, const Camera& camera, double time, bool has_alpha,
              std::size_t devices, std::function<void(RenderedPicture)> take);

    void work(Renderer& renderer, std::size_t device, DeviceShare& share) override;
    void fail(std::exception_ptr failure) override;
    void rethrow() override;

 private:
    RenderedPicture make(Renderer& renderer, Band rows) const;

    const RenderSettings settings_;  // but for the device
    const Camera camera_;
    const double time_;
    const bool has_alpha_;
    const std::vector<Band> strips_;
    const std::function<void(RenderedPicture)> take_;
    SharedTasks queue_;
};

/// A picture on its way to its file, while strips below are made. Without finish() there is no
/// file. Functions are called by one thread at a time.
class StripFile {
 public:
    /// `notes` are asked for once, with the counts of the first strip. `strips`: how many there
    /// are; shown as progress unless the picture is one of many. The options must outlive this.
    StripFile(const RenderOptions& options, const PictureTask& task, const MemoryPlan& memory,
              std::size_t strips, std::function<ImageNotes(const RenderedPicture&)> notes);
    /// What is not coded yet is dropped.
    ~StripFile();

    /// Takes the next strip. Throws Error where it or an earlier one cannot be coded or written.
    void add(RenderedPicture strip);

    /// Waits until all are written. Throws as add().
    void finish();

 private:
    const RenderOptions& options_;
    PictureTask task_;
    std::size_t held_bytes_;
    Progress progress_;
    std::function<ImageNotes(const RenderedPicture&)> notes_of_;
    std::shared_ptr<const ImageNotes> notes_;  // from the first strip on
    ImageStream file_;
    std::optional<OrderedWriter> writer_;  // likewise; goes before the file
};

}  // namespace kilolux
