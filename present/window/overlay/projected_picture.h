// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/scene/camera.h"

struct ImDrawList;

namespace kilolux {

/// A picture's place in the window, window coordinates.
struct ScreenPlace {
    float x0 = 0.0f, y0 = 0.0f, x1 = 0.0f, y1 = 0.0f;
};

/// The look of lines: a colour of Dear ImGui, and their width, window coordinates.
struct LineLook {
    std::uint32_t color = 0;
    float width = 1.5f;
};

/// Draws over the picture of a camera what is given in the world [m], within the picture's place.
class ProjectedPicture {
 public:
    ProjectedPicture(ImDrawList& draw, const Camera& camera, const ScreenPlace& place);
    ~ProjectedPicture();
    ProjectedPicture(const ProjectedPicture&) = delete;
    ProjectedPicture& operator=(const ProjectedPicture&) = delete;

    ImDrawList& draw() const { return draw_; }
    const Camera& camera() const { return camera_; }

    /// Where a point is seen, window coordinates; none behind the camera.
    std::optional<glm::vec2> place_of(const glm::dvec3& world) const;
    /// The part of the line that is before the camera.
    void line(const glm::dvec3& from, const glm::dvec3& to, const LineLook& look) const;

 private:
    glm::dvec4 to_clip(const glm::dvec3& world) const;
    glm::vec2 on_screen(const glm::dvec4& clip) const;

    ImDrawList& draw_;
    Camera camera_;
    ScreenPlace place_;
    glm::dmat4 clip_from_view_;
};

}  // namespace kilolux
