// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "host/scene/gltf/material/material.h"

namespace kilolux {

/// Decodes the images of materials on all cores, to RGBA of 8 bits a channel, or of 16 where the
/// file has more than 8 and all that read the image are maps in tangent space.
///
/// Any format that OpenImageIO reads, recognised by its bytes. Throws Error that names the first
/// image that is missing, broken or too large (16384 x 16384 pixels, the document's memory budget).
std::vector<Image> decode_images(const GltfDocument& document, const GltfMaterials& materials,
                                 const LoadProgress& progress = {});

/// Throws Error "<where>: ..." when a PNG file is cut off, or a part that its pixels are made from
/// is damaged or unknown: libpng would write its own complaint to standard error first.
void check_png(std::span<const unsigned char> png, const std::string& where);

}  // namespace kilolux
