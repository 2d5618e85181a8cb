// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace kilolux {

using Color3 = std::array<double, 3>;

/// CIE XYZ of linear Rec. 709 under D65, and back. Y of (1, 1, 1) is 1.
Color3 xyz_from_linear(const Color3& rgb);
Color3 linear_from_xyz(const Color3& xyz);

/// The linear opponent space in which FLIP filters: Y in [-16, 100], Cx red-green, Cz blue-yellow.
/// Andersson et al. 2020, section 4.1.1, with the white of linear Rec. 709 as the illuminant.
Color3 ycxcz_from_linear(const Color3& rgb);
Color3 linear_from_ycxcz(const Color3& ycxcz);

/// CIE L*a*b* with a* and b* scaled by 0.01 L*: colour fades in the dark (Hunt 1952; ibid. 4.1.2).
Color3 hunt_lab_from_linear(const Color3& rgb);

/// |dL| + sqrt(da^2 + db^2): Abasi et al. 2020, for large colour differences.
double hyab_distance(const Color3& a, const Color3& b);

}  // namespace kilolux
