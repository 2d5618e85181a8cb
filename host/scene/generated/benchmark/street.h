// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// A street of facades, lit by spots.
Scene make_street();

}  // namespace kilolux
