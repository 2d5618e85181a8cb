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

    /// `pixels`: of the picture; medians are over pictures of the newest one's size.
    void add(const FrameStats& stats, int pixels);

    /// Stages in the order of first use; one keeps its place, and so its colour.
    const std::vector<std::string>& stages() const { return stages_; }
    std::size_t size() const { return times_.size(); }

    /// Time of a stage in picture i, 0 the oldest [ms]; 0 where it did not run.
    double ms(std::size_t i, std::size_t stage) const;
    double frame_ms(std::size_t i) const { return frames_.at(i); }

    /// Median of a stage over the pictures that have it among the latest few [ms]; < 0: the latest
    /// one has it not.
    double median_ms(std::size_t stage) const;
    double median_frame_ms() const;

    /// What nearly all pictures' stages take in sum at most [ms]: the first after a change also
    /// compile.
    double usual_ms() const;

 private:
    std::vector<std::size_t> recent() const;

    std::vector<std::string> stages_;
    std::deque<std::vector<double>> times_;  // by stage; shorter where later stages are unknown
    std::deque<double> frames_;
    std::deque<int> pixels_;
};

/// Draws stacked stage times, the newest at the right, in the space there is; `height` [pixel].
void draw_stage_history(const StageHistory& history, float height);

/// The colour of a stage as ImGui packs it.
unsigned stage_color(std::size_t stage);

}  // namespace kilolux
