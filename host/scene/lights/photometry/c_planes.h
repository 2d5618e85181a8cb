// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "host/scene/lights/photometry/photometric_web.h"
#include "host/scene/lights/photometry/photometry_text.h"

namespace kilolux {

/// Candela values at a horizontal angle (a C-plane): those of a column of the file, or between two
/// of them.
struct CPlane {
    double angle = 0.0;  // [deg]
    std::size_t source = 0, other = 0;
    double part = 0.0;  // of the other one
};

/// Throws Error for vertical angles that are not from 0 to 90 or 180, or from 90 to 180.
void check_c_vertical(const PhotometryText& file, const std::vector<double>& angles);

/// Whether angles from 0 leave one gap before 360 that is no wider than the others.
bool lacks_last_angle(const std::vector<double>& angles);

/// A plane of each angle, in the order of the file's columns.
std::vector<CPlane> planes_at(const std::vector<double>& angles);

/// Adds each plane's mirror image across the plane of an angle and its opposite, and sorts them by
/// angles from 0 to 360.
void mirror(std::vector<CPlane>& planes, double angle);

/// Adds a plane at 0 where there is none, and one at 360.
void close_circle(std::vector<CPlane>& planes);

/// Gives the web these planes; `candela`: [column][vertical], the file's columns.
void set_planes(PhotometricWeb& web, const std::vector<CPlane>& planes,
                const std::vector<double>& candela);

}  // namespace kilolux
