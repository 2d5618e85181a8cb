// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "host/base/error.h"
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
    const auto fail = [&image](const std::string& reason) {
        throw Error("image '" + image.name + "': cannot encode as PNG: " + reason);
    };
    const auto out = OIIO::ImageOutput::create("png");
    if (!out) fail(OIIO::geterror());
    OIIO::ImageSpec spec(image.width, image.height, is_opaque(image) ? 3 : 4,
                         OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 6);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!out->set_ioproxy(&memory)) fail("the writer cannot write into memory");
    if (!out->open("memory.png", spec) ||
        !out->write_image(OIIO::TypeDesc::UINT8, image.rgba.data(), 4) || !out->close()) {
        fail(out->geterror());
    }
    return bytes;
}

}  // namespace kilolux
