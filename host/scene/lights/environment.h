// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// Light from all directions, linear Rec. 709 radiance in equal steps of longitude and latitude.
///
/// Row 0 is about +Y. The middle column is towards -Z, ahead of a camera as glTF places it; columns
/// to the right of it are towards +X.
struct Environment {
    int width = 0;                // [pixel]
    int height = 0;               // [pixel]
    std::vector<glm::vec3> rows;  // width * height, finite and >= 0
    bool as_shown = false;        // of one pixel: the display's linear colour, whatever the curve

    /// Where a pixel is in `rows`.
    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }

    /// Unit direction towards a pixel's centre.
    glm::dvec3 direction(int x, int y) const;

    /// Solid angle of a pixel of row `y` [sr]; all together 4 pi.
    double solid_angle(int y) const;

    /// Radiance times solid angle of a pixel: illuminance of a surface that faces it [lx].
    glm::dvec3 light(int x, int y) const;
};

/// An environment of `height` rows by the radiance that comes from each unit direction. Runs on all
/// cores.
Environment painted_environment(
    int height, const std::function<glm::dvec3(const glm::dvec3& direction)>& radiance);

/// Luminance of linear Rec. 709 light, in its unit.
double luminance(const glm::dvec3& light);

/// A picture in any format that OpenImageIO reads: .hdr and .exr are linear, those of 8 or 16 bits
/// encoded in sRGB; primaries that a file names become Rec. 709's. Throws Error with the file
/// for what cannot be read, is not twice as wide as high, or has a pixel that is negative or no
/// number, or that needs more than `max_memory_bytes` (0: half of what is available).
Environment read_environment(const std::filesystem::path& file, std::uint64_t max_memory_bytes = 0);

/// At most `count` directional lights that stand for the environment, by median cut (Debevec 2005,
/// "A Median Cut Algorithm for Light Probe Sampling"): the region with the most light is cut across
/// its longer side into halves of like light until there are `count`; each light has its region's
/// light, all of it, and shines from its centroid. Fewer where light is in fewer pixels.
std::vector<SceneLight> environment_lights(const Environment& environment, std::size_t count);

}  // namespace kilolux
