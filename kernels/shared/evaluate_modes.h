// SPDX-License-Identifier: Apache-2.0
// Values of SHADING: the reflection model of surfaces.
#ifndef KILOLUX_SHARED_EVALUATE_MODES_H
#define KILOLUX_SHARED_EVALUATE_MODES_H
#define SHADING_LAMBERT 0      // albedo / pi
#define SHADING_BLINN_PHONG 1  // plus a normalised Blinn-Phong lobe
#define SHADING_PBR 2          // glTF metallic-roughness: GGX, height-correlated Smith, Schlick
#endif
