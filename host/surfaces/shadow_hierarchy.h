// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/shadow.h"

namespace kilolux {

/// A box [m] of a thing that casts shadows, and the number that a leaf shall have: SHADOW_LEAF and
/// what goes with it.
struct CasterBox {
    float low[3], high[3];
    uint child = 0;
};

/// The hierarchy of the boxes: node 0 is the root, whose children lie nowhere where there are no
/// boxes. Every leaf is one box. Built on all cores by Embree, by surface area. Throws Error where
/// there is no memory, or the hierarchy is deeper than SHADOW_LEVELS.
std::vector<ShadowNode> build_shadow_hierarchy(std::span<const CasterBox> boxes);

/// Levels of nodes from the root to the lowest, of a hierarchy whose nodes come before their
/// children.
uint level_count(std::span<const ShadowNode> nodes);

}  // namespace kilolux
