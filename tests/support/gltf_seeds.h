// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/gltf_builder.h"

namespace kilolux {

/// An image of 4x4 pixels (200, 100, 50, alpha 64): lossless WebP made by libwebp.
const Blob& webp_image();

/// A file with everything that the loader supports, every extension required: skin, morph targets,
/// sparse accessor and animation; strip and fan; both compressions; quantization; vertex colours;
/// materials with every slot and extension; PNG, JPEG and WebP; lights and cameras of all types.
///
/// A .glb: its second buffer is the fallback of EXT_meshopt_compression.
GltfBuilder every_feature_file();

/// Writes a file like that to `folder` as a .gltf with its buffer and images beside it, in names
/// that need encoding. Returns its path.
std::filesystem::path write_with_files(GltfBuilder file, const std::filesystem::path& folder);

/// A file with everything that the loader converts: specular-glossiness with both textures, points
/// and lines, instancing, variants, an extension that it leaves out.
GltfBuilder converted_features_file();

/// Valid files that together use all features of the loader: the start of mutated and fuzzed files.
std::vector<GltfBuilder> gltf_seeds();

}  // namespace kilolux
