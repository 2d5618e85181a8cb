// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/flow.h"
#include "host/gpu/surface_flow.h"

namespace kilolux {

/// Throw Error where kernels would read or write beyond the end of a buffer: a buffer is smaller
/// than its counts say, a grid does not reach the view's pixels, casters are missing.
void check_input(const GBuffer& gbuffer);
void check_input(const LightInput& lights);
void check_input(const ClusterGrid& grid, const View& view);
void check_input(const ShadowInput& shadows, const View& view);

}  // namespace kilolux
