// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "present/window/app/view_state.h"

namespace kilolux {

/// $XDG_CONFIG_HOME/kilolux/view.json, else ~/.config/kilolux/view.json; empty when the environment
/// names neither (XDG Base Directory Specification: relative paths do not count).
std::filesystem::path view_state_file();

/// The window's settings from one run to the next. A value of the command line is not kept unless
/// it is changed in the window.
class StateFile {
 public:
    /// An empty name: nothing is read or written.
    explicit StateFile(std::filesystem::path file) : file_(std::move(file)) {}

    /// `state` with the file's values, except those whose option ("--lights") `is_given` on the
    /// command line. A file that cannot be read, or holds a value out of range, is ignored as a
    /// whole, with a warning.
    ViewState load(const ViewState& state, const std::function<bool(const std::string&)>& is_given);

    /// Keeps all values but the window's size from now on, as if set in the window.
    void forget();

    /// Writes the values that changed since load(), and for the others those of the file. Writes
    /// the whole file or nothing; makes its folder. Throws Error with the reason.
    void save(const ViewState& state);

    /// Call in every frame, at `now` [s]: saves a change that has lasted a moment, so that a crash
    /// does not lose it. A failure is a warning.
    void keep(const ViewState& state, double now);

 private:
    using Json = nlohmann::ordered_json;

    std::filesystem::path file_;
    Json kept_;               // without the command line
    Json started_;            // with it
    Json written_;            // the contents of the file
    ViewState seen_, saved_;  // of keep()
    double next_look_ = 0.0;  // [s]
};

}  // namespace kilolux
