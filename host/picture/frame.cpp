// SPDX-License-Identifier: Apache-2.0
#include "host/picture/frame.h"

#include <algorithm>

namespace kilolux {

void add_stage_time(std::vector<StageTime>& stages, std::string_view name, double ms) {
    const auto found = std::find_if(stages.begin(), stages.end(),
                                    [&](const StageTime& stage) { return stage.name == name; });
    if (found == stages.end()) {
        stages.push_back({std::string(name), ms, 0.0});
    } else {
        found->ms += ms;
    }
}

}  // namespace kilolux
