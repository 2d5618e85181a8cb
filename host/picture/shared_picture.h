// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "host/picture/decoded_surfaces.h"
#include "host/picture/frame.h"

namespace kilolux {

/// A picture that is made by rows, maybe by several renderers at once: see Renderer::render_rows().
struct SharedPicture {
    Frame frame;               // pixels go to their places
    DecodedSurfaces surfaces;  // of a view
    std::mutex placing;        // while the rows of layers and surfaces are put into their places
};

}  // namespace kilolux
