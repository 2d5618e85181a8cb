// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "host/scene/gltf_uri.h"

namespace kilolux {

/// A PNG file of only what its pixels are made from: without text, colour profiles, gamma and
/// offsets, which glTF ignores.
///
/// libpng writes its own complaints to standard error. Here what a decoder needs is checked first:
/// throws Error "<where>: ..." when it is cut off, damaged or unknown.
Bytes essential_png(std::span<const unsigned char> png, const std::string& where);

}  // namespace kilolux
