// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>

#include "host/base/error.h"
#include "host/images/module/parts.h"

namespace kilolux::oiio {
namespace {

void set(OIIO::ImageSpec& spec, const std::string& name, const ImageAttribute& value) {
    if (const auto* number = std::get_if<int>(&value)) spec.attribute(name, *number);
    if (const auto* text = std::get_if<std::string>(&value)) spec.attribute(name, *text);
    if (const auto* matrix = std::get_if<glm::mat4>(&value)) {
        // Column-major with column vectors is, byte for byte, the row-major with row vectors of
        // OpenEXR.
        spec.attribute(name, OIIO::TypeDesc::TypeMatrix, &(*matrix)[0][0]);
    }
    if (const auto* values = std::get_if<std::vector<float>>(&value)) {
        const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, static_cast<int>(values->size()));
        spec.attribute(name, type, values->data());
    }
}

OIIO::ImageSpec spec_of(const ImageLayout& layout) {
    const SampleType first = layout.channels.front().type;
    OIIO::ImageSpec spec(layout.width, layout.height, static_cast<int>(layout.channels.size()),
                         type_of(first));
    bool mixed = false;
    spec.alpha_channel = -1;
    for (std::size_t i = 0; i < layout.channels.size(); ++i) {
        const ImageChannel& channel = layout.channels[i];
        spec.channelnames[i] = channel.name;
        spec.channelformats.push_back(type_of(channel.type));
        if (channel.name == "A") spec.alpha_channel = static_cast<int>(i);
        mixed |= channel.type != first;
    }
    if (!mixed) spec.channelformats.clear();
    spec.attribute("oiio:UnassociatedAlpha", 1);
    for (const auto& [name, value] : layout.attributes) set(spec, name, value);
    return spec;
}

}  // namespace

std::vector<unsigned char> encode_pixels(const std::string& name, const std::string& format,
                                         const ImageLayout& layout,
                                         std::span<const unsigned char> pixels,
                                         std::size_t pixel_stride) {
    const auto fail = [&name](const std::string& reason) {
        throw Error(name + ": cannot encode: " + reason);
    };
    // Silences the remark about attributes that a format leaves out.
    OIIO::attribute("debug", 0);
    const auto out = OIIO::ImageOutput::create(format);
    if (!out) fail(OIIO::geterror());
    std::vector<unsigned char> bytes;
    bytes.reserve(pixels.size() + 65536);  // growing would copy: few files are larger
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!out->set_ioproxy(&memory)) fail("the writer cannot write into memory");
    const OIIO::ImageSpec spec = spec_of(layout);
    // Mixed channels go in as they are: OpenImageIO would scale integers to 0..1.
    const OIIO::TypeDesc type = spec.channelformats.empty() ? spec.format : OIIO::TypeUnknown;
    if (!out->open("memory." + format, spec) ||
        !out->write_image(type, pixels.data(), static_cast<OIIO::stride_t>(pixel_stride)) ||
        !out->close()) {
        fail(out->geterror());
    }
    return bytes;
}

}  // namespace kilolux::oiio
