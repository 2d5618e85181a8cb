// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/lost_light.h"

#include <limits>

#include "host/measure/metrics/compensated_sum.h"

namespace kilolux {
namespace {

double light_of(const RgbImage& image, std::size_t pixel) {
    return image.rgb[3 * pixel] + image.rgb[3 * pixel + 1] + image.rgb[3 * pixel + 2];
}

double share_of(double part, double whole) {
    if (whole > 0.0) return part / whole;
    return part > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

}  // namespace

LostLight lost_light(const RgbImage& picture, const RgbImage& reference) {
    require_same_size("lost light", picture, reference);
    CompensatedSum all, lost, added;
    double lit = 0.0, losing = 0.0, most = 0.0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
        const double wanted = light_of(reference, i), lacking = wanted - light_of(picture, i);
        all.add(wanted);
        (lacking > 0.0 ? lost : added).add(std::abs(lacking));
        if (wanted > 0.0) lit += 1.0;
        if (wanted > 0.0 && lacking > kLosingShare * wanted) losing += 1.0;
        if (lacking > most) most = lacking, worst = i;
    }
    LostLight out;
    out.lost = share_of(lost.value(), all.value());
    out.added = share_of(added.value(), all.value());
    out.losing = share_of(losing, lit);
    out.x = static_cast<int>(worst % static_cast<std::size_t>(reference.width));
    out.y = static_cast<int>(worst / static_cast<std::size_t>(reference.width));
    return out;
}

}  // namespace kilolux
