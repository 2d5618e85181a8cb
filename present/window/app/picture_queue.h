// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>

#include "present/window/app/awaited.h"
#include "present/window/app/picture_buffers.h"
#include "present/window/app/render_worker.h"

namespace kilolux {

/// Whether two requests show the same, of any size and number of samples.
bool same_content(const PictureRequest& a, const PictureRequest& b);
bool same_request(const PictureRequest& a, const PictureRequest& b);

/// Pictures from the request to the texture that shows the newest.
class PictureQueue {
 public:
    /// A picture that takes longer is cancelled when another is wanted [s].
    static constexpr double kSlowSeconds = 0.5;

    struct Policy {
        bool refines = false;  // one sample after the other, each once the last one is shown
        bool again = false;    // also what is shown already
    };

    /// Asks for `next`, unless it is under way or shown. Cancels slow pictures of anything else.
    void request(RenderWorker& worker, PictureRequest next, const Policy& policy);

    /// Shows finished pictures and passes them to `finished`. `given_up` receives cancelled ones
    /// that were begun, with the time that they would have taken [s].
    struct Receiver {
        std::function<void(const PictureRequest&, Picture)> finished;
        std::function<void(const PictureRequest&, double)> given_up;
        OnFailure failed;
    };
    void take(const Receiver& receiver);

    /// Notes that `next` is wanted. Returns whether its content differs from that of the last one.
    bool note_change(const PictureRequest& next);
    /// Whether the wanted content has changed within the last moment.
    bool is_moving() const;

    /// Makes the next request anew, since the renderer has made something else in between.
    void forget_request() { requested_.reset(); }

    bool is_busy() const { return !pending_.empty(); }
    /// Whether a request for `next` is shown with all its samples.
    bool has_finished(const PictureRequest& next) const;
    const std::optional<PictureRequest>& displayed() const { return displayed_; }  // on the screen
    std::uint64_t shown_count() const { return shown_count_; }                     // pictures
    const PictureBuffers& buffers() const { return buffers_; }

    /// The progress of the picture that is being made; null: none is.
    const PictureProgress* progress() const;

 private:
    struct Pending {
        std::size_t slot = 0;  // of buffers_
        PictureRequest request;
        std::future<Picture> picture;
    };
    void give_up_others(const PictureRequest& next);
    bool take_one(Pending& pending, const Receiver& receiver);

    PictureBuffers buffers_;
    std::deque<Pending> pending_;
    std::optional<PictureRequest> requested_;  // the last
    std::optional<PictureRequest> displayed_;
    std::uint64_t shown_count_ = 0;
    std::chrono::steady_clock::time_point last_change_;
};

}  // namespace kilolux
