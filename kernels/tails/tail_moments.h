// SPDX-License-Identifier: Apache-2.0
// Layout of the sums of tail_moments for a coarse cluster: rows of floats, one for each cluster.
//
// Of each light without a range of its own, w bounds what its range takes of intensity times
// falloff anywhere in the cluster's box; l is the direction to it from the box's middle, and s how
// far the direction from any point of the box may be from l.
#ifndef KILOLUX_DEVICE_TAIL_MOMENTS_H
#define KILOLUX_DEVICE_TAIL_MOMENTS_H

// For each of the three colours:
#define TAIL_ALL 0    // sum of w
#define TAIL_AIMED 1  // sum of w, where s < 1
#define TAIL_STRAY 2  // sum of w s; of w where s >= 1
#define TAIL_TO 3     // sum of w l: x, y, z
#define TAIL_OUTER 6  // sum of w l l^T: xx, yy, zz, xy, xz, yz
#define TAIL_MOMENTS 12
#define TAIL_ROWS (3 * TAIL_MOMENTS)
#endif
