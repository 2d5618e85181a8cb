// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/shadow.h"

namespace kilolux {

/// The box [m] of a shadow caster, and the number that its leaf gets: SHADOW_LEAF and its payload.
struct CasterBox {
    float low[3], high[3];
    uint child = 0;
};

/// The hierarchy of the boxes: node 0 is the root; without boxes its children are empty. Every leaf
/// is one box. Embree builds it on all cores by surface area. Throws Error where memory is short,
/// or the hierarchy is deeper than SHADOW_LEVELS.
std::vector<ShadowNode> build_shadow_hierarchy(std::span<const CasterBox> boxes);

/// Levels of nodes from the root to the lowest, of a hierarchy whose nodes come before their
/// children.
uint level_count(std::span<const ShadowNode> nodes);

}  // namespace kilolux
