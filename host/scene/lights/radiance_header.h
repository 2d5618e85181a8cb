// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace kilolux {

/// What the header of a Radiance picture (.hdr) says of its pixels and OpenImageIO leaves out
/// (Ward, "Radiance File Formats").
struct RadianceHeader {
    glm::dvec3 divisor{1.0};              // of pixels: all EXPOSURE and COLORCORR lines multiplied
    std::vector<float> chromaticities{};  // as ImageLayout has them: PRIMARIES; else empty
};

/// Of a file in another format, the default. Throws Error "<file>: EXPOSURE is ..., must be ...".
RadianceHeader read_radiance_header(const std::filesystem::path& file);

}  // namespace kilolux
