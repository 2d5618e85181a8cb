// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"

namespace kilolux {

/// Throws Error where a buffer that is to be lit, or one of lights, is smaller than what is said to
/// be in it: kernels would read beyond its end.
void check_input(const GBuffer& gbuffer, const LightInput& lights);

}  // namespace kilolux
