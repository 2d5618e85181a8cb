// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/document.h"

namespace kilolux {

/// Whether a buffer view's bytes stand in the file compressed (EXT_meshopt_compression).
bool is_meshopt_compressed(const GltfDocument& document, std::size_t view);

/// The decompressed bytes of such a view, `byteStride` * `count` of them.
Bytes decode_meshopt_view(const GltfDocument& document, std::size_t view);

}  // namespace kilolux
