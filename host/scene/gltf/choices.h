// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/document.h"

namespace kilolux {

/// The animations that play, in the order that the options name them: by default the first of the
/// file. Throws UsageError, with the nearest name, for a clip that the file does not have.
std::vector<std::size_t> choose_clips(const GltfDocument& document);

/// "'walk'", or "animations[2]" of one without a name, for messages.
std::string clip_name(const GltfDocument& document, std::size_t clip);

/// The file's animations with their lengths.
std::vector<Clip> list_clips(const GltfDocument& document);

/// Names of the file's material variants (KHR_materials_variants).
std::vector<std::string> list_variants(const GltfDocument& document);

/// Gives the primitives the materials of the variant that the options name. Throws UsageError, with
/// the nearest name, for one that the file does not have.
void apply_variant(GltfDocument& document);

}  // namespace kilolux
