// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"

namespace kilolux {

/// Throw Error where a buffer is smaller than its counts say: kernels would read beyond its end.
void check_input(const GBuffer& gbuffer);
void check_input(const LightInput& lights);

}  // namespace kilolux
