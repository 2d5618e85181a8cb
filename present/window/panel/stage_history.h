// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "host/picture/frame.h"

namespace kilolux {

/// Stage times of the latest pictures.
class StageHistory {
 public:
    static constexpr std::size_t kLength = 160;  // pictures

    /// `as_before`: the picture has the settings of the last one. Medians are over pictures with
    /// the newest one's settings.
    void add(const FrameStats& stats, bool as_before);

    /// Stages in the order of first use. Each keeps its place, and so its colour.
    const std::vector<std::string>& stages() const { return stages_; }
    std::size_t size() const { return pictures_.size(); }

    /// Time of a stage in picture i, 0 the oldest [ms]; 0 where it did not run.
    double ms(std::size_t i, std::size_t stage) const;

    /// Median of a stage over the latest few pictures that have it [ms]; < 0: the latest picture
    /// lacks it.
    double median_ms(std::size_t stage) const;
    double median_frame_ms() const;

    /// 90th percentile of the stages' sums [ms]: the first picture after a change also compiles.
    double usual_ms() const;

 private:
    struct Times {
        std::vector<double> stages;  // [ms]; shorter than stages_ where later ones are unknown
        double frame_ms = 0.0;
        int series = 0;  // pictures of the same settings have the same number
    };
    std::vector<std::size_t> recent() const;

    std::vector<std::string> stages_;
    std::deque<Times> pictures_;
};

/// Draws stacked stage times, the newest at the right, as wide as the panel; `height` [pixel].
void draw_stage_history(const StageHistory& history, float height);

/// The colour of a stage, as Dear ImGui packs colours.
unsigned stage_color(std::size_t stage);

}  // namespace kilolux
