// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/widgets.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>

#include "host/base/text.h"

namespace kilolux {
namespace {

std::string hidden(const char* label) { return std::string("##") + label; }

ImGuiSliderFlags flags_of(const SliderRange& range) {
    return ImGuiSliderFlags_AlwaysClamp | (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
}

}  // namespace

// Repeats ImGui::SliderBehavior: the grab stays inside the frame.
double WidgetPlace::x_of(double value) const {
    const auto [low, high, logarithmic, format] = slider.value();
    double t = (value - low) / (high - low);
    if (logarithmic) t = std::log(std::max(value, low) / low) / std::log(high / low);
    const double margin = 2.0 + 0.5 * static_cast<double>(ImGui::GetStyle().GrabMinSize);
    return x0 + margin + std::clamp(t, 0.0, 1.0) * (static_cast<double>(x1 - x0) - 2.0 * margin);
}

void Widgets::begin_frame() { coming_.clear(); }
void Widgets::end_frame() { places_.swap(coming_); }

WidgetPlace& Widgets::note(const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 high = ImGui::GetItemRectMax();
    WidgetPlace& place = coming_[lower(name)];
    place = {};
    place.x0 = low.x;
    place.y0 = low.y;
    place.x1 = high.x;
    place.y1 = high.y;
    const ImRect& clip = ImGui::GetCurrentWindow()->InnerClipRect;
    place.visible = clip.Contains(ImRect(low, high));
    return place;
}

void Widgets::label(const char* text, const char* beside) const {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(label_width_);
    const float room = *beside == '\0' ? FLT_MIN
                                       : ImGui::CalcTextSize(beside).x + ImGui::GetFrameHeight() +
                                             2.0f * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(-room);
}

bool Widgets::section(const char* label, bool open_at_first) {
    ImGui::Dummy({0.0f, 1.0f});
    const bool open = ImGui::CollapsingHeader(
        label, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
    note(std::string("section ") + label).open = open;
    return open;
}

bool Widgets::checkbox(const char* text, bool& value, const char* owner) {
    const std::string name = *owner == '\0' ? text : std::string(owner) + " " + text;
    ImGui::PushID(owner);
    const bool changed = ImGui::Checkbox(text, &value);
    ImGui::PopID();
    note(name);
    return changed;
}

bool Widgets::button(const char* text, bool wide) {
    const bool clicked = ImGui::Button(text, {wide ? -FLT_MIN : 0.0f, 0.0f});
    note(text);
    return clicked;
}

bool Widgets::slide(const char* text, double& value, const SliderRange& range, const char* beside) {
    label(text, beside);
    const bool changed =
        ImGui::SliderScalar(hidden(text).c_str(), ImGuiDataType_Double, &value, &range.low,
                            &range.high, range.format, flags_of(range));
    note(text).slider = range;
    return changed;
}

bool Widgets::choose(const char* text, std::size_t& value, const std::vector<std::string>& names) {
    label(text);
    const std::size_t chosen = value;
    const bool open = ImGui::BeginCombo(hidden(text).c_str(), names.at(chosen).c_str(),
                                        ImGuiComboFlags_HeightLargest);
    if (!open) {
        note(text);
        return false;
    }
    bool changed = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool clicked = ImGui::Selectable(names[i].c_str(), i == chosen);
        note(std::string(text) + " " + names[i]).visible = true;
        if (!clicked) continue;
        value = i;
        changed = i != chosen;
    }
    ImGui::EndCombo();
    return changed;
}

void Widgets::tip(const char* text) const {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24.0f);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

const WidgetPlace* Widgets::find(const std::string& name) const {
    const auto found = places_.find(lower(name));
    return found == places_.end() ? nullptr : &found->second;
}

std::vector<std::string> Widgets::names() const {
    std::vector<std::string> out;
    for (const auto& [name, place] : places_) out.push_back(name);
    return out;
}

}  // namespace kilolux
