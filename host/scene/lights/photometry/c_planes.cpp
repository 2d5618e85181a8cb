// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/photometry/c_planes.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

void check_c_vertical(const PhotometryText& file, const std::vector<double>& angles) {
    const double first = angles.front();
    const double last = angles.back();
    if ((first == 0.0 && (last == 90.0 || last == 180.0)) || (first == 90.0 && last == 180.0))
        return;
    file.fail("vertical angles are from {} to {}, must be 0 to 90, 90 to 180 or 0 to 180", first,
              last);
}

bool lacks_last_angle(const std::vector<double>& angles) {
    double widest = 0.0;
    for (std::size_t i = 1; i < angles.size(); ++i) {
        widest = std::max(widest, angles[i] - angles[i - 1]);
    }
    return angles.front() == 0.0 && angles.back() < 360.0 &&
           360.0 - angles.back() <= widest * (1.0 + 1e-9);
}

std::vector<CPlane> planes_at(const std::vector<double>& angles) {
    std::vector<CPlane> planes;
    for (const double angle : angles) planes.push_back({angle, planes.size(), 0, 0.0});
    return planes;
}

void mirror(std::vector<CPlane>& planes, double angle) {
    const std::size_t count = planes.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double image = std::fmod(2.0 * angle - planes[i].angle + 720.0, 360.0);
        planes.push_back({image, planes[i].source, 0, 0.0});
    }
    for (CPlane& plane : planes) plane.angle = std::fmod(plane.angle, 360.0);
    // Not std::ranges: that of libstdc++ 12 does not compile with clang 14 here.
    std::stable_sort(planes.begin(), planes.end(),
                     [](const CPlane& a, const CPlane& b) { return a.angle < b.angle; });
    planes.erase(std::unique(planes.begin(), planes.end(),
                             [](const CPlane& a, const CPlane& b) { return a.angle == b.angle; }),
                 planes.end());
}

void close_circle(std::vector<CPlane>& planes) {
    if (planes.front().angle > 0.0) {
        const double before = 360.0 - planes.back().angle;
        const double part = before / (before + planes.front().angle);
        planes.insert(planes.begin(), {0.0, planes.back().source, planes.front().source, part});
    }
    if (planes.back().angle == 360.0) return;
    planes.push_back(planes.front());
    planes.back().angle = 360.0;
}

void set_planes(PhotometricWeb& web, const std::vector<CPlane>& planes,
                const std::vector<double>& candela) {
    const std::size_t rows = web.vertical.size();
    web.peak = *std::max_element(candela.begin(), candela.end());
    for (const CPlane& plane : planes) {
        web.horizontal.push_back(plane.angle);
        const double* source = &candela[plane.source * rows];
        const double* other = &candela[plane.other * rows];
        for (std::size_t i = 0; i < rows; ++i) {
            web.candela.push_back(source[i] + plane.part * (other[i] - source[i]));
        }
    }
    make_profile_table(web);
}

}  // namespace kilolux
