// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "host/scene/lights/light_generator.h"
#include "present/window/overlay/cluster_overlay.h"

namespace kilolux {

/// Most outlines that are drawn at once.
inline constexpr std::size_t kMostOutlines = 1000;
/// Most generated lights of which the nearest are searched, for each picture of another camera or
/// time.
inline constexpr std::uint64_t kMostSearched = 1'000'000;

/// The closed outline of a light as the camera sees it, its points in order, world [m]: corners, an
/// ellipse, of a sphere its silhouette. Empty without a size, and for a sphere around the camera.
std::vector<glm::dvec3> outline_of(const SceneLight& light, const Camera& camera);

/// Those of both with a size; the nearest to the camera, in no order, if there are more than
/// `most`.
std::vector<const SceneLight*> nearest_area_lights(std::span<const SceneLight> own,
                                                   std::span<const SceneLight> generated,
                                                   const Camera& camera, std::size_t most);

/// The lights that a picture generates, and the camera that sees them.
struct LightSearch {
    LightOptions options;
    double time = 0.0;  // [s]
    Camera camera;
    bool operator==(const LightSearch&) const = default;
};

/// Those of them nearest to the camera, likewise; none where they have no size or are more than
/// kMostSearched. Runs on all cores. `scene`: its lights are not read.
std::vector<SceneLight> nearest_generated_lights(const LightSearch& search, const Scene& scene,
                                                 std::size_t most);

/// Draws outlines over the picture, whatever hides the lights.
class LightOutlines {
 public:
    explicit LightOutlines(const Scene& scene) : scene_(scene) {}

    /// Outlines the state's selected one of the scene's own lights, with the way that it shines,
    /// and where the state says so all that have a size, with those that the picture's settings
    /// generate. A selected one without a size is a circle.
    void draw(ImDrawList& draw, std::span<const SceneLight> own, const ViewState& state,
              const ShownPicture& shown);

 private:
    const std::vector<SceneLight>& nearest_generated(const PictureRequest& request);

    const Scene& scene_;
    LightSearch searched_;
    std::vector<SceneLight> nearest_;  // of searched_
};

}  // namespace kilolux
