// SPDX-License-Identifier: Apache-2.0
#include "tests/window/desktop.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>
#include <stdexcept>

#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

std::vector<std::string> display_words(const std::vector<std::string>& options,
                                       const fs::path& folder) {
    std::vector<std::string> words = {source_root() + "/tests/window/with_display", "--file",
                                      folder.string()};
    words.insert(words.end(), options.begin(), options.end());
    const std::string name = (folder / "name").string();
    for (const char* word : {"sh", "-c"}) words.emplace_back(word);
    words.push_back("echo \"$DISPLAY\" >" + name + ".new; mv " + name + ".new " + name +
                    "; exec cat >/dev/null");
    return words;
}

std::vector<std::string> viewer_words(const Desktop& desktop, const fs::path& folder,
                                      const std::vector<std::string>& more) {
    std::vector<std::string> words = {program_file(), "view",    "plain",    "--fresh", "--quiet",
                                      "--resolution", "560,330", "--lights", "100"};
    words.insert(words.end(), more.begin(), more.end());
    return with_variables(
        {desktop.variable(), "KILOLUX_GLFW_RECORD=" + (folder / "record").string(),
         "LD_PRELOAD=" KILOLUX_GLFW_RECORDER, recorder_asan_options()},
        words);
}

// XWD of 32 bits a pixel: a header of big-endian words, colours, rows.
struct Xwd {
    std::string bytes;
    std::size_t word(std::size_t index) const {
        std::size_t out = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            out = 256 * out + static_cast<unsigned char>(bytes.at(4 * index + i));
        }
        return out;
    }
    std::size_t width() const { return word(4); }
    std::size_t height() const { return word(5); }
    std::size_t row_bytes() const { return word(12); }
    std::size_t first() const { return word(0) + 12 * word(19); }
};

Xwd read_xwd(const fs::path& file) {
    Xwd out{text_of_file(file)};
    // Version, format (Z), least significant byte first, bits a pixel.
    if (out.word(1) != 7 || out.word(2) != 2 || out.word(7) != 0 || out.word(11) != 32) {
        throw std::runtime_error(file.string() + ": not the XWD file that is expected");
    }
    return out;
}

}  // namespace

std::size_t count_colours(const Seen& seen) {
    std::set<std::array<std::uint8_t, 3>> colours;
    for (std::size_t i = 0; i + 2 < seen.rgb.size(); i += 3) {
        colours.insert({seen.rgb[i], seen.rgb[i + 1], seen.rgb[i + 2]});
    }
    return colours.size();
}

Desktop::Desktop(const std::vector<std::string>& options)
    : display_(display_words(options, folder_.path())) {
    wait_for("a virtual display", [this] {
        if (display_.has_ended()) throw std::runtime_error(display_.result().err);
        return fs::exists(folder_ / "name");
    });
    std::string name;
    std::istringstream(text_of_file(folder_ / "name")) >> name;
    variable_ = "DISPLAY=" + name;
}

bool Desktop::try_tool(const std::vector<std::string>& words, std::string& out) const {
    const ChildResult result = run_child(with_variables({variable_}, words));
    if (result.code == 127) {
        throw std::runtime_error(words[0] + " is not installed; tests/run installs it");
    }
    out = result.code == 0 ? result.out : result.err;
    return result.code == 0;
}

std::string Desktop::tool(const std::vector<std::string>& words) const {
    std::string out;
    if (!try_tool(words, out)) throw std::runtime_error(words[0] + " " + words[1] + ": " + out);
    return out;
}

Place Desktop::place() const {
    const Xwd xwd = read_xwd(folder_ / "Xvfb_screen0");
    return {0, 0, static_cast<int>(xwd.width()), static_cast<int>(xwd.height())};
}

