// SPDX-License-Identifier: Apache-2.0
#include "host/images/images.h"
#include "host/scene/export/parts.h"

namespace kilolux {
namespace {

bool is_opaque(const Image& image) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        if (image.rgba[i] != 255) return false;
    }
    return true;
}

}  // namespace

std::vector<unsigned char> encode_png(const Image& image) {
    ImageLayout layout{image.width, image.height, {}};
    for (const char* name : {"R", "G", "B"}) layout.channels.push_back({name, SampleType::uint8});
    if (!is_opaque(image)) layout.channels.push_back({"A", SampleType::uint8});
    layout.attributes.emplace_back("png:compressionLevel", 6);
    return encode_pixels("image '" + image.name + "'", "png", layout, image.rgba, 4);
}

}  // namespace kilolux
