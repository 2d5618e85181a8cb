// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

/// Chooses how many of the window's pixels are rendered.
///
/// While something moves, the picture's edges shrink or grow by steps of an eighth until a picture
/// takes no longer than the target; a margin prevents changes to and fro. At rest it is full size.
class AdaptiveScale {
 public:
    static constexpr double kLeast = 0.125;

    explicit AdaptiveScale(double target_ms) : target_ms_(target_ms) {}

    void set_target(double target_ms) { target_ms_ = target_ms; }
    double target_ms() const { return target_ms_; }

    /// Notes that a picture of the moving scale took `ms` at scale `scale`. The first at a scale
    /// does not count: it makes surfaces, which later ones reuse while the camera stands.
    void picture_took(double ms, double scale);

    /// Notes that a cancelled picture of scale `scale` would have taken `ms`.
    void picture_would_take(double ms, double scale);

    /// The scale of the next picture's edges, 0..1.
    double scale(bool moving) const { return moving ? moving_scale_ : 1.0; }

 private:
    void choose(double ms, double scale, double most_steps);

    double target_ms_;
    double moving_scale_ = 1.0;
    double last_scale_ = 0.0;  // of picture_took()
};

}  // namespace kilolux
