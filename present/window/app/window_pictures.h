// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/app/adaptive_scale.h"
#include "present/window/app/picture_queue.h"
#include "present/window/app/scene_lights.h"
#include "present/window/app/steering.h"
#include "present/window/overlay/cluster_overlay.h"
#include "present/window/panel/window_frames.h"

namespace kilolux {

/// The framebuffer's part [pixel] beside a panel. Sizes are the window's and the framebuffer's; the
/// panel's width is in window coordinates.
BoxTarget area_beside(float panel_width, std::array<int, 2> window, std::array<int, 2> framebuffer);

/// Requests pictures for the window and shows them, beside the panel.
class WindowPictures {
 public:
    /// `time`: of the first picture [s]. `always`: requests a picture again when it is shown
    /// already.
    WindowPictures(const ViewState& state, const WindowFrames& frames, const CameraRig& rig,
                   const SceneLights& lights, double time, bool always);

    float panel_width() const { return state_.show_panel ? frames_.gui().scaled(360.0f) : 0.0f; }
    ScreenPlace place() const;  // window coordinates
    ShownPicture shown_picture() const;

    /// A request for the picture that the state describes, with fewer pixels and samples while
    /// something moves.
    PictureRequest wanted() const;
    /// The same in full.
    PictureRequest wanted_whole() const { return wanted(1.0); }

    void request(RenderWorker& worker);
    /// Shows finished pictures and passes them to `finished`, with the scale of their edges.
    void take(const std::function<void(const PictureRequest&, Picture, double)>& finished,
              const OnFailure& failed);

    /// Whether a picture is under way; where pictures never end, they do not count.
    bool are_busy() const { return !always() && queue_.is_busy(); }
    /// Whether the wanted one is shown in full size.
    bool are_complete() const { return !queue_.is_moving() && queue_.has_finished(wanted()); }
    /// Whether they show the lights as the scene has them, or none will soon.
    bool show_lights() const {
        const auto& displayed = queue_.displayed();
        return !queue_.is_busy() || (displayed && displayed->lights == lights_.version());
    }
    PictureQueue& queue() { return queue_; }
    const PictureQueue& queue() const { return queue_; }

 private:
    static constexpr int kSmallestEdge = 16;  // [pixel] of a picture

    PictureRequest wanted(double scale) const;  // of the picture's edges
    BoxTarget area() const;
    bool always() const { return state_.continuous || always_; }
    bool refines() const;

    const ViewState& state_;
    const WindowFrames& frames_;
    const CameraRig& rig_;
    const SceneLights& lights_;
    double time_;
    bool always_;
    AdaptiveScale scale_;
    PictureQueue queue_;
};

}  // namespace kilolux
