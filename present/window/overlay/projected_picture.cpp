// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/projected_picture.h"

#include <imgui.h>

#include <cmath>

namespace kilolux {

ProjectedPicture::ProjectedPicture(ImDrawList& draw, const Camera& camera, const ScreenPlace& place)
    : draw_(draw),
      camera_(camera),
      place_(place),
      clip_from_view_(clip_from_view(camera, static_cast<int>(place.x1 - place.x0),
                                     static_cast<int>(place.y1 - place.y0))) {
    draw_.PushClipRect({place.x0, place.y0}, {place.x1, place.y1});
}

ProjectedPicture::~ProjectedPicture() { draw_.PopClipRect(); }

glm::dvec4 ProjectedPicture::to_clip(const glm::dvec3& world) const {
    const glm::dvec3 view = glm::transpose(camera_.world_from_view) * (world - camera_.position);
    return clip_from_view_ * glm::dvec4(view, 1.0);
}

glm::vec2 ProjectedPicture::on_screen(const glm::dvec4& clip) const {
    const glm::dvec2 ndc = glm::dvec2(clip) / clip.w;
    return {std::lerp(place_.x0, place_.x1, static_cast<float>(0.5 + 0.5 * ndc.x)),
            std::lerp(place_.y1, place_.y0, static_cast<float>(0.5 + 0.5 * ndc.y))};
}

std::optional<glm::vec2> ProjectedPicture::place_of(const glm::dvec3& world) const {
    const glm::dvec4 clip = to_clip(world);
    return clip.w > 0.0 ? std::optional(on_screen(clip)) : std::nullopt;
}

void ProjectedPicture::line(const glm::dvec3& from, const glm::dvec3& to,
                            const LineLook& look) const {
    constexpr double kNear = 1e-4;  // of clip w, which is the depth [m]
    glm::dvec4 a = to_clip(from), b = to_clip(to);
    if (a.w < kNear && b.w < kNear) return;
    if (a.w < kNear) a = glm::mix(a, b, (kNear - a.w) / (b.w - a.w));
    if (b.w < kNear) b = glm::mix(b, a, (kNear - b.w) / (a.w - b.w));
    const glm::vec2 from_at = on_screen(a), to_at = on_screen(b);
    draw_.AddLine({from_at.x, from_at.y}, {to_at.x, to_at.y}, look.color, look.width);
}

}  // namespace kilolux
