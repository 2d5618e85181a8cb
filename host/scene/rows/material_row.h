// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"
#include "kernels/shared/material.h"

namespace kilolux {

/// A material as shaders and kernels read it.
MaterialRow material_row(const Material& material);

/// The use of a material's texture slot USE_*.
const TextureUse& texture_use(const Material& material, int use);

/// Whether a slot's texture holds sRGB-encoded colours.
bool is_srgb_use(int use);

}  // namespace kilolux
