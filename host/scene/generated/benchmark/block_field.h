// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// A wide plain with blocks; it has no lights of its own.
Scene make_block_field();

}  // namespace kilolux
