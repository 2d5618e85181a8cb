// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "kernels/shared/types.h"

namespace kilolux {

/// The room that a caller's own buffer or image of pixels must have.
struct PictureMemory {
    uint width = 0, height = 0;  // [pixel]
    uint pitch = 0;              // of a buffer: pixels from a row to the next
    uint pixel_bytes = 0;        // of a buffer
    bool image = false;          // a 2D image
};

/// Throws Error, which begins with `name`, where the memory is too small: kernels would write
/// beyond it.
void check_picture_memory(const std::string& name, const cl::Memory& memory,
                          const PictureMemory& need);

}  // namespace kilolux
