// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/picture/frame.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Why a lit picture is black, has ambient light only or lacks shadows, in one line for the user;
/// empty where no reason is known. Counts that only `deferred` has are used where it made them.
/// `framed`: the camera is the automatic one.
std::string picture_advice(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const FrameStats& stats, bool framed = false);

}  // namespace kilolux
