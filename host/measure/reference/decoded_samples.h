// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "host/measure/reference/reference.h"
#include "host/picture/decoded_surfaces.h"
#include "host/render/renderer.h"

namespace kilolux {

/// One decoded pixel; `value_of(SURFACE_*)` returns a plane's value. `unlit`: as in
/// DecodedSurfaces.
SurfaceSample surface_sample(const std::function<double(std::size_t)>& value_of, bool unlit);

/// A decoded G-buffer as input of a reference. Normals are not renormalised, as in the kernels.
/// Depth 0 is background.
SurfaceSamples surface_samples(const DecodedSurfaces& decoded);

/// The model of surfaces that no renderer made, such as ray-cast ones: shaded as by a renderer with
/// these kernels and settings, without shadows.
ReferenceOptions reference_options(const KernelFeatures& kernels, const RenderSettings& settings,
                                   const Camera& camera);

/// The model of what a renderer shades. With shadows it refers to the renderer's scene;
/// `casts_shadows` false: the caller knows which lights are seen.
ReferenceOptions reference_options(const Renderer& renderer, const Camera& camera,
                                   bool casts_shadows = true);

/// The reference of what a renderer shaded: its stored surfaces and float32 lights.
ReferencePicture shade_reference(const LitSurfaces& lit, const ReferenceOptions& options);

/// The reference of a renderer's last picture, by `camera`: of its stored surfaces, or where some
/// blend, of those that rays hit.
ReferencePicture picture_reference(Renderer& renderer, const Camera& camera,
                                   const ReferenceOptions& options);

}  // namespace kilolux
