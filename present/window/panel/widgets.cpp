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
    // Dear ImGui gives a logarithmic slider from 0 as many decades as its format has digits: three.
    const double least = low > 0.0 ? low : 1e-3;
    if (logarithmic) t = std::log(std::max(value, least) / least) / std::log(high / least);
    const double margin = 2.0 + 0.5 * static_cast<double>(ImGui::GetStyle().GrabMinSize);
    return x0 + margin + std::clamp(t, 0.0, 1.0) * (static_cast<double>(x1 - x0) - 2.0 * margin);
}

void Widgets::begin_frame() { coming_.clear(); }
void Widgets::end_frame() { places_.swap(coming_); }

WidgetPlace& Widgets::note(const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 high = ImGui::GetItemRectMax();
    WidgetPlace& place = coming_[lower(group_ + name)];
    place = {};
    place.refusal = refusal_;
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

void Widgets::begin_group(const char* group) {
    ImGui::PushID(group);
    group_ = std::string(group) + " ";
}

void Widgets::end_group() {
    group_.clear();
    ImGui::PopID();
}

// The reason up to its advice, which the mouse shows.
void Widgets::describe_refusal(const std::string& reason) const {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("%s", reason.substr(0, reason.find(';')).c_str());
    ImGui::PopTextWrapPos();
    tip(reason.c_str());
}

void Widgets::begin_refusal(const std::string& reason) {
    refusal_ = reason;
    ImGui::BeginDisabled(!reason.empty());
}

void Widgets::end_refusal() {
    ImGui::EndDisabled();
    if (!refusal_.empty()) describe_refusal(refusal_);
    refusal_.clear();
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

bool Widgets::button(const char* text, bool wide, bool enabled) {
    ImGui::BeginDisabled(!enabled);
    const bool clicked = ImGui::Button(text, {wide ? -FLT_MIN : 0.0f, 0.0f});
    ImGui::EndDisabled();
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

bool Widgets::drag_number(const char* text, double& value, const DragRange& range,
                          const char* beside) {
    label(text, beside);
    double next = value;
    const bool changed = ImGui::DragScalar(hidden(text).c_str(), ImGuiDataType_Double, &next,
                                           static_cast<float>(range.step), &range.low, &range.high,
                                           range.format, ImGuiSliderFlags_AlwaysClamp);
    note(text).slider = {range.low, range.high, false, range.format};
    if (!changed || !(next >= range.low && next <= range.high)) return false;  // NaN: keeps it
    value = next;
    return true;
}

bool Widgets::color(const char* text, glm::vec3& value) {
    label(text);
    const bool changed =
        ImGui::ColorEdit3(hidden(text).c_str(), &value.x, ImGuiColorEditFlags_Float);
    note(text);
    return changed;
}

bool Widgets::choose(const char* text, std::size_t& value, const std::vector<std::string>& names,
                     const std::vector<std::string>& refusals) {
    label(text);
    const std::size_t chosen = value;
    const bool open = ImGui::BeginCombo(hidden(text).c_str(), names.at(chosen).c_str(),
                                        ImGuiComboFlags_HeightLargest);
    bool changed = false;
    if (!open) note(text);
    for (std::size_t i = 0; open && i < names.size(); ++i) {
        const std::string refusal = i < refusals.size() ? refusals[i] : "";
        const bool clicked = ImGui::Selectable(names[i].c_str(), i == chosen,
                                               refusal.empty() ? 0 : ImGuiSelectableFlags_Disabled);
        WidgetPlace& place = note(std::string(text) + " " + names[i]);
        place.visible = true;
        place.refusal = refusal;
        if (!clicked) continue;
        value = i;
        changed = i != chosen;
    }
    if (open) ImGui::EndCombo();
    for (const std::string& refusal : refusals) {
        if (!refusal.empty()) describe_refusal(refusal);
    }
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
