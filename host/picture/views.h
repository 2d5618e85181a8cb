// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/picture/frame_request.h"
#include "host/scene/camera.h"

namespace kilolux {

/// The inputs of views; each view reads those that it needs.
struct ViewInput {
    const DecodedSurfaces& pixels;
    const Camera& camera;
    Box box;                              // of the scene, world space [m]
    const std::vector<float>& overdraw;   // width * height fragments; for "overdraw"
    const std::vector<float>& radiance;   // 3 * width * height; for "difference"
    const std::vector<float>& reference;  // deferred-all's; for "difference"
};

/// The view's picture: sRGB, 4 * width * height, opaque; heat maps have their legend in the lower
/// left corner where the picture has room. Throws UsageError for a view of lists that the
/// renderer does not make.
std::vector<std::uint8_t> make_view(ViewKind view, const ViewInput& input);

/// The words of the command line, in the enumeration's order.
const std::vector<std::string>& view_names();
const std::vector<std::string>& view_meanings();  // for --help
const std::string& name_of(ViewKind view);

/// Throws UsageError for an unknown name.
ViewKind parse_view(std::string_view name);

}  // namespace kilolux
