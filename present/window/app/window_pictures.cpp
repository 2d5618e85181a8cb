// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/window_pictures.h"

#include <algorithm>
#include <utility>

namespace kilolux {

BoxTarget area_beside(float panel_width, std::array<int, 2> window,
                      std::array<int, 2> framebuffer) {
    const double ratio = window[0] > 0 ? static_cast<double>(framebuffer[0]) / window[0] : 1.0;
    const int left = static_cast<int>(ratio * static_cast<double>(panel_width));
    return {left, 0, std::max(framebuffer[0] - left, 0), framebuffer[1]};
}

WindowPictures::WindowPictures(const ViewState& state, const WindowFrames& frames,
                               const CameraRig& rig, const SceneLights& lights, double time,
                               bool always)
    : state_(state),
      frames_(frames),
      rig_(rig),
      lights_(lights),
      time_(time),
      always_(always),
      scale_(state.target_ms) {}

ScreenPlace WindowPictures::place() const {
    const auto size = frames_.screen().size();
    return {panel_width(), 0.0f, static_cast<float>(size[0]), static_cast<float>(size[1])};
}

BoxTarget WindowPictures::area() const {
    return area_beside(panel_width(), frames_.screen().size(), frames_.screen().framebuffer());
}

ShownPicture WindowPictures::shown_picture() const {
    const ScreenPlace at = place();
    const glm::dvec2 mouse(frames_.input().mouse().x, frames_.input().mouse().y);
    const bool inside = mouse.x >= at.x0 && mouse.x < at.x1 && mouse.y >= at.y0 && mouse.y < at.y1;
    const bool is_on_picture = inside && !frames_.gui().wants_mouse();
    return {queue_.displayed(),
            queue_.shown_count(),
            at,
            area(),
            is_on_picture ? std::optional(mouse) : std::nullopt,
            frames_.gui().scaled(1.0f)};
}

// Whether the picture at rest gets more samples than a moving one. Probes and frozen clusters need
// the sample through the pixels' centres alone.
bool WindowPictures::refines() const {
    return !always() && state_.settings.want.view == ViewKind::lit && !state_.probe &&
           !state_.frozen;
}

PictureRequest WindowPictures::wanted() const {
    const bool moves = queue_.is_moving();
    PictureRequest out = wanted(state_.adaptive ? scale_.scale(moves) : state_.fixed_scale);
    if (!always() && (moves || !refines())) out.settings.samples = 1;
    return out;
}

PictureRequest WindowPictures::wanted(double scale) const {
    PictureRequest out;
    out.settings = lights_.settings_of(state_);
    const BoxTarget target = area();
    out.settings.width = std::max(static_cast<int>(scale * target.width), kSmallestEdge);
    out.settings.height = std::max(static_cast<int>(scale * target.height), kSmallestEdge);
    if (state_.frozen) out.settings.want.aovs = {"depth"};
    out.camera = rig_.camera();
    out.time = time_;
    out.lights = lights_.version();
    return out;
}

void WindowPictures::request(RenderWorker& worker) {
    if (state_.lights_move) time_ += state_.light_speed * frames_.clock().frame_seconds();
    scale_.set_target(state_.target_ms);
    PictureRequest next = wanted();
    if (queue_.note_change(next)) next = wanted();
    queue_.request(worker, std::move(next), {refines(), always()});
}

void WindowPictures::take(
    const std::function<void(const PictureRequest&, Picture, double)>& finished,
    const OnFailure& failed) {
    const auto scale_of = [this](const PictureRequest& request, int without_area) {
        const int width = area().width;
        return width > 0 ? static_cast<double>(request.settings.width) / width : without_area;
    };
    queue_.take({[&](const PictureRequest& request, Picture picture) {
                     const double scale = scale_of(request, 1);
                     scale_.picture_took(picture.frame.stats.frame_ms, scale);
                     finished(request, std::move(picture), scale);
                 },
                 [&](const PictureRequest& request, double seconds) {
                     scale_.picture_would_take(1e3 * seconds,
                                               scale_of(request, request.settings.width));
                 },
                 failed});
}

}  // namespace kilolux
