// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/open_tiles.h"
#include "host/scene/scene.h"
#include "kernels/shared/surface_scene.h"

namespace kilolux {

/// A rectangle of a camera's picture; its ends may lie outside [pixel].
struct ScreenBox {
    glm::dvec2 least{-std::numeric_limits<double>::infinity()};
    glm::dvec2 most{std::numeric_limits<double>::infinity()};
};

/// One instance to draw.
struct Draw {
    int instance = 0;
    int mesh = 0;
    double depth = 0.0;     // sort key: least depth of its box [m], or its centre's (back to front)
    bool mirrored = false;  // negative determinant: front faces wind the other way
    // Contains its pixels. Unbounded if its box reaches behind the camera, and for opaque draws
    // when all tiles are drawn.
    ScreenBox screen;
    InstanceRow row{};  // composed in double; its ids are numbered along the draws
};

enum class DrawOrder { front_to_back, back_to_front, scene };

/// Triangles of all draws, the last of which have the largest ids.
uint drawn_triangles(std::span<const Draw> draws, const Scene& scene);

/// Finds a scene's visible instances.
class DrawList {
 public:
    /// The scene must outlive this; its instances may move, its meshes must stay as many.
    explicit DrawList(const Scene& scene);

    /// Instances whose box touches the camera's frustum (conservative), of materials that blend or
    /// of those that do not. Back to front goes by the boxes' centres. `open`: only those whose
    /// box may touch one of these tiles.
    std::vector<Draw> visible(const Camera& camera, int width, int height, bool blended,
                              DrawOrder order, const OpenTiles* open = nullptr) const;

 private:
    struct MeshBox {
        Box box;  // object space
        bool blended = false;
        std::uint32_t revision = 0;  // of the mesh when the box was taken
    };
    struct DrawRequest;
    void refresh_boxes() const;
    std::optional<Draw> draw_of(std::size_t number, const DrawRequest& request) const;

    const Scene& scene_;
    mutable std::vector<MeshBox> boxes_;  // by mesh; follow their revisions
};

/// view_from_object in double: world positions meet the camera before they become float.
glm::dmat4 view_from_object(const Camera& camera, const glm::dmat4& world_from_object);

}  // namespace kilolux
