// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "present/window/app/awaited.h"
#include "present/window/app/picture_queue.h"
#include "present/window/app/view_state.h"
#include "present/window/overlay/cluster_view.h"

namespace kilolux {

/// The picture in the window, for probing and freezing.
struct ShownPicture {
    const std::optional<PictureRequest>& displayed;  // none: no picture yet
    std::uint64_t number = 0;                        // of the picture
    ScreenPlace place;                               // window coordinates
    BoxTarget area;                                  // framebuffer
    std::optional<glm::dvec2> mouse;                 // window coordinates; none: not on the picture
    float scale = 1.0f;                              // of fonts
};

/// Drawn over the picture: the lists of the pixel under the mouse, and frozen clusters as boxes.
class ClusterOverlay {
 public:
    /// Asks the worker for data that the state shows and that is missing.
    void ask(RenderWorker& worker, const ViewState& state, const ShownPicture& picture);
    /// Takes the data. Switches the probe or the freeze off where it failed.
    void take(ViewState& state, const OnFailure& failed);
    /// Describes the overlay for Dear ImGui, which draws it in this frame.
    void describe(const ViewState& state, const ShownPicture& picture);

    /// Takes the depths of a new picture, which hide boxes.
    void take_depths(const Frame& frame);

    bool is_open() const { return probing_.is_open() || freezing_.is_open(); }
    std::size_t box_count() const { return boxes_ ? boxes_->box_count() : 0; }

 private:
    void ask_probe(RenderWorker& worker, const ShownPicture& picture);
    void describe_boxes(const ViewState& state, const ShownPicture& picture);
    void paint_boxes() const;

    Awaited<std::optional<ProbedPixel>> probing_;
    std::optional<ProbedPixel> probed_;
    std::array<std::int64_t, 3> probed_for_{-1, -1, -1};  // pixel, and number of the picture

    Awaited<FrozenClusters> freezing_;
    std::optional<FrozenClusters> frozen_;  // while the state says so
    std::unique_ptr<BoxPass> boxes_;        // made when first frozen
    int box_lights_ = -1;                   // that boxes_ were made for
    Camera box_camera_;                     // that the frame's boxes are drawn for
    BoxTarget box_area_;
};

}  // namespace kilolux
