// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "host/scene/gltf/document.h"

namespace kilolux {

/// Of one form; the second one has more filters and formats.
inline constexpr std::array<std::string_view, 2> kMeshoptExtensions = {"EXT_meshopt_compression",
                                                                       "KHR_meshopt_compression"};

/// Whether a buffer view's bytes stand in the file compressed (kMeshoptExtensions).
bool is_meshopt_compressed(const GltfDocument& document, std::size_t view);

/// The decompressed bytes of such a view, `byteStride` * `count` of them.
Bytes decode_meshopt_view(const GltfDocument& document, std::size_t view);

}  // namespace kilolux
