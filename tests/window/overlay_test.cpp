// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <imgui.h>

#include <array>
#include <string>
#include <vector>

#include "present/window/overlay/floating.h"

namespace kilolux {
namespace {

// Dear ImGui without a window.
class Overlay : public testing::Test {
 protected:
    Overlay() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {800.0f, 600.0f};
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    }
    ~Overlay() override { ImGui::DestroyContext(); }
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    // The overlay's size in a new frame.
    static std::array<float, 2> size_with(const std::vector<std::string>& lines,
                                          const Notice& notice = {}) {
        ImGui::NewFrame();
        describe_overlay(lines, notice, {0.0f, 0.0f, 800.0f, 600.0f}, 1.0f);
        ImGui::Begin("overlay");
        const ImVec2 size = ImGui::GetWindowSize();
        ImGui::End();
        ImGui::EndFrame();
        return {size.x, size.y};
    }
};

// Whether a display of that size shows the whole help, beside a panel of `panel` pixels.
bool help_fits(float width, float height, float panel) {
    ImGui::GetIO().DisplaySize = {width, height};
    bool fits = false;
    for (int frame = 0; frame < 3; ++frame) {  // Dear ImGui knows the contents of the frame before
        ImGui::NewFrame();
        describe_help({panel, 0.0f, width, height}, 1.0f);
        ImGui::Begin("help");
        const ImVec2 from = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
        fits = from.x >= 0.0f && from.y >= 0.0f && from.x + size.x <= width &&
               from.y + size.y <= height && ImGui::GetScrollMaxX() == 0.0f &&
               ImGui::GetScrollMaxY() == 0.0f;
        ImGui::End();
        ImGui::EndFrame();
    }
    return fits;
}

TEST_F(Overlay, HelpFitsIntoSmallWindows) {
    for (const auto& [width, height] :
         {std::array{1600.0f, 900.0f}, {640.0f, 400.0f}, {640.0f, 200.0f}, {300.0f, 400.0f}}) {
        EXPECT_TRUE(help_fits(width, height, 0.0f)) << width << "x" << height;
        EXPECT_TRUE(help_fits(width, height, 200.0f)) << width << "x" << height << ", panel";
    }
}

// No other frame follows where nothing moves.
TEST_F(Overlay, HoldsItsTextInTheFirstFrameThatHasIt) {
    const std::vector<std::string> few = {"a"}, more = {"a line that is longer", "another one"};
    for (int frame = 0; frame < 3; ++frame) size_with(few);
    const std::array<float, 2> small = size_with(few), first = size_with(more);
    EXPECT_GT(first[0], small[0]);
    EXPECT_GT(first[1], small[1]);
    EXPECT_EQ(size_with(more), first);
    Notice notice;
    notice.show("a notice", 0.0);
    const std::array<float, 2> noticed = size_with(more, notice);
    EXPECT_GT(noticed[1], first[1]);
    EXPECT_EQ(size_with(more, notice), noticed);
    EXPECT_EQ(size_with(few), small);
}

}  // namespace
}  // namespace kilolux
