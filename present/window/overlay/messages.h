// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "present/window/overlay/floating.h"

namespace kilolux {

/// What the window tells the user over the picture.
class Messages {
 public:
    /// A line that fades. `now`: seconds of one clock.
    void show(std::string text, double now) { notice_.show(std::move(text), now); }
    const Notice& notice() const { return notice_; }
    /// The last failure, until it is dismissed.
    void fail(std::string what) { failure_ = std::move(what); }
    void dismiss_failure() { failure_.clear(); }
    /// The keys, on request.
    void show_help(bool on) { shows_help_ = on; }
    bool shows_help() const { return shows_help_; }

    /// Takes the line about a picture that takes long; empty: none. Returns whether a line has
    /// changed or fades.
    bool update(std::string waiting, double now);
    const std::string& waiting() const { return waiting_; }

    /// Describes help and failure. Returns whether the failure was dismissed.
    bool describe(Widgets& ui, const ScreenPlace& place, float scale) const;

 private:
    Notice notice_;
    std::string failure_;  // empty: none
    std::string waiting_;
    bool shows_help_ = false;
};

}  // namespace kilolux
