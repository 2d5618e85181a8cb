// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace kilolux {

/// From linear Rec. 709 to the linear opponent space in which FLIP filters, and back: Y in
/// [-16, 100], Cx red-green, Cz blue-yellow. Andersson et al. 2020, section 4.1.1, with the white
/// of linear Rec. 709 as the illuminant.
glm::dvec3 ycxcz_from_linear(const glm::dvec3& rgb);
glm::dvec3 linear_from_ycxcz(const glm::dvec3& ycxcz);

/// CIE L*a*b* with a* and b* scaled by 0.01 L*: dark colours look less
/// saturated (Hunt 1952; ibid. 4.1.2).
glm::dvec3 hunt_lab_from_linear(const glm::dvec3& rgb);

/// |dL| + sqrt(da^2 + db^2): Abasi et al. 2020, for large colour differences.
double hyab_distance(const glm::dvec3& a, const glm::dvec3& b);

}  // namespace kilolux
