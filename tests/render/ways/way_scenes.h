// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/camera.h"
#include "host/scene/scene.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {

/// Hills, hung over by others that are scaled unevenly, mirrored, cut by alpha and seen from below.
/// Their materials have every map but those of coats, of different samplers, sets and transforms.
Scene mapped_scene();

/// The same under clear coats with maps of their own.
Scene coated_scene();

/// The same with sheen of two maps, without coats.
Scene sheen_scene();

/// The same with stretched highlights of a map.
Scene stretched_scene();

/// mapped_scene() with nearest texels and levels, and textures without mipmaps.
Scene mapped_scene_with_other_filters();

/// Sees the hills.
Camera hill_camera();

/// Quads with noise and a normal map: a large one, before it a mirrored one of this alpha mode, and
/// one that alpha cuts out and an animation turns.
GltfBuilder quads_file(const char* alpha_of_mirrored);

/// Sees the quads.
Camera quads_camera();

}  // namespace kilolux
