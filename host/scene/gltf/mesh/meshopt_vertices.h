// SPDX-License-Identifier: Apache-2.0
// What KHR_meshopt_compression adds to EXT_meshopt_compression; Debian's meshoptimizer lacks it.
#pragma once

#include <cstddef>
#include <span>

#include "host/scene/gltf/files.h"

namespace kilolux {

/// Whether attributes are in version 1 of the vertex format.
bool is_vertex_format_1(ByteSpan source);

/// Decodes attributes in version 1 to `out`, whose size is a multiple of `stride`, which is a
/// multiple of 4 up to 256. Returns whether the source is whole and valid.
bool decode_vertex_format_1(ByteSpan source, std::size_t stride, std::span<unsigned char> out);

/// Undoes the filter COLOR in place, for elements of 4 or 8 bytes.
void undo_color_filter(std::span<unsigned char> elements, std::size_t stride);

}  // namespace kilolux
