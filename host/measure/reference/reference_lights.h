// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "host/measure/reference/area/area_light.h"
#include "host/picture/web_in_view.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/light.h"

namespace kilolux {

/// A light that has a place, in view space, in double.
struct ReferenceLight {
    glm::dvec3 position{0.0};  // [m]
    double inv_range2 = 0.0;   // 1/range^2 [1/m^2]; 0: no range
    bool random_range = false;
    glm::dvec3 intensity{0.0};  // linear Rec. 709 [cd]
    glm::dvec3 axis{0.0};       // unit, direction of the light's travel; 0 for a point light
    double cos_out = -1.0;      // of the outer cone's half angle
    double cone_scale = 1.0;    // 1/(cos_in - cos_out)
    WebInView web{};
    std::optional<AreaShape> shape{};  // about `position`; none: it has no size
    double inverse_area = 0.0;         // of a shape: luminance = intensity * this [1/m^2]
};

/// A directional light in view space, in double.
struct ReferenceDirectionalLight {
    glm::dvec3 to_light{0.0, 0.0, 1.0};  // unit
    glm::dvec3 illuminance{0.0};         // linear Rec. 709 [lx]
};

/// A light as seen from a surface.
struct Incidence {
    glm::dvec3 to_light{0.0};
    double attenuation = 0.0;
    bool reaches = false;  // by more than kReachMargin
};

struct ReferenceOptions;
/// A light without a size.
Incidence incidence(const ReferenceLight& light, const glm::dvec3& position,
                    const ReferenceOptions& options);

struct ReferenceLights {
    std::vector<ReferenceLight> lights;
    std::vector<ReferenceDirectionalLight> directional;
};

/// The factor of the range on a light's inverse square: its window, or what a random range weighs.
double window_at(const ReferenceLight& light, const glm::dvec3& position,
                 const ReferenceOptions& options);

/// Rows beside those of lights, one per light, or none at all.
struct ReferenceExtras {
    std::span<const WebInView> webs;
    std::span<const LightShape> shapes;  // view space
};

/// From the float32 rows that the kernels shade with: for R1.
ReferenceLights reference_lights(std::span<const ShadeLight> lights,
                                 std::span<const DirectionalLight> directional,
                                 const ReferenceExtras& extras = {});

/// From a scene's lights, without rounding to float32: for R2 and R3. Lights without a range keep
/// none. The cone's smallest width is that of KHR_lights_punctual: cos_in - cos_out >= 0.001.
/// `scene`: has the photometric webs of the lights, and outlives them; not needed without.
ReferenceLights reference_lights(std::span<const SceneLight> lights, const Camera& camera,
                                 const Scene* scene = nullptr);

}  // namespace kilolux
