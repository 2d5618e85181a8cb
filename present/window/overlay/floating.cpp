// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/floating.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "present/window/panel/gui.h"
#include "present/window/panel/key_bindings.h"

namespace kilolux {
namespace {

constexpr double kNoticeSeconds = 6.0;
constexpr double kFadeSeconds = 1.0;  // the last of them
constexpr float kNoticeWidth = 260.0f;
constexpr ImGuiWindowFlags kFloating = kPinned | ImGuiWindowFlags_NoInputs |
                                       ImGuiWindowFlags_NoFocusOnAppearing |
                                       ImGuiWindowFlags_NoScrollbar;

float width_of(const char* text) { return ImGui::CalcTextSize(text).x; }

}  // namespace

void Notice::show(std::string text, double now) {
    text_ = std::move(text);
    end_ = now + kNoticeSeconds;
}

bool Notice::fade(double now) {
    if (text_.empty()) return false;
    const float alpha = static_cast<float>(std::clamp((end_ - now) / kFadeSeconds, 0.0, 1.0));
    if (alpha == 0.0f) text_.clear();
    return std::exchange(alpha_, alpha) != alpha;
}

// The size follows from this frame's text: Dear ImGui would take the last frame's.
void describe_overlay(const std::vector<std::string>& lines, const Notice& notice,
                      const ScreenPlace& place, float scale) {
    const ImGuiStyle& style = ImGui::GetStyle();
    ImVec2 size(0.0f, 0.0f);
    const auto add = [&](const ImVec2& text) {
        size.x = std::max(size.x, text.x);
        size.y += text.y + (size.y > 0.0f ? style.ItemSpacing.y : 0.0f);
    };
    const float wrap = kNoticeWidth * scale;
    for (const std::string& line : lines) add(ImGui::CalcTextSize(line.c_str()));
    if (!notice.text().empty()) {
        add(ImGui::CalcTextSize(notice.text().c_str(), nullptr, false, wrap));
    }
    const float margin = 10.0f * scale;
    ImGui::SetNextWindowPos({place.x1 - margin, place.y0 + margin}, ImGuiCond_Always, {1.0f, 0.0f});
    ImGui::SetNextWindowSize(
        {size.x + 2.0f * style.WindowPadding.x, size.y + 2.0f * style.WindowPadding.y});
    ImGui::SetNextWindowBgAlpha(0.62f);
    ImGui::Begin("overlay", nullptr, kFloating);
    for (const std::string& line : lines) ImGui::TextUnformatted(line.c_str());
    ImGui::PushTextWrapPos(style.WindowPadding.x + wrap);
    if (!notice.text().empty()) {
        ImGui::TextColored({1.0f, 1.0f, 1.0f, notice.alpha()}, "%s", notice.text().c_str());
    }
    ImGui::PopTextWrapPos();
    ImGui::End();
}

void describe_help(const ScreenPlace& place, float scale) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float gap = 16.0f * scale;
    float keys = 0.0f, meanings = 0.0f;
    for (const KeyRow& entry : key_rows()) {
        keys = std::max(keys, width_of(entry.keys));
        meanings = std::max(meanings, width_of(entry.meaning));
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 whole(keys + gap + meanings, line * static_cast<float>(key_rows().size()));
    const ImVec2 edge(2.0f * style.WindowPadding.x, 2.0f * style.WindowPadding.y);
    const float left = place.x1 - place.x0 < whole.x + edge.x ? 0.0f : place.x0;
    const float shrunk = std::min(
        {1.0f, (place.x1 - left - edge.x) / whole.x, (place.y1 - place.y0 - edge.y) / whole.y});
    ImGui::SetNextWindowPos({0.5f * (left + place.x1), 0.5f * (place.y0 + place.y1)},
                            ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({shrunk * whole.x + edge.x, shrunk * whole.y + edge.y});
    ImGui::SetNextWindowBgAlpha(0.92f);
    ImGui::Begin("help", nullptr, kFloating);
    ImGui::SetWindowFontScale(shrunk);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        {style.ItemSpacing.x, shrunk * style.ItemSpacing.y});
    for (const KeyRow& entry : key_rows()) {
        ImGui::TextColored({0.95f, 0.72f, 0.34f, 1.0f}, "%s", entry.keys);
        ImGui::SameLine(style.WindowPadding.x + shrunk * (keys + gap));
        ImGui::TextUnformatted(entry.meaning);
    }
    ImGui::PopStyleVar();
    ImGui::SetWindowFontScale(1.0f);
    ImGui::End();
}

bool describe_failure(Widgets& ui, const std::string& text, const ScreenPlace& place, float scale) {
    if (text.empty()) return false;
    const float margin = 20.0f * scale;
    const float width = std::min(420.0f * scale, place.x1 - place.x0 - 2.0f * margin);
    ImGui::SetNextWindowPos({0.5f * (place.x0 + place.x1), place.y1 - margin}, ImGuiCond_Always,
                            {0.5f, 1.0f});
    ImGui::Begin("failure", nullptr, kPinned | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushTextWrapPos(width);
    ImGui::TextColored({1.0f, 0.5f, 0.4f, 1.0f}, "%s", text.c_str());
    ImGui::PopTextWrapPos();
    const bool dismissed = ui.button("Dismiss");
    ImGui::End();
    return dismissed;
}

}  // namespace kilolux
