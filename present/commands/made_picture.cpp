// SPDX-License-Identifier: Apache-2.0
#include "present/commands/made_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "host/images/images.h"
#include "present/cli/conditions.h"
#include "present/image/display_picture.h"
#include "present/image/image_file.h"
#include "present/video/read_video.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

// Refuses a file whose `what` is not the one that was asked for.
void expect(const std::filesystem::path& file, const char* what, const std::string& seen,
            const std::string& asked) {
    if (seen == asked) return;
    throw Error(fmt::format(
        "{}: holds another {}: its {} is '{}', but '{}' is asked for; remove it, choose another "
        "--output, or leave out --skip-existing",
        file.string(), is_video(file) ? "video" : "picture", what, seen, asked));
}

// Without its newline.
std::string without_end(std::string line) {
    line.pop_back();
    return line;
}

std::string size_text(int width, int height) { return fmt::format("{}x{}", width, height); }

// What `read` finds in the file; none with a warning, which is printed once, where it cannot be
// read.
template <typename Read>
auto read_made(const std::filesystem::path& file, const Read& read)
    -> std::optional<decltype(read(file))> {
    if (!std::filesystem::exists(file)) return std::nullopt;
    try {
        return read(file);
    } catch (const Error& error) {
        warn(fmt::format("{}; it is made anew", error.what()));
        return std::nullopt;
    }
}

}  // namespace

std::string picture_command(const RenderOptions& options) {
    RenderOptions noted = options, defaults;
    std::string out = "kilolux render " + shell_word(options.shared.scene) +
                      option_words(settings_of(noted), settings_of(defaults), Changes::picture);
    std::ranges::replace(out, '\n', ' ');  // a note is one line
    return out;
}

std::string inputs_comment(const RenderOptions& options) {
    RenderOptions noted = options;
    std::vector<std::filesystem::path> more;
    if (uses_ocio(options.output.ocio)) more.emplace_back(ocio_config());
    const std::string content = input_content(options.shared, settings_of(noted), more);
    return content.empty() ? "" : " # input files " + content;
}

bool is_made(const WantedPicture& wanted) {
    const auto found = read_made(wanted.file, [](const std::filesystem::path& file) {
        auto image = open_image(file);
        image->check_end();
        return image;
    });
    if (!found) return false;
    const ImageLayout& layout = (*found)->layout();
    expect(wanted.file, "size", size_text(layout.width, layout.height),
           size_text(wanted.width, wanted.height));
    const auto noted = [&](const char* name) { return note_in(wanted.file, layout, name); };
    expect(wanted.file, "command", noted("command"), wanted.command);
    expect(wanted.file, "time", noted("time"), wanted.time);
    return true;
}

WantedVideo wanted_video(const RenderOptions& options) {
    const RenderSettings& settings = options.shared.settings;
    const OutputOptions& out = options.output;
    const auto [width, height] = written_size(settings, out.crop);
    return {.file = out.output,
            .format = {width, height, out.frames_per_second},
            .frames = out.frames ? out.frames->size() : 1,
            .note = options.command};
}

bool is_made(const WantedVideo& wanted) {
    const std::filesystem::path& file = wanted.file;
    if (std::filesystem::exists(file)) check_can_read_video(file);
    const auto found = read_made(file, read_video);
    if (!found) return false;
    expect(file, "size", size_text(found->width, found->height),
           size_text(wanted.format.width, wanted.format.height));
    // Notes of other types than .y4m say how many frames there are.
    bool is_whole = found->is_whole;
    if (is_y4m(file)) {
        const auto text = [](std::uint64_t frames) { return std::to_string(frames); };
        if (is_whole) expect(file, "number of frames", text(found->frames), text(wanted.frames));
        expect(file, "header", without_end(found->header),
               without_end(y4m_header(wanted.format, wanted.note)));
    } else {
        expect(file, "command", found->note, wanted.note);
        is_whole = found->frames == wanted.frames;
    }
    if (!is_whole) {
        note(fmt::format("{}: does not hold {} whole frames; it is made anew", file.string(),
                         wanted.frames));
    }
    return is_whole;
}

}  // namespace kilolux
