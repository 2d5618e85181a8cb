// SPDX-License-Identifier: Apache-2.0
#include "host/picture/web_in_view.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

double share_towards(const WebInView& view, const glm::dvec3& direction) {
    const double along = glm::dot(direction, view.down);
    const double x = glm::dot(direction, view.side);
    const double y = glm::dot(direction, glm::cross(view.side, view.down));
    const double vertical = glm::degrees(std::atan2(std::hypot(x, y), along));
    const double around = glm::degrees(std::atan2(view.mirrored ? -y : y, x));
    const double horizontal = around < 0.0 ? around + 360.0 : around;
    return candela_at(*view.web, vertical, horizontal) / view.web->peak;
}

std::vector<WebInView> webs_in_view(std::span<const AimedProfile> rows, const Scene& scene) {
    const std::vector<float> starts = profile_starts(scene.webs);
    std::vector<WebInView> out;
    for (const AimedProfile& row : rows) {
        WebInView& view = out.emplace_back();
        if (!has_web(row)) continue;
        const auto web = std::ranges::lower_bound(starts, web_start(row)) - starts.begin();
        view = {&scene.webs[static_cast<std::size_t>(web)],
                {row.down.x, row.down.y, row.down.z},
                {row.side.x, row.side.y, row.side.z},
                web_handedness(row) < 0.0f};
    }
    return out;
}

}  // namespace kilolux