Seen Desktop::see(const Place& part) const {
    const Xwd xwd = read_xwd(folder_ / "Xvfb_screen0");
    const auto width = static_cast<int>(xwd.width()), height = static_cast<int>(xwd.height());
    Seen out{part.width, part.height, {}};
    for (int y = part.y; y < part.y + part.height; ++y) {
        for (int x = part.x; x < part.x + part.width; ++x) {
            const bool inside = x >= 0 && x < width && y >= 0 && y < height;
            const std::size_t at = xwd.first() + static_cast<std::size_t>(y) * xwd.row_bytes() +
                                   4 * static_cast<std::size_t>(x);
            for (const std::size_t channel : {2u, 1u, 0u}) {
                const char value = inside ? xwd.bytes.at(at + channel) : '\0';
                out.rgb.push_back(static_cast<std::uint8_t>(value));
            }
        }
    }
    return out;
}

Viewer::Viewer(const Desktop& desktop, const std::vector<std::string>& more)
    : desktop_(desktop), program_(viewer_words(desktop, folder_.path(), more)) {
    wait_for("the window", [this] {
        if (program_.has_ended()) throw std::runtime_error(program_.result().err);
        std::string id;
        const bool found =
            desktop_.try_tool({"xdotool", "search", "--onlyvisible", "--name", "^Kilolux - "}, id);
        if (found) std::istringstream(id) >> window_;
        return found;
    });
}

void Viewer::key(const std::string& name) const { desktop_.tool({"xdotool", "key", name}); }

Place Viewer::place() const {
    const std::string text = desktop_.tool({"xwininfo", "-id", window_});
    const auto number_after = [&text](const std::string& label) {
        const std::size_t at = text.find(label);
        if (at == std::string::npos) throw std::runtime_error("no '" + label + "' in:\n" + text);
        return std::stoi(text.substr(at + label.size()));
    };
    return {number_after("Absolute upper-left X:"), number_after("Absolute upper-left Y:"),
            number_after("Width:"), number_after("Height:")};
}

bool Viewer::is_minimised() const {
    return desktop_.tool({"xprop", "-id", window_, "WM_STATE"}).find("Iconic") != std::string::npos;
}

void Viewer::minimise() const {
    desktop_.tool({"xdotool", "windowminimize", window_});
    wait_for("the window is minimised", [this] { return is_minimised(); });
}

void Viewer::activate() const {
    desktop_.tool({"xdotool", "windowactivate", "--sync", window_});
    wait_for("the focus", [this] { return has_focus(); });
}

bool Viewer::has_focus() const {
    std::string focus;
    std::istringstream(desktop_.tool({"xdotool", "getwindowfocus"})) >> focus;
    return focus == window_;
}

Place Viewer::picture() const {
    const Place all = place();
    return {all.x + kPanel, all.y + kUnderlay, all.width - kPanel, all.height - kUnderlay};
}

void Viewer::wait_for_rest() const {
    const auto before = static_cast<std::ptrdiff_t>(record().size());
    wait_for("rest", [&] {
        const std::vector<std::string> calls = record();
        int waits = 0;
        for (auto call = calls.rbegin(); call != calls.rend() - before && waits < 4; ++call) {
            if (*call == "swap") continue;
            if (*call != "wait 0.250") return false;
            ++waits;
        }
        return waits == 4;
    });
}

Seen Viewer::final_picture() const {
    Seen out;
    wait_for("a settled picture", [&] {
        wait_for_rest();
        out = desktop_.see(picture());
        return count_colours(out) > 100;
    });
    return out;
}

void Viewer::wait_for_picture(const Seen& wanted) const {
    wait_for("the picture that was", [&] { return final_picture() == wanted; });
}

void Viewer::wait_for_change() const {
    const Seen before = desktop_.see(picture());
    wait_for("another picture", [&] { return desktop_.see(picture()) != before; });
}

std::vector<std::string> Viewer::record() const {
    std::istringstream text(text_of_file(folder_ / "record"));
    std::vector<std::string> out;
    for (std::string line; std::getline(text, line);) out.push_back(line);
    return out;
}

std::size_t Viewer::count(const std::string& call) const {
    const std::vector<std::string> calls = record();
    return static_cast<std::size_t>(std::count(calls.begin(), calls.end(), call));
}

}  // namespace kilolux
