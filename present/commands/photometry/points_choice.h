// SPDX-License-Identifier: Apache-2.0
// The points of `kilolux photometry`: a plane of the command line, or a file.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/measure/photometry/measuring_points.h"

namespace kilolux {

/// Points in the middles of the equal cells of a parallelogram, row by row along `u`. They face
/// u x v.
struct MeasuringGrid {
    glm::dvec3 origin{0.0};               // [m], world
    glm::dvec3 u{0.0}, v{0.0};            // edges [m]
    std::uint64_t columns = 0, rows = 0;  // 0: no plane
    bool operator==(const MeasuringGrid&) const = default;
};

inline constexpr const char* kPlaneSyntax =
    "X0,Z0,X1,Z1,Y,NX,NZ: the middles of NX x NZ cells of a horizontal plane at height Y, facing "
    "up; or X,Y,Z,UX,UY,UZ,VX,VY,VZ,NU,NV: an origin and two edges, facing U x V";

/// Reads kPlaneSyntax, with X0 < X1 and Z0 < Z1. Throws UsageError.
MeasuringGrid parse_plane(const std::string& option, std::string_view text);

/// The second form, which reads back as the same plane; "" for none.
std::string text_of(const MeasuringGrid& plane);

std::vector<MeasuringPoint> points_of(const MeasuringGrid& plane);

/// Reads a CSV with a point a line: x,y,z [m] and a normal of any length, at most 256 MiB. A first
/// line "x,y,z,nx,ny,nz", also with units, empty lines and lines that begin with '#' are left out.
/// Throws Error with the file, the line and the value seen.
std::vector<MeasuringPoint> read_points(const std::filesystem::path& file);

}  // namespace kilolux
