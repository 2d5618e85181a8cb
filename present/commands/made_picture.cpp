// SPDX-License-Identifier: Apache-2.0
#include "present/commands/made_picture.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "host/images/images.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

// Empty where the file lacks the note.
std::string note_of(const ImageLayout& layout, const std::string& name) {
    for (const auto& [attribute, value] : layout.attributes) {
        if (attribute == "kilolux:" + name) return std::get<std::string>(value);
    }
    return "";
}

[[noreturn]] void refuse(const WantedPicture& wanted, const std::string& what,
                         const std::string& seen, const std::string& asked) {
    throw Error(
        fmt::format("{}: holds another picture: its {} is '{}', asked for is '{}'; remove it, "
                    "name another --output, or leave --skip-existing out",
                    wanted.file.string(), what, seen, asked));
}

}  // namespace

std::string picture_command(const SharedOptions& shared, const OutputOptions& output) {
    std::string out = "kilolux render " + shell_word(shared.scene) + option_words(shared);
    if (output.half_colour) out += " --exr-half";
    if (output.uint_ids) out += " --aov-ids uint";
    if (output.bits != 8) out += fmt::format(" --bits {}", output.bits);
    if (output.turntable) out += fmt::format(" --turntable {}", *output.turntable);
    if (!output.camera_keys.empty()) {
        out += " --camera-keys " + shell_word(output.camera_keys.string());
    }
    return out;
}

bool is_made(const WantedPicture& wanted) {
    if (!std::filesystem::exists(wanted.file)) return false;
    std::unique_ptr<ImageReader> found;
    try {
        found = open_image(wanted.file);
    } catch (const Error& error) {
        note(fmt::format("{}; it is made anew", error.what()));
        return false;
    }
    const ImageLayout& layout = found->layout();
    const auto size = [](int width, int height) { return fmt::format("{}x{}", width, height); };
    if (layout.width != wanted.width || layout.height != wanted.height) {
        refuse(wanted, "size", size(layout.width, layout.height),
               size(wanted.width, wanted.height));
    }
    if (!holds_notes(wanted.file)) return true;
    const std::string command = note_of(layout, "command"), time = note_of(layout, "time");
    if (command != wanted.command) refuse(wanted, "command", command, wanted.command);
    if (time != wanted.time) refuse(wanted, "time", time, wanted.time);
    return true;
}

}  // namespace kilolux
