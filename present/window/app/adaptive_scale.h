// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kilolux {

/// Chooses how many pixels of the window's are rendered, so that pictures keep coming.
///
/// While something moves, the edge of the picture shrinks or grows by steps of a tenth or so until
/// a picture takes no longer than the target, within a band that keeps it from flickering between
/// two steps. When nothing moves any more, the picture is made once at its full size.
class AdaptiveScale {
 public:
    static constexpr double kLeast = 0.125;

    explicit AdaptiveScale(double target_ms) : target_ms_(target_ms) {}

    void set_target(double target_ms) { target_ms_ = target_ms; }
    double target_ms() const { return target_ms_; }

    /// A picture of the moving scale took `ms` at scale `scale`.
    void picture_took(double ms, double scale);

    /// The scale for the next picture, 0..1: of each edge.
    double scale(bool moving) const { return moving ? moving_scale_ : 1.0; }

 private:
    double target_ms_;
    double moving_scale_ = 1.0;
};

}  // namespace kilolux
