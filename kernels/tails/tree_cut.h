// SPDX-License-Identifier: Apache-2.0
// The error of a node of the light tree against its lights, and the nodes that a cluster takes.
//
// A light at x of intensity 1 gives a surface at p the irradiance E(x) = max(n.r, 0) / |r|^3 with
// r = x - p. Where n.r > 0 that is the field of a dipole: its gradient is at most 2 / |r|^3, its
// second derivative along any direction at most 6 / |r|^4. Let a node's lights lie within `radius`
// of its centre c and `near` = |c - p| - radius be their least distance. Taylor about c:
//
//     |sum I E(x) - (sum I) E(c)| <= sum I * (2 offset / near^3 + 3 spread^2 / near^4)
//
// where all lights are on the lit side of the surface's plane. E is continuous across the plane and
// 0 behind it, so without that the gradient alone bounds it: sum I * 2 spread / near^3, since
// sum I |x - c| <= sum I * spread.
#ifndef KILOLUX_DEVICE_TREE_CUT_H
#define KILOLUX_DEVICE_TREE_CUT_H
#include "kernels/device/lanes.h"
#include "kernels/shared/light.h"
#include "kernels/shared/lights/light_tree.h"

// The surfaces of a cluster: their normals lie in a cone about `axis`.
typedef struct ClusterCone {
    float4 axis_cosine;  // w: of the half angle; <= 0: any normal
    float sine;
    float sharpness;  // 1, or more where surfaces have lobes narrower than a diffuse one
    float unused0, unused1;
} ClusterCone;

// Boxes and cones of VW clusters.
typedef struct Receivers {
    FV3 middle;
    FV radius;  // half the diagonal [m]
    FV3 axis;
    FV cosine, sine, sharpness;
} Receivers;

// The choice of a walk at a node, for each lane.
typedef struct NodeChoice {
    MASK take;  // its light is evaluated
    MASK pass;  // taken, or behind all surfaces: the walk skips the nodes below it
} NodeChoice;

// More than the rounding of distances here.
#define TREE_ROUNDING 1.00001f

// `at`: the node's centre, view space. A node is taken where its error is at most `share` of the
// least light that it could send to the cluster, its intensity / farthest^2.
static inline NodeChoice choose_node(Receivers r, TreeNode node, float4 at, float share) {
    FV3 w = fv3(fv(at.x) - r.middle.x, fv(at.y) - r.middle.y, fv(at.z) - r.middle.z);
    FV d2 = dot3(w, w);
    FV distance = lane_sqrt(d2);
    FV along = dot3(w, r.axis);
    FV across = lane_sqrt(max(fma(-along, along, d2), fv(0.0f)));
    FV slack = fma(distance, fv(TREE_ROUNDING - 1.0f), (r.radius + node.radius) * TREE_ROUNDING);
    FV high = fma(r.cosine, along, fma(r.sine, across, slack));
    FV low = fma(r.cosine, along, -fma(r.sine, across, slack));
    MASK is_cone = lane_mask(r.cosine > fv(0.0f));
    NodeChoice out;
    MASK behind = lane_mask(high < fv(0.0f)) & is_cone;
    MASK lit = lane_mask(low > fv(0.0f)) & is_cone;
    FV near = distance - slack;
    FV far = (distance + r.radius) * TREE_ROUNDING;
    FV inv_far = fv(1.0f) / max(far, fv(1e-30f));
    FV s = near * inv_far;  // at most 1: nothing overflows
    FV spread = r.sharpness * (node.spread * inv_far);
    FV offset = r.sharpness * (node.offset * inv_far);
    FV smooth = fma(spread * spread, fv(3.0f), offset * (s * 2.0f));
    FV kinked = spread * (s * 2.0f);
    FV error = lane_select(lit, smooth, kinked);
    MASK fine = lane_mask(error <= (s * s) * (s * s) * share) & lane_mask(near > fv(LIGHT_D_MIN));
    if (!(node.radius > 0.0f)) fine = lane_mask(distance >= fv(0.0f));
    out.take = fine & ~behind;
    out.pass = fine | behind;
    return out;
}
#endif
