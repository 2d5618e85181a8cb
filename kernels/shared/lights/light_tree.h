// SPDX-License-Identifier: Apache-2.0
// The tree of the lights without a range, for Tails::tree. A node is a light, in the rows after the
// culled lights: the sum of its lights' intensities at their weighted centre c.
#ifndef KILOLUX_SHARED_LIGHTS_LIGHT_TREE_H
#define KILOLUX_SHARED_LIGHTS_LIGHT_TREE_H
#include "kernels/shared/types.h"
#if defined(__cplusplus)
namespace kilolux {
#endif

// Nodes are in preorder: a node's first child follows it, `next` is the first node that is not
// below it. A single light has radius, spread and offset 0.
SHARED_STRUCT(TreeNode) {
    float radius;  // of the sphere about c that holds all its lights [m]
    float spread;  // sqrt(sum I |x - c|^2 / sum I), the largest of the colours [m]
    float offset;  // |sum I (x - c)| / sum I, the largest of the colours: c is not each one's [m]
    uint next;
};
SHARED_ASSERT(tree_node_size, sizeof(TreeNode) == 16);

#if defined(__cplusplus)
}  // namespace kilolux
#endif
#endif
