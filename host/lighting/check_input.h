// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"

namespace kilolux {

/// Throws Error where a buffer of the G-buffer or of lights is smaller than its counts say: kernels
/// would read beyond its end.
void check_input(const GBuffer& gbuffer, const LightInput& lights);

}  // namespace kilolux
