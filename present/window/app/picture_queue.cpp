// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/picture_queue.h"

#include <algorithm>
#include <utility>

#include "host/base/error.h"

namespace kilolux {
namespace {

constexpr double kRestSeconds = 0.25;  // without a change before a picture is made in full

bool has_all_samples(const PictureRequest& request) {
    return request.samples == 0 || request.samples >= request.settings.samples;
}

template <typename T>
bool is_ready(const std::future<T>& future) {
    return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

bool same_content(const PictureRequest& a, const PictureRequest& b) {
    RenderSettings resized = a.settings;
    resized.width = b.settings.width;
    resized.height = b.settings.height;
    resized.samples = b.settings.samples;
    return resized == b.settings && a.lights == b.lights && a.time == b.time &&
           a.camera == b.camera;
}

bool same_request(const PictureRequest& a, const PictureRequest& b) {
    return same_content(a, b) && a.settings == b.settings;
}

bool PictureQueue::note_change(const PictureRequest& next) {
    if (!requested_ || same_content(*requested_, next)) return false;
    last_change_ = std::chrono::steady_clock::now();
    return true;
}

bool PictureQueue::is_moving() const {
    const std::chrono::duration<double> rest = std::chrono::steady_clock::now() - last_change_;
    return rest.count() < kRestSeconds;
}

bool PictureQueue::has_finished(const PictureRequest& next) const {
    return displayed_ && same_request(*displayed_, next) && has_all_samples(*displayed_);
}

const PictureProgress* PictureQueue::progress() const {
    return pending_.empty() ? nullptr : pending_.front().request.progress.get();
}

void PictureQueue::give_up_others(const PictureRequest& next) {
    for (const Pending& pending : pending_) {
        if (pending.request.progress->estimate() > kSlowSeconds &&
            !same_content(pending.request, next)) {
            pending.request.progress->give_up();
        }
    }
}

void PictureQueue::request(RenderWorker& worker, PictureRequest next, const Policy& policy) {
    give_up_others(next);
    const bool same = requested_ && same_request(*requested_, next);
    if (policy.refines && next.settings.samples > 1) {
        next.samples = same ? requested_->samples + 1 : 1;
        const bool comes = same && (!displayed_ || !same_request(*displayed_, next) ||
                                    displayed_->samples != requested_->samples);
        if (comes || next.samples > next.settings.samples) return;
    } else if (same && !(policy.again && pending_.empty())) {
        return;
    }
    const std::size_t pixels =
        display_stride(next.settings.width) * static_cast<std::size_t>(next.settings.height);
    const std::optional<std::size_t> slot = buffers_.acquire(pixels);
    if (!slot) return;
    next.pixels = buffers_.pixels(*slot);
    next.progress = std::make_shared<PictureProgress>();
    requested_ = next;
    pending_.push_back({*slot, next, worker.render(next)});
}

void PictureQueue::take(const Receiver& receiver) {
    std::erase_if(pending_, [&](Pending& pending) { return take_one(pending, receiver); });
}

// Returns false while the picture is being made.
bool PictureQueue::take_one(Pending& pending, const Receiver& receiver) {
    if (!is_ready(pending.picture)) return false;
    try {
        Picture picture = pending.picture.get();
        buffers_.show(pending.slot, pending.request.settings.width,
                      pending.request.settings.height);
        displayed_ = pending.request;
        ++shown_count_;
        receiver.finished(pending.request, std::move(picture));
        return true;
    } catch (const std::future_error&) {
        // A later request replaced it.
    } catch (const Interrupted&) {
        receiver.given_up(pending.request, pending.request.progress->estimate());
    } catch (const std::exception& error) {
        receiver.failed(error.what());
    }
    buffers_.release(pending.slot);
    return true;
}

}  // namespace kilolux
