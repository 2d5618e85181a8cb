// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "host/base/error.h"

namespace kilolux {

/// The message of the `Wanted` error that `act` must throw; fails the test otherwise.
template <typename Wanted, typename Act>
std::string message_of(Act act) {
    try {
        act();
    } catch (const Wanted& error) {
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace kilolux
