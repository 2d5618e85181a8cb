// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace kilolux {

/// What is behind the scene.
struct BackgroundChoice {
    enum class Kind { environment, none, color } kind = Kind::environment;
    glm::vec3 color{0.0f};  // linear Rec. 709 radiance
    bool operator==(const BackgroundChoice&) const = default;
};

}  // namespace kilolux
