// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/stage_history.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kilolux {
namespace {

constexpr std::size_t kRecent = 15;  // pictures of a median

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The least 1, 2 or 5 times a power of ten that is not below `value`.
double round_up(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (step * power >= value) return step * power;
    }
    return 10.0 * power;
}

}  // namespace

void StageHistory::add(const FrameStats& stats, bool as_before) {
    std::vector<double> times(stages_.size(), 0.0);
    for (const StageTime& stage : stats.stages) {
        const auto found = std::find(stages_.begin(), stages_.end(), stage.name);
        const auto place = static_cast<std::size_t>(found - stages_.begin());
        if (found == stages_.end()) {
            stages_.push_back(stage.name);
            times.push_back(0.0);
        }
        times[place] = stage.ms;
    }
    const int last = pictures_.empty() ? 0 : pictures_.back().series;
    pictures_.push_back({std::move(times), stats.frame_ms, as_before ? last : last + 1});
    if (pictures_.size() > kLength) pictures_.pop_front();
}

double StageHistory::ms(std::size_t i, std::size_t stage) const {
    const std::vector<double>& times = pictures_.at(i).stages;
    return stage < times.size() ? times[stage] : 0.0;
}

double StageHistory::median_ms(std::size_t stage) const {
    if (size() == 0 || !(ms(size() - 1, stage) > 0.0)) return -1.0;
    std::vector<double> values;
    for (const std::size_t i : recent()) {
        if (ms(i, stage) > 0.0) values.push_back(ms(i, stage));
    }
    return median(values);
}

double StageHistory::median_frame_ms() const {
    if (pictures_.empty()) return 0.0;
    std::vector<double> values;
    for (const std::size_t i : recent()) values.push_back(pictures_[i].frame_ms);
    return median(values);
}

// Pictures that can be compared with the newest.
std::vector<std::size_t> StageHistory::recent() const {
    std::vector<std::size_t> out;
    for (std::size_t i = size() - std::min(size(), kRecent); i < size(); ++i) {
        if (pictures_[i].series == pictures_.back().series) out.push_back(i);
    }
    return out;
}

double StageHistory::usual_ms() const {
    std::vector<double> sums;
    for (const Times& picture : pictures_) {
        sums.push_back(std::reduce(picture.stages.begin(), picture.stages.end()));
    }
    if (sums.empty()) return 0.0;
    std::sort(sums.begin(), sums.end());
    return sums[(sums.size() - 1) * 9 / 10];
}

unsigned stage_color(std::size_t stage) {
    // Tol's muted colours, which the colour blind can tell apart.
    static constexpr unsigned kColors[] = {0xff77ccdd, 0xffeecc88, 0xff7766cc, 0xff99aa44,
                                           0xff9944aa, 0xff337711, 0xff3399dd, 0xff883322,
                                           0xffaa5588, 0xffbbbbbb};
    return kColors[stage % std::size(kColors)];
}

void draw_stage_history(const StageHistory& history, float height) {
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImGui::Dummy({width, height});
    draw.AddRectFilled(origin, {origin.x + width, origin.y + height}, 0xff161414, 4.0f);
    if (history.size() == 0) return;
    const double top = round_up(std::max(history.usual_ms(), 1e-3));
    const float bar = width / static_cast<float>(StageHistory::kLength);
    const float first = origin.x + width - bar * static_cast<float>(history.size());
    for (std::size_t i = 0; i < history.size(); ++i) {
        const float x = first + bar * static_cast<float>(i);
        float y = origin.y + height;
        for (std::size_t stage = 0; stage < history.stages().size(); ++stage) {
            const float rise =
                std::min(height * static_cast<float>(history.ms(i, stage) / top), y - origin.y);
            if (rise <= 0.0f) continue;
            draw.AddRectFilled({x, y - rise}, {x + std::max(bar, 1.0f), y}, stage_color(stage));
            y -= rise;
        }
    }
    draw.AddLine({origin.x, origin.y + 0.5f * height}, {origin.x + width, origin.y + 0.5f * height},
                 0x30ffffff);
    draw.AddText({origin.x + 5.0f, origin.y + 3.0f}, 0xc0ffffff,
                 fmt::format("{:g} ms", top).c_str());
}

}  // namespace kilolux
