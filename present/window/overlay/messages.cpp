// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/messages.h"

#include <utility>

namespace kilolux {

bool Messages::update(std::string waiting, double now) {
    const bool fades = notice_.fade(now);
    std::swap(waiting_, waiting);
    return waiting_ != waiting || fades;
}

bool Messages::describe(Widgets& ui, const ScreenPlace& place, float scale) const {
    if (shows_help_) describe_help(place, scale);
    return describe_failure(ui, failure_, place, scale);
}

}  // namespace kilolux
