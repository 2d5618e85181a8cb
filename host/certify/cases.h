// SPDX-License-Identifier: Apache-2.0
// The cases of hard_cases(), one function each; the names are those of the table.
#pragma once

#include "host/certify/findings.h"
#include "host/gpu/device.h"

namespace kilolux {

void try_slice_boundaries(const Gpu& gpu, Findings& findings);
void try_far_over_near(const Gpu& gpu, Findings& findings);
void try_beyond_the_grid(const Gpu& gpu, Findings& findings);
void try_huge_ranges(const Gpu& gpu, Findings& findings);
void try_spheres_at_the_camera(const Gpu& gpu, Findings& findings);
void try_orthographic(const Gpu& gpu, Findings& findings);
void try_off_centre(const Gpu& gpu, Findings& findings);
void try_infinite_far(const Gpu& gpu, Findings& findings);
void try_odd_sizes(const Gpu& gpu, Findings& findings);
void try_boundaries_and_tangents(const Gpu& gpu, Findings& findings);
void try_false_positives(const Gpu& gpu, Findings& findings);
void try_tiny_lights(const Gpu& gpu, Findings& findings);
void try_light_at_the_point(const Gpu& gpu, Findings& findings);
void try_overflow_of_half(const Gpu& gpu, Findings& findings);
void try_bad_numbers(const Gpu& gpu, Findings& findings);
void try_long_lists(const Gpu& gpu, Findings& findings);
void try_repeated_runs(const Gpu& gpu, Findings& findings);
void try_long_sums(const Gpu& gpu, Findings& findings);
void try_far_from_origin(const Gpu& gpu, Findings& findings);
void try_denormals(const Gpu& gpu, Findings& findings);
void try_srgb_rounding(const Gpu& gpu, Findings& findings);
void try_narrow_lobes(const Gpu& gpu, Findings& findings);
void try_grazing_angles(const Gpu& gpu, Findings& findings);
void try_degenerate_surfaces(const Gpu& gpu, Findings& findings);
void try_octahedral_wrap(const Gpu& gpu, Findings& findings);
void try_depth_noise(const Gpu& gpu, Findings& findings);
void try_nothing(const Gpu& gpu, Findings& findings);
void try_wide_indices(const Gpu& gpu, Findings& findings);
void try_tangent_spheres(const Gpu& gpu, Findings& findings);
void try_alternating_frames(const Gpu& gpu, Findings& findings);

void try_other_grids(const Gpu& gpu, Findings& findings);
void try_idle_lights(const Gpu& gpu, Findings& findings);
void try_scaled_intensities(const Gpu& gpu, Findings& findings);
void try_scaled_worlds(const Gpu& gpu, Findings& findings);
void try_mirror(const Gpu& gpu, Findings& findings);
void try_split_light(const Gpu& gpu, Findings& findings);
void try_permuted_lights(const Gpu& gpu, Findings& findings);
void try_lane_widths(const Gpu& gpu, Findings& findings);

}  // namespace kilolux
