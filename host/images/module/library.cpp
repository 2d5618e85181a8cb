// SPDX-License-Identifier: Apache-2.0
#include "host/images/module/library.h"

#include "host/images/library.h"
#include "host/images/module/encode.h"
#include "host/images/module/pixels.h"
#include "host/images/module/read.h"

namespace kilolux::oiio {

OIIO::TypeDesc type_of(SampleType type) {
    switch (type) {
        case SampleType::uint8:
            return OIIO::TypeDesc::UINT8;
        case SampleType::uint16:
            return OIIO::TypeDesc::UINT16;
        case SampleType::uint32:
            return OIIO::TypeDesc::UINT32;
        case SampleType::half:
            return OIIO::TypeDesc::HALF;
        case SampleType::float32:
            break;
    }
    return OIIO::TypeDesc::FLOAT;
}

std::string one_line(const std::string& reasons) {
    std::string out;
    for (const char c : reasons) {
        if (c == '\n') {
            out += "; ";
        } else {
            out += c;
        }
    }
    return out;
}

}  // namespace kilolux::oiio

const kilolux::ImageLibrary kilolux_images{
    kilolux::oiio::encode_pixels, kilolux::oiio::open_writer, kilolux::oiio::open_image,
    kilolux::oiio::open_encoded,  kilolux::oiio::apply_ocio,  kilolux::oiio::text_mask};
