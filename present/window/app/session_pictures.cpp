// SPDX-License-Identifier: Apache-2.0
// Chooses the picture that the window wants, and reports on those of the worker.
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "present/window/app/session.h"

namespace kilolux {
namespace {

std::uint64_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    statm >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

ScreenPlace ViewSession::place() const {
    const auto size = window_.size();
    return {panel_width(), 0.0f, static_cast<float>(size[0]), static_cast<float>(size[1])};
}

BoxTarget ViewSession::area() const {
    const auto size = window_.size();
    const auto pixels = window_.framebuffer();
    const double ratio = size[0] > 0 ? static_cast<double>(pixels[0]) / size[0] : 1.0;
    const int left = static_cast<int>(ratio * static_cast<double>(panel_width()));
    return {left, 0, std::max(pixels[0] - left, 0), pixels[1]};
}

ShownPicture ViewSession::shown_picture() {
    const ScreenPlace at = place();
    const glm::dvec2 mouse(input_.mouse().x, input_.mouse().y);
    const bool inside = mouse.x >= at.x0 && mouse.x < at.x1 && mouse.y >= at.y0 && mouse.y < at.y1;
    const bool is_on_picture = inside && !gui_.wants_mouse();
    return {pictures_.displayed(),
            pictures_.shown(),
            at,
            area(),
            is_on_picture ? std::optional(mouse) : std::nullopt,
            gui_.scaled(1.0f)};
}

// Whether the picture at rest gets more samples than a moving one. Probes and frozen clusters need
// the sample through the pixels' centres alone.
bool ViewSession::refines() const {
    return !renders_always() && state_.settings.want.view == ViewKind::lit && !state_.probe &&
           !state_.frozen;
}

PictureRequest ViewSession::wanted() const {
    const bool moves = pictures_.is_moving();
    PictureRequest out = wanted(state_.adaptive ? scale_.scale(moves) : state_.fixed_scale);
    if (!renders_always() && (moves || !refines())) out.settings.samples = 1;
    return out;
}

PictureRequest ViewSession::wanted(double scale) const {
    PictureRequest out;
    out.settings = lights_.settings_of(state_);
    const BoxTarget target = area();
    out.settings.width = std::max(static_cast<int>(scale * target.width), kSmallestEdge);
    out.settings.height = std::max(static_cast<int>(scale * target.height), kSmallestEdge);
    if (state_.frozen) out.settings.want.aovs = {"depth"};
    out.camera = rig_.camera();
    out.time = time_;
    out.rig = lights_.rig();
    return out;
}

void ViewSession::request_picture() {
    if (is_resting()) return;
    if (!lights_.fit(state_) && !lights_.are_changing()) {
        lights_.replace(*worker_, state_, wanted().settings);
    }
    if (lights_.are_changing()) return;  // its settings belong to lights that are not there yet
    if (state_.lights_move) time_ += state_.light_speed * clock_.frame_seconds();
    scale_.set_target(state_.target_ms);
    PictureRequest next = wanted();
    if (pictures_.note_change(next)) next = wanted();
    pictures_.request(*worker_, std::move(next), {refines(), renders_always()});
}

void ViewSession::take_picture(const PictureRequest& request, Picture picture) {
    if (pictures_.shown() == 1) {
        limits_ = Awaited(
            worker_->ask([](Renderer& renderer) { return cached_device_limits(renderer.gpu()); }));
    }
    const int width = area().width;
    const FrameStats& stats = picture.frame.stats;
    facts_.history.add(stats, facts_.displayed == request.settings);
    facts_.displayed = request.settings;
    facts_.scale = width > 0 ? static_cast<double>(request.settings.width) / width : 1.0;
    facts_.samples = request.samples > 0 ? request.samples : request.settings.samples;
    scale_.picture_took(stats.frame_ms, facts_.scale);
    facts_.stats = stats;
    facts_.device = picture.device;
    facts_.plan = picture.plan;
    facts_.device_bytes = picture.device_bytes;
    facts_.process_bytes = resident_bytes();
    clusters_.take_depths(picture.frame);
}

}  // namespace kilolux
