// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/shared/area/ggx_area.h"
#include "tests/measure/area/fit/area_cases.h"

namespace kilolux {

inline FV3 as_fv3(const glm::dvec3& v) {
    return fv3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

inline FramedLight seen(const AreaShape& shape) {
    FramedLight light{SHAPE_RECTANGLE,
                      {as_fv3(shape.center), as_fv3(shape.half_x), as_fv3(shape.half_y)}};
    if (shape.kind == AreaKind::triangle) light.kind = SHAPE_TRIANGLE;
    if (shape.kind == AreaKind::disk) light.kind = SHAPE_DISK;
    if (shape.kind == AreaKind::sphere) {
        light = {SHAPE_DISK, sphere_disk(as_fv3(shape.center), static_cast<float>(shape.radius))};
    }
    return light;
}

/// What the kernels compute of lobe_integral().
inline glm::dvec2 shared_integral(const RoundLobe& of, const AreaShape& shape) {
    const FV3 up = fv3(0.0f, 0.0f, 1.0f), eye = as_fv3(of.to_eye());
    const GgxLobe lobe = make_ggx_lobe(up, eye, static_cast<float>(std::sqrt(of.alpha)));
    const AreaFrame frame = make_area_frame(up, eye);
    const AreaLobe area = make_area_lobe(lobe, lobe.alpha);
    const LobeLight light = area_ggx(frame, lobe, area, light_in_frame(frame, seen(shape)));
    const double value = light.light / (2.0 * std::numbers::pi);
    return {value, value * light.rise};
}

}  // namespace kilolux
