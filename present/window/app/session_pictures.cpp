// SPDX-License-Identifier: Apache-2.0
// Which picture the window wants, and what becomes of those that the worker makes.
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "present/window/app/session.h"

namespace kilolux {
namespace {

constexpr double kRestSeconds = 0.25;  // without a change until a picture is made in full

std::uint64_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    statm >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

bool same_camera(const Camera& a, const Camera& b) {
    return a.position == b.position && a.world_from_view == b.world_from_view &&
           a.y_fov == b.y_fov && a.orthographic == b.orthographic && a.y_extent == b.y_extent &&
           a.z_near == b.z_near && a.z_far == b.z_far;
}

// Whether two requests show the same, at whatever size and smoothness.
bool same_content(const PictureRequest& a, const PictureRequest& b) {
    RenderSettings resized = a.settings;
    resized.width = b.settings.width;
    resized.height = b.settings.height;
    resized.samples = b.settings.samples;
    return resized == b.settings && a.rig == b.rig && a.time == b.time &&
           same_camera(a.camera, b.camera);
}

bool same_request(const PictureRequest& a, const PictureRequest& b) {
    return same_content(a, b) && a.settings == b.settings;
}

bool has_all_samples(const PictureRequest& request) {
    return request.samples == 0 || request.samples >= request.settings.samples;
}

template <typename T>
bool is_ready(const std::future<T>& future) {
    return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

bool ViewSession::is_moving() const {
    return std::chrono::duration<double>(Clock::now() - last_change_).count() < kRestSeconds;
}

// Whether a task or a picture is under way; where pictures never end, they do not count.
bool ViewSession::is_busy() const {
    return limits_.valid() || probing_.valid() || freezing_.valid() || measuring_.valid() ||
           relighting_.valid() || !saving_.empty() || (!renders_always() && !pending_.empty());
}

// Whether the last picture is what the window wants, in full size, and no task is left.
Settled ViewSession::settled() const {
    if (state_.lights_move) return Settled::never;
    const bool shown =
        drawn_ && !is_moving() && same_request(*drawn_, wanted()) && has_all_samples(*drawn_);
    return shown && !is_busy() ? Settled::yes : Settled::not_yet;
}

// In the framebuffer, from its lower left.
BoxTarget ViewSession::picture_area() const {
    const auto size = window_.size();
    const auto pixels = window_.framebuffer();
    const double ratio = size[0] > 0 ? static_cast<double>(pixels[0]) / size[0] : 1.0;
    const int left = static_cast<int>(ratio * static_cast<double>(panel_width()));
    return {left, 0, std::max(pixels[0] - left, 0), pixels[1]};
}

// Whether the picture at rest gets more samples than one that moves. Probes and frozen clusters are
// those of the sample through the pixels' centres.
bool ViewSession::refines() const {
    return !renders_always() && state_.settings.want.view == ViewKind::lit && !state_.probe &&
           !state_.frozen;
}

PictureRequest ViewSession::wanted() const {
    PictureRequest out = wanted(state_.adaptive ? scale_.scale(is_moving()) : state_.fixed_scale);
    if (!renders_always() && (is_moving() || !refines())) out.settings.samples = 1;
    return out;
}

PictureRequest ViewSession::wanted(double scale) const {
    PictureRequest out;
    out.settings = state_.settings;
    const BoxTarget area = picture_area();
    out.settings.width = std::max(static_cast<int>(scale * area.width), kSmallestEdge);
    out.settings.height = std::max(static_cast<int>(scale * area.height), kSmallestEdge);
    if (state_.frozen) out.settings.want.aovs = {"depth"};
    out.camera = rig_.camera();
    out.time = time_;
    out.rig = lit_by_;
    return out;
}

void ViewSession::request_picture() {
    if (is_resting()) return;
    if (state_.rig != lit_by_ && !relighting_.valid()) relight();
    if (relighting_.valid()) return;  // its settings belong to the lights to come
    if (state_.lights_move) time_ += state_.light_speed * frame_seconds_;
    scale_.set_target(state_.target_ms);
    PictureRequest next = wanted();
    if (requested_ && !same_content(*requested_, next)) {
        last_change_ = Clock::now();
        next = wanted();
    }
    const bool again = renders_always() && pending_.empty();
    const bool same = requested_ && same_request(*requested_, next);
    if (refines() && next.settings.samples > 1) {
        next.samples = same ? requested_->samples + 1 : 1;
        // One sample after the other, each when the one before is on the screen.
        const bool comes = same && (!drawn_ || !same_request(*drawn_, next) ||
                                    drawn_->samples != requested_->samples);
        if (comes || next.samples > next.settings.samples) return;
    } else if (same && !again) {
        return;
    }
    const std::size_t pixels =
        display_stride(next.settings.width) * static_cast<std::size_t>(next.settings.height);
    const std::optional<std::size_t> slot = buffers_.acquire(pixels);
    if (!slot) return;
    next.pixels = buffers_.pixels(*slot);
    requested_ = next;
    pending_.push_back({*slot, next, worker_->render(next)});
}

// Returns false while the picture is being made.
bool ViewSession::take_picture(PendingPicture& pending) {
    if (!is_ready(pending.picture)) return false;
    redraw_soon();
    try {
        Picture picture = pending.picture.get();
        show_picture(pending, std::move(picture));
    } catch (const std::future_error&) {
        buffers_.release(pending.slot);  // a later request replaced it
    } catch (const std::exception& error) {
        buffers_.release(pending.slot);
        fail(error.what());
    }
    return true;
}

void ViewSession::show_picture(const PendingPicture& pending, Picture picture) {
    const RenderSettings& drawn = pending.request.settings;
    buffers_.show(pending.slot, drawn.width, drawn.height);
    if (shown_ == 0) {
        limits_ =
            worker_->ask([](Renderer& renderer) { return cached_device_limits(renderer.gpu()); });
    }
    const BoxTarget area = picture_area();
    facts_.scale = area.width > 0 ? static_cast<double>(drawn.width) / area.width : 1.0;
    facts_.width = drawn.width;
    facts_.height = drawn.height;
    facts_.samples = pending.request.samples > 0 ? pending.request.samples : drawn.samples;
    facts_.all_samples = drawn.samples;
    facts_.stats = picture.frame.stats;
    facts_.device = picture.device;
    facts_.plan = picture.plan;
    facts_.device_bytes = picture.device_bytes;
    facts_.process_bytes = resident_bytes();
    facts_.picture_way = buffers_.is_mapped() ? "persistent pixel buffer, written by the device"
                                              : "upload from host memory";
    facts_.history.add(picture.frame.stats, drawn.width * drawn.height);
    scale_.picture_took(picture.frame.stats.frame_ms, facts_.scale);
    if (boxes_ && !picture.frame.aovs.empty()) {
        boxes_->set_depths(picture.frame.aovs.front().values, drawn.width, drawn.height);
    }
    drawn_ = pending.request;
    ++shown_;
}

// The map is shown only while the window still wants the picture that was measured.
bool ViewSession::shows_error() const {
    return state_.error_map && error_map_ && error_of_ && same_content(*error_of_, wanted());
}

}  // namespace kilolux
