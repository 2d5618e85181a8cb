// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/app/adaptive_scale.h"
#include "present/window/app/picture_queue.h"
#include "present/window/app/scene_lights.h"
#include "present/window/app/steering.h"
#include "present/window/overlay/cluster_overlay.h"
#include "present/window/screen/window_frames.h"

namespace kilolux {

/// The pictures of the scene that the window wants and shows, and their place beside the panel.
class WindowPictures {
 public:
    /// Of the camera and lights at `time` [s]. `always`: also those that are shown already.
    WindowPictures(const ViewState& state, const WindowFrames& frames, const CameraRig& rig,
                   const SceneLights& lights, double time, bool always);

    float panel_width() const { return state_.show_panel ? frames_.gui().scaled(360.0f) : 0.0f; }
    ScreenPlace place() const;  // window coordinates
    ShownPicture shown() const;

    /// The picture that the state describes, and its whole size at every time.
    PictureRequest wanted() const;
    PictureRequest wanted_whole() const { return wanted(1.0); }

    void request(RenderWorker& worker);
    /// Passes finished pictures to `shown`, with the scale of their edges.
    void take(const std::function<void(const PictureRequest&, Picture, double)>& shown,
              const OnFailure& failed);

    /// Whether a picture is under way; where pictures never end, they do not count.
    bool are_busy() const { return !always() && queue_.is_busy(); }
    /// Whether the wanted one is shown in full size.
    bool are_complete() const { return !queue_.is_moving() && queue_.has_finished(wanted()); }
    PictureQueue& queue() { return queue_; }
    const PictureQueue& queue() const { return queue_; }

 private:
    static constexpr int kSmallestEdge = 16;  // [pixel] of a picture

    PictureRequest wanted(double scale) const;  // of the picture's edges
    BoxTarget area() const;                     // framebuffer, from its lower left
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
