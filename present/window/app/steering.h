// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/app/camera_rig.h"
#include "present/window/panel/window_frames.h"

namespace kilolux {

/// A frame's input, and which parts of it may move the camera.
struct SteeringInput {
    const InputState& input;
    bool has_keys = true;   // no text field takes them
    bool has_wheel = true;  // the mouse is on no panel
    bool drags = false;     // the mouse; the drag began on the picture
    int height = 1;         // of the window, window coordinates
};

/// What the input asks of the camera.
CameraInput camera_input(const SteeringInput& from, CameraMode mode);

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
