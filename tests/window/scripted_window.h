// SPDX-License-Identifier: Apache-2.0
// Sessions of `kilolux view` that a script plays, under Xvfb, and the pictures they leave.
#pragma once

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/paths.h"
#include "tests/window/desktop.h"

namespace kilolux {

namespace fs = std::filesystem;

inline constexpr int kPanel = 360;     // [pixel] of the window are the panel's
inline constexpr int kUnderlay = 120;  // [pixel] from the top: the overlay ends above

using Variables = std::vector<std::string>;  // "NAME=value"; "-uNAME" takes one away

/// Runs the program in the virtual display of this test program, or with other options of
/// with_display (`display`) in a display of its own.
inline ChildResult view_in_display(const Variables& variables,
                                   const std::vector<std::string>& arguments,
                                   const std::vector<std::string>& display = {}) {
    std::vector<std::string> words = {"/usr/bin/env"};
    words.insert(words.end(), variables.begin(), variables.end());
    if (display.empty()) {
        static const Desktop shared({});
        words.push_back(shared.variable());  // after env's options
    } else {
        words.emplace_back(source_root() + "/tests/window/with_display");
        words.insert(words.end(), display.begin(), display.end());
    }
    words.emplace_back(program_file());
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_child(words);
}

/// A program with sanitizers asks to be loaded before the recorder; this option waives that.
inline std::string recorder_asan_options() {
    const char* given = std::getenv("ASAN_OPTIONS");
    return std::string("ASAN_OPTIONS=") + (given == nullptr ? "" : given) +
           ":verify_asan_link_order=0";
}

/// A window with default state, small enough for any machine.
inline std::vector<std::string> small_window(const std::string& script) {
    return {"view",    "plain",     "--fresh", "--resolution", "700,420", "--lights", "150",
            "--quiet", "--samples", "1",       "--script",     script};
}

/// The part of a picture that shows the scene.
struct ScenePart {
    int width = 0, height = 0;  // of the window [pixel]
    std::vector<float> values;
};

inline ScenePart scene_part(const fs::path& file, int left = kPanel) {
    const FloatImage image = read_image(file);
    ScenePart out{image.width, image.height, {}};
    const std::size_t channels = image.channels.size();
    for (int y = kUnderlay; y < image.height; ++y) {
        for (int x = left; x < image.width; ++x) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x);
            for (std::size_t c = 0; c < 3; ++c) {
                out.values.push_back(image.values[pixel * channels + c]);
            }
        }
    }
    return out;
}

/// The picture that the command line renders with these options to `file`, in the part of a window
/// of 700 x 420 pixels that shows the scene.
inline ScenePart rendered(const fs::path& file, std::vector<std::string> options,
                          const std::string& scene = "plain") {
    static_assert(700 - kPanel == 340);
    std::vector<std::string> words = {"render",  scene, "-q",         "--resolution",
                                      "340,420", "-o",  file.string()};
    words.insert(words.end(), options.begin(), options.end());
    const ChildResult result = run_kilolux(words);
    EXPECT_EQ(result.code, 0) << result.err;
    ScenePart out = scene_part(file, 0);
    out.width += kPanel;
    return out;
}

inline double mean_of(const ScenePart& a) {
    double sum = 0.0;
    for (const float v : a.values) sum += static_cast<double>(v);
    return sum / static_cast<double>(a.values.size());
}

inline double mean_difference(const ScenePart& a, const ScenePart& b) {
    EXPECT_EQ(a.values.size(), b.values.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < std::min(a.values.size(), b.values.size()); ++i) {
        sum += std::abs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]));
    }
    return sum / static_cast<double>(a.values.size());
}

/// Pixels of a screenshot's rectangle that differ from another one, and how many of them are nearly
/// white.
struct PixelChanges {
    int changed = 0, white = 0;
};

/// `place`: left, top, width, height [pixel].
inline PixelChanges changes(const fs::path& before, const fs::path& after,
                            const std::array<int, 4>& place) {
    const FloatImage a = read_image(before), b = read_image(after);
    const std::size_t channels = a.channels.size();
    PixelChanges out;
    for (int y = place[1]; y < place[1] + place[3]; ++y) {
        for (int x = place[0]; x < place[0] + place[2]; ++x) {
            const std::size_t at = channels * static_cast<std::size_t>(y * a.width + x);
            const auto is = [&](const FloatImage& image) {
                return std::array{image.values[at], image.values[at + 1], image.values[at + 2]};
            };
            const auto colour = is(b);
            if (colour == is(a)) continue;
            ++out.changed;
            out.white += *std::min_element(colour.begin(), colour.end()) > 0.7f;
        }
    }
    return out;
}

/// A script and the pictures that it saves, in a folder.
class Script {
 public:
    explicit Script(const TemporaryFolder& folder) : folder_(folder) {}
    Script& line(const std::string& text) {
        text_ += text + "\n";
        return *this;
    }
    Script& shot(const std::string& name) {
        return line("settle").line("screenshot " + (folder_ / (name + ".png")).string());
    }
    std::string write() const {
        write_text(folder_ / "script", text_);
        return (folder_ / "script").string();
    }

 private:
    const TemporaryFolder& folder_;
    std::string text_;
};

/// Plays a session and expects that neither OpenGL, OpenCL nor the program complains: an error
/// during a script ends it with a message.
inline void play(const Script& script) {
    const ChildResult result = view_in_display({}, small_window(script.write()));
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    EXPECT_EQ(result.err, "");
}

}  // namespace kilolux
