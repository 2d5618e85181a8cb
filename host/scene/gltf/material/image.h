// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/document.h"

namespace kilolux {

/// Decodes images of the file (by index, each once) to RGBA8, on all cores.
///
/// Any format that OpenImageIO reads, recognised by its bytes. Throws Error that names the first
/// image that is missing, broken or too large (16384 x 16384 pixels, the document's memory budget).
std::vector<Image> decode_images(const GltfDocument& document, const std::vector<int>& images,
                                 const LoadProgress& progress = {});

}  // namespace kilolux
