// SPDX-License-Identifier: Apache-2.0
// The functions of hard_cases(), named after their cases.
#pragma once

#include "host/certify/lighting_case.h"

namespace kilolux {

using TryCase = void(const Gpu& gpu, Findings& findings);

// cases/depth.cpp
TryCase try_slice_boundaries, try_far_over_near, try_beyond_the_grid;
// cases/culling.cpp
TryCase try_huge_ranges, try_spheres_at_the_camera, try_boundaries_and_tangents, try_tiny_lights,
    try_tangent_spheres;
// cases/overlap.cpp
TryCase try_false_positives;
// cases/views.cpp
TryCase try_orthographic, try_off_centre, try_infinite_far, try_odd_sizes;
// cases/sums.cpp
TryCase try_light_at_the_point, try_half_overflow, try_long_sums, try_narrow_lobes;
// cases/angles.cpp
TryCase try_grazing_angles;
// cases/scenes.cpp
TryCase try_bad_numbers, try_far_from_origin, try_degenerate_surfaces, try_alternating_frames;
// cases/lists.cpp
TryCase try_long_lists, try_repeated_runs, try_depth_noise, try_nothing, try_wide_indices;
// cases/denormals.cpp
TryCase try_denormals;
// cases/rounding.cpp
TryCase try_srgb_rounding;
// cases/octahedral.cpp
TryCase try_octahedral_wrap;
// cases/triangles.cpp
TryCase try_triangle_edges;
// cases/shadows.cpp
TryCase try_shadow_edges;

// cases/tails.cpp
TryCase try_tails;
// cases/profiles.cpp
TryCase try_light_profiles;
// cases/areas.cpp
TryCase try_area_lights;
// cases/metamorphic.cpp
TryCase try_other_grids, try_idle_lights, try_scaled_intensities, try_scaled_world, try_mirror,
    try_split_light, try_permuted_lights, try_lane_widths;

}  // namespace kilolux
