// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/app/camera_rig.h"
#include "present/window/screen/window_frames.h"

namespace kilolux {

/// Moves the camera by keys that are held, drags and the wheel.
class Steering {
 public:
    /// `grabs`: the screen's edges do not stop the mouse that turns a flying camera.
    Steering(CameraRig rig, const WindowFrames& frames, bool grabs)
        : rig_(std::move(rig)), frames_(frames), grabs_(grabs) {}

    /// Moves the camera by the input of this frame.
    void steer(CameraMode mode);

    /// Whether the input of this frame moves the camera.
    bool is_moving(CameraMode mode) const { return motion(mode).any(); }

    CameraRig& rig() { return rig_; }
    const CameraRig& rig() const { return rig_; }

 private:
    CameraInput motion(CameraMode mode) const;

    CameraRig rig_;
    const WindowFrames& frames_;
    bool grabs_;
    bool dragging_ = false;  // the mouse, begun on the picture
};

}  // namespace kilolux
