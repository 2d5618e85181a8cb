// SPDX-License-Identifier: Apache-2.0
// Order of the planes of a decoded G-buffer.
#ifndef KILOLUX_SHARED_SURFACE_PLANES_H
#define KILOLUX_SHARED_SURFACE_PLANES_H
#define SURFACE_DEPTH 0     // z [m], > 0 in front; 0 for background
#define SURFACE_POSITION 1  // 3 planes: view space [m]
#define SURFACE_NORMAL 4    // 3: view space, unit
#define SURFACE_ALBEDO 7    // 3: linear Rec. 709
#define SURFACE_ROUGHNESS 10
#define SURFACE_METALLIC 11
#define SURFACE_EMISSIVE 12  // 3: radiance
#define SURFACE_OCCLUSION 15
#define SURFACE_PLANES 16
// Only of scenes whose dielectrics differ (HAS_SPECULAR), after the others.
#define SURFACE_SPECULAR 16      // 3: reflectance head on
#define SURFACE_SPECULAR_F90 19  // reflectance at grazing angles
#define SURFACE_PLANES_WITH_SPECULAR 20
#endif
