// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "host/scene/camera.h"
#include "raster/gl_object.h"

namespace kilolux {

/// A box to draw, along the axes of a camera's view space.
struct DrawnBox {
    glm::vec3 min{0.0f};  // [m]
    glm::vec3 max{0.0f};  // [m]
    glm::vec4 color{1.0f};
};

/// The place of the picture with boxes in the framebuffer [pixel], from its lower left.
struct BoxTarget {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Draws edges of boxes over a picture, faintly where the picture's surfaces hide them.
class BoxPass {
 public:
    /// Throws Error when a shader does not compile.
    BoxPass();

    /// Boxes in the view space of `from`, until the next call.
    void set_boxes(std::span<const DrawnBox> boxes, const Camera& from);

    /// The picture's depths [m], width * height, row 0 on top, 0 for background; empty: nothing is
    /// hidden.
    void set_depths(std::span<const float> depths, int width, int height);

    /// Draws to the current framebuffer as `camera` sees the boxes. Changes blending, viewport and
    /// program.
    void draw(const Camera& camera, const BoxTarget& target) const;

    std::size_t box_count() const { return count_; }

 private:
    GlProgram program_;
    GlVertexArray vertex_array_;
    GlBuffer boxes_;
    GlTexture depths_;
    Camera from_;
    std::size_t count_ = 0;
};

}  // namespace kilolux
