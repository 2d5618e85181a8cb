// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "host/base/error.h"
#include "present/cli/setting.h"

namespace kilolux {

/// Texts of options whose values no rule below makes.
inline const std::map<std::string, std::string>& special_values() {
    static const std::map<std::string, std::string> values = {
        {"SCENE", "grid"},
        {"--clip", "none,walk"},
        {"--variant", "it's $red"},
        {"--line-width", "1%"},
        {"--resolution", "640,360"},
        {"--background", "0.5,0.25,0"},
        {"--environment", "sky"},
        {"--light-box", "-1,-2,-3,1,2,3"},
        {"--camera-index", "auto"},
        {"--camera-position", "1,2,3"},
        {"--camera-focal-point", "0,1,0.5"},
        {"--camera-view-up", "0,0,1"},
        {"--device", "pthread"},
        {"--max-memory", "1073741824"},
        {"--grid", "8,4,2"},
        {"--lanes", "2"},
        {"--light-groups", "key=lamp*,fill=kind:spot"},
        {"--light-mix", "rest=0.5:1,0.5,0.25"},
        {"--output", "a.exr"},
        {"--exr-compression", "zips"},
        {"--aov-ids", "uint"},
        {"--bits", "16"},
        {"--frames", "3:9"},
        {"--shard", "1/4"},
        {"--crop", "3,2,30,20"},
        {"--tiles", "2x3"},
        {"--stats", "-"},
        {"--ocio-view", "Film"},
        {"--ocio-display", "P3"},
        {"--ocio-input", "ACEScg"},
        {"--camera-keys", "my keys.json"},
        {"--reference", "r.exr"},
        {"--difference", "d.png"},
    };
    return values;
}

/// A text that is not the default of an option.
inline std::string other_value(const Setting& setting) {
    const auto special = special_values().find(setting.option());
    if (special != special_values().end()) return special->second;
    switch (setting.kind) {
        case SettingKind::flag:
            return "true";
        case SettingKind::number:
            return "0.75";
        case SettingKind::count:
            return "9";
        case SettingKind::list:
            return setting.words.at(0);
        case SettingKind::choice:
            return setting.words.at(setting.words.at(0) == setting.show() ? 1 : 0);
        default:
            throw Error(setting.option() + ": this test needs a value for it");
    }
}

}  // namespace kilolux
