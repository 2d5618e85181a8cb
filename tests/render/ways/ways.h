// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host/render/render_scene.h"
#include "raster/solid_pass.h"
#include "tests/support/render_fixture.h"

namespace kilolux {

constexpr int kWayWidth = 144;
constexpr int kWayHeight = 80;

// Rounding moves a vertex by up to 2^-23 of its distance (kernels/shared/triangle.h). On a picture
// 2 wide and kWayWidth pixels across this is 2^-24 kWayWidth pixels; twice that is allowed.
constexpr double kShift = 0x1p-23 * kWayWidth;  // [pixel]

/// A small picture of physically based surfaces that the G-buffer keeps as floats.
RenderSettings way_settings();

struct Way {
    Frame frame;
    DecodedSurfaces surfaces;  // none of the forward renderers
};

/// A pixel with a surface, as OpenGL draws it for all ways but Geometry::compute.
struct ShownPixel {
    int x = 0, y = 0;
    std::size_t in_plane = 0;  // its place in [height][stride]
    uint id = 0;               // as of IdsPass
    // The least height of its triangle in the picture [pixel]; infinite where some of it is behind
    // the camera.
    double triangle_height = 0.0;
};

glm::dvec3 pixel_radiance(const Frame& frame, const ShownPixel& pixel);

/// Renders a scene in one way after the other.
class Ways {
 public:
    Ways(const Scene& scene, const Camera& camera, const RenderSettings& settings);

    Way deferred(Geometry geometry);
    Way forward(RendererKind kind);

    std::vector<ShownPixel> shown() const;

    /// The triangle of each pixel as OpenCL draws it: [height][stride], 0 is background.
    std::vector<uint> compute_ids() const;

    /// Renders with this ambient light and so many generated lights from now on.
    void light_by(float ambient, std::uint64_t lights);

 private:
    View view() const { return view_of(camera_, settings_.width, settings_.height); }
    std::vector<uint> ids() const;
    std::vector<double> triangle_heights() const;

    const Scene& scene_;
    Camera camera_;
    RenderSettings settings_;
    std::shared_ptr<RenderScene> shared_;
    Renderer renderer_;
};

}  // namespace kilolux
