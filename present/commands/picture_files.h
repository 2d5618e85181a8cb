// SPDX-License-Identifier: Apache-2.0
// From rendered pictures of `kilolux render` to their files.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/base/spares.h"
#include "host/render/renderer.h"
#include "present/cli/options.h"
#include "present/cli/output_options.h"
#include "present/cli/progress.h"
#include "present/cli/stats_json.h"
#include "present/commands/error_budget_options.h"
#include "present/image/image_file.h"
#include "present/image/ordered_writer.h"
#include "present/video/video_file.h"

namespace kilolux {

/// A tile, and RenderOptions::command of it as a crop.
struct PictureTile {
    PixelRect crop;
    std::string command;
    bool operator==(const PictureTile&) const = default;
};

struct RenderOptions {
    SharedOptions shared;
    OutputOptions output;
    BudgetOptions budget;
    bool has_alpha = false;  // the picture: see wants_alpha()
    std::string command{};   // picture_command() of what was asked for, and inputs_comment()
    std::vector<PictureTile> tiles{};  // of output.tiles
    bool operator==(const RenderOptions&) const = default;
};

void visit_settings(RenderOptions& options, const SettingVisitor& visit);

/// One picture to make: a frame of the sequence, a tile, or the only one.
struct PictureTask {
    int number = 0;     // of the frame or tile
    double time = 0.0;  // [s]
    std::filesystem::path file;
    std::filesystem::path reference;   // empty: none
    std::filesystem::path difference;  // empty: none
    std::optional<PixelRect> crop{};   // none: the whole picture
    std::string command{};             // that makes it: RenderOptions::command
};

/// A picture that is rendered, until it is written. Then its frame goes to the spares.
struct RenderedPicture {
    RenderedPicture() = default;
    RenderedPicture(RenderedPicture&&) = default;
    RenderedPicture& operator=(RenderedPicture&&) = default;
    ~RenderedPicture();

    PictureTask task;
    Frame frame;
    ImageNotes notes;
    std::vector<float> alpha;               // empty: it has none
    std::optional<Frame> difference;        // to the reference
    std::shared_ptr<Spares<Frame>> spares;  // of its renderer; null: none
};

/// A summary of the pictures written so far.
struct WrittenPictures {
    std::size_t count = 0;
    FrameRecord last;
    std::string first_failure;  // of a comparison; empty: none
    std::optional<FrameLog> log;
};

/// Whether the output holds display colours.
bool is_for_the_eye(const std::filesystem::path& output);

/// Whether display colours are made on the host, of 16 bits or by OpenColorIO.
bool wants_own_display(const RenderOptions& options);

/// How the picture is stored, with the parts that its frame lacks: display colours of 16 bits or by
/// OpenColorIO, and alpha.
ImageOptions image_options(const RenderOptions& options, const RenderedPicture& picture);

/// How many pictures like this one fit into `bytes` until they are written, at most two for each of
/// oneTBB's threads: while one is coded the next one waits.
std::size_t most_held(const RenderedPicture& picture, std::size_t bytes);

/// The results that files and the comparison need beside those that are asked for. Counting useful
/// evaluations takes a pass of its own.
FrameRequest request_of(const RenderOptions& options, const FrameRequest& asked);

/// Pictures on their way to their files: an OrderedWriter codes and writes them while the next ones
/// are made.
class PictureFiles {
 public:
    /// `count`: pictures left, those that are there already included. Holds at most two pictures a
    /// thread, and MemoryPlan::held_bytes. Throws Error when a video cannot be made. The options
    /// and the renderer must outlive this.
    PictureFiles(const RenderOptions& options, std::size_t count, const Renderer& renderer);
    /// Writes the pictures that it holds; of a video, which is of no use then, none.
    ~PictureFiles();

    /// Takes a picture. Throws Error where it or an earlier one cannot be coded or written.
    void add(RenderedPicture picture, FrameRecord record);

    /// Counts a picture that is written.
    void add_written(FrameRecord record);

    /// Counts a picture that was there already.
    void skip();

    /// Waits until all are written. Throws as add().
    WrittenPictures finish();

 private:
    void count_written();

    const RenderOptions& options_;
    std::unique_ptr<VideoFile> video_;  // null for pictures
    WrittenPictures written_;
    std::deque<FrameRecord> records_;  // of pictures that are not written
    std::size_t counted_ = 0;          // pictures of the writer
    Progress progress_;
    MemoryPlan memory_;
    std::size_t count_;                    // of pictures
    std::optional<OrderedWriter> writer_;  // from the first picture on; goes before the video
};

}  // namespace kilolux
