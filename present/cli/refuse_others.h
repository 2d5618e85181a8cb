// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <set>
#include <string>

#include "host/base/error.h"

namespace kilolux {

/// If `option` is given: throws UsageError "<option>: <why>, so it does not go with <other>" for
/// the first other one, which would be ignored. Its companions are allowed, and so are options of
/// messages and of the configuration.
inline void refuse_others(const CLI::App& command, const std::string& option, const char* why,
                          std::set<std::string> companions = {}) {
    const CLI::Option* found = command.get_option_no_throw(option);
    if (found == nullptr || found->count() == 0) return;
    companions.insert({option, "--quiet", "--verbose", "--progress", "--config"});
    for (const CLI::Option* other : command.get_options()) {
        if (other->count() == 0 || companions.contains(other->get_name())) continue;
        throw UsageError(
            fmt::format("{}: {}, so it does not go with {}", option, why, other->get_name()));
    }
}

}  // namespace kilolux
