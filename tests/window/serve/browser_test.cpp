// SPDX-License-Identifier: Apache-2.0
// The page in Debian's Chromium, driven by tests/window/browser/drive.mjs.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/npm.h"
#include "tests/window/serve/served_view.h"

namespace kilolux {
namespace {

// The camera's options of a copied command.
std::string camera_in(const std::string& command) {
    const std::size_t begin = command.find("--camera-position");
    return begin == std::string::npos ? "" : command.substr(begin, command.find(" -o") - begin);
}

class ServedBrowser : public ::testing::Test {
 protected:
    ServedPixels seen(const std::string& name) const {
        const std::string rgb = text_of_file(folder_ / (name + ".rgb"));
        return {json_["sizes"][name][0], json_["sizes"][name][1], {rgb.begin(), rgb.end()}};
    }
    const TemporaryFolder folder_;
    nlohmann::json json_;
};

TEST_F(ServedBrowser, ShowsAndSteersTheSession) {
    std::string why;
    const fs::path playwright =
        install_npm("window/browser", "playwright-core", {"node", "npm", "chromium"}, why);
    if (playwright.empty()) GTEST_SKIP() << why;
    ServedView view;
    const std::string script = source_root() + "/tests/window/browser/drive.mjs";
    const ChildResult result = run_child(
        {"/usr/bin/env", "node", script, playwright.string(), view.url(), folder_.path().string()});
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    json_ = nlohmann::json::parse(text_of_file(folder_ / "seen.json"));
    EXPECT_EQ(json_["title"], "Kilolux - plain");
    EXPECT_EQ(json_["complaints"].dump(), "[]");
    EXPECT_EQ(seen("first"), rendered_by("kilolux render plain --lights 150", 1280, 720));
    const std::string command = json_["command"];
    EXPECT_EQ(seen("moved"), rendered_by(command, 1280, 720)) << command;
    EXPECT_NE(seen("moved"), seen("first"));
    EXPECT_NE(seen("probed"), seen("moved"));
    EXPECT_NE(seen("panel"), seen("moved"));
    EXPECT_NE(seen("slid"), seen("moved"));
    EXPECT_NE(json_["tapped"], json_["flown"]) << "the finger changed no setting";
    EXPECT_EQ(camera_in(json_["tapped"]), camera_in(json_["flown"]));
    EXPECT_EQ(seen("large").width, 1920);
    EXPECT_EQ(seen("phone").height, 844);
    EXPECT_EQ(json_["lost"], "Connection lost, trying again ...");
    EXPECT_EQ(seen("after"), seen("before"));
    for (const auto& [key, kept] : json_["kept"].items()) {
        EXPECT_EQ(kept, key != "panel" && key != "fly") << key;
    }
    EXPECT_EQ(view.program().result().code, 0);
    const nlohmann::json settings = nlohmann::json::parse(view.kept());
    EXPECT_NE(settings["exposure"].dump(), "0") << "the slider was not moved";
    // Copies of the pages, to be looked at.
    const char* pages = std::getenv("KILOLUX_KEEP_PAGES");
    if (pages != nullptr)
        fs::copy(folder_.path(), pages,
                 fs::copy_options::overwrite_existing | fs::copy_options::recursive);
}

}  // namespace
}  // namespace kilolux
