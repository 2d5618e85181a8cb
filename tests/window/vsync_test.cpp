// SPDX-License-Identifier: Apache-2.0
// Waiting for the screen's refresh, by the calls of GLFW.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/paths.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

// The swap intervals that a session asks for, in their order, with "first swap" between.
std::vector<std::string> intervals(const TemporaryFolder& folder, const std::string& lines) {
    const fs::path record = folder / "record";
    fs::remove(record);
    const std::string script = Script(folder).line("open window").line(lines).write();
    const ChildResult result = run_child(
        {source_root() + "/tests/window/with_display", "/usr/bin/env", recorder_asan_options(),
         "LD_PRELOAD=" KILOLUX_GLFW_RECORDER, "KILOLUX_GLFW_RECORD=" + record.string(),
         "XDG_CONFIG_HOME=" + folder.path().string(), program_file(), "view", "plain", "-q",
         "--lights", "100", "--resolution", "700,420", "--script", script});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    std::vector<std::string> out;
    bool swapped = false;
    std::istringstream text(text_of_file(record));
    for (std::string line; std::getline(text, line);) {
        if (line.rfind("interval", 0) == 0) out.push_back(line);
        if (line == "swap" && !swapped) {
            swapped = true;
            out.emplace_back("first swap");
        }
    }
    return out;
}

TEST(Vsync, IsSetWhenItIsToggledAndKept) {
    const TemporaryFolder folder;
    using Calls = std::vector<std::string>;
    const std::string twice = "click vsync\nframes 3\nclick vsync\nframes 3";
    EXPECT_EQ(intervals(folder, twice + "\nclick vsync\nframes 3"),
              (Calls{"interval 1", "first swap", "interval 0", "interval 1", "interval 0"}));
    const auto kept = nlohmann::json::parse(text_of_file(folder / "kilolux" / "view.json"));
    EXPECT_EQ(kept.at("vsync"), false);
    EXPECT_EQ(intervals(folder, twice),
              (Calls{"interval 0", "first swap", "interval 1", "interval 0"}));
}

}  // namespace
}  // namespace kilolux
