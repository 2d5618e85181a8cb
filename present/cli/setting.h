// SPDX-License-Identifier: Apache-2.0
// An option with its value, its text and its effects. All code that loops over options reads this:
// the command line, config files, Python's keywords, the window's file, copied commands, the
// conditions of measurements, and the notes of pictures.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/text.h"

namespace kilolux {

/// What a value changes. Measurements are comparable only if all values that change time or picture
/// are equal.
enum class Changes { neither, time, picture };

struct Effect {
    Changes changes = Changes::neither;
    bool in_panel = false;  // the window sets it, too, and keeps it from one run to the next
};
inline constexpr Effect kNeither{Changes::neither};
inline constexpr Effect kTime{Changes::time};
inline constexpr Effect kPicture{Changes::picture};
inline constexpr Effect kPanelTime{Changes::time, true};
inline constexpr Effect kPanelPicture{Changes::picture, true};

/// The text of an option in --help.
struct OptionText {
    std::string name;            // "--lights", or "--output,-o"
    std::string form{};          // of the value: "N"; words in small letters between '|' are names
    std::string default_text{};  // in place of show()'s text; empty: that text
    std::string meaning{};
    Effect effect = kNeither;
    std::string unit{};  // of a number: "m", "px", "s"; "1" where it has none

    /// The meaning, and the unit in brackets.
    std::string described() const {
        return unit.empty() || unit == "1" ? meaning : meaning + " [" + unit + "]";
    }
};

/// How a value is written: `numbers` are separated by commas, as are the words of a `list`. What an
/// `input_file` holds is part of what its option says.
enum class SettingKind { text, flag, number, count, numbers, choice, list, input_file };

struct Setting {
    OptionText text;
    std::string heading;  // of --help
    SettingKind kind = SettingKind::text;
    std::vector<std::string> words{};  // that a choice or a list takes, or in place of a file

    /// Throws UsageError for a text that is no value.
    std::function<void(const std::string& text)> take{};

    /// The text from which `take` sets the present value; empty: the option was not given. For a
    /// flag it is "true" or empty.
    std::function<std::string()> show{};

    /// "--light-seed", or "SCENE".
    std::string option() const { return text.name.substr(0, text.name.find(',')); }

    /// Its name in files: "light-seed", "scene".
    std::string word() const {
        const std::string name = option();
        return name.starts_with("--") ? name.substr(2) : lower(name);
    }
};

using SettingVisitor = std::function<void(const Setting&)>;

/// The rows of visit_settings(options, visitor) as a list, which refers to `options`.
template <typename Options>
std::vector<Setting> settings_of(Options& options) {
    std::vector<Setting> out;
    visit_settings(options, [&out](const Setting& setting) { out.push_back(setting); });
    return out;
}

}  // namespace kilolux
