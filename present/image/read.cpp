// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/base/error.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw Error(file.string() + ": cannot read the image: " + reason);
}

// Reads channels [begin, end), all integers that must not be scaled or none.
void read_channels(OIIO::ImageInput& in, const std::filesystem::path& file, FloatImage& image,
                   int begin, int end, bool ids) {
    const auto count = static_cast<std::size_t>(end - begin);
    const std::size_t stride = image.channels.size() * sizeof(float);
    float* first = image.values.data() + begin;
    const OIIO::TypeDesc type = ids ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT;
    if (!in.read_image(0, 0, begin, end, type, first, static_cast<OIIO::stride_t>(stride))) {
        fail(file, in.geterror());
    }
    if (!ids) return;
    for (std::size_t i = 0; i < image.values.size(); i += image.channels.size()) {
        for (std::size_t c = 0; c < count; ++c) {
            first[i + c] = static_cast<float>(std::bit_cast<std::uint32_t>(first[i + c]));
        }
    }
}

// Codes of integer formats as the nearest float of code / largest, whatever the reader's
// arithmetic.
void snap_to_codes(std::vector<float>& values, float largest) {
    for (float& value : values) value = std::round(value * largest) / largest;
}

}  // namespace

FloatImage read_image(const std::filesystem::path& file) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored
    const auto in = OIIO::ImageInput::open(file.string(), &config);
    if (!in) fail(file, OIIO::geterror());
    const OIIO::ImageSpec& spec = in->spec();
    FloatImage image;
    image.width = spec.width;
    image.height = spec.height;
    image.channels = spec.channelnames;
    image.values.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    const auto is_id = [&spec](int c) { return spec.channelformat(c) == OIIO::TypeDesc::UINT32; };
    for (int begin = 0; begin < spec.nchannels;) {
        int end = begin + 1;
        while (end < spec.nchannels && is_id(end) == is_id(begin)) ++end;
        read_channels(*in, file, image, begin, end, is_id(begin));
        begin = end;
    }
    if (spec.format == OIIO::TypeDesc::UINT8) snap_to_codes(image.values, 255.0f);
    if (spec.format == OIIO::TypeDesc::UINT16) snap_to_codes(image.values, 65535.0f);
    return image;
}

std::vector<float> colour_of(const FloatImage& image) {
    const std::size_t count = image.channels.size();
    if (count == 0) throw Error("an image without channels has no colour");
    std::size_t source[3] = {0, std::min<std::size_t>(1, count - 1),
                             std::min<std::size_t>(2, count - 1)};
    if (count < 3) source[1] = source[2] = 0;
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = std::find(image.channels.begin(), image.channels.end(), names[i]);
        if (found != image.channels.end()) {
            source[i] = static_cast<std::size_t>(found - image.channels.begin());
        }
    }
    std::vector<float> colour;
    colour.reserve(image.values.size() / count * 3);
    for (std::size_t pixel = 0; pixel < image.values.size(); pixel += count) {
        for (const std::size_t channel : source) colour.push_back(image.values[pixel + channel]);
    }
    return colour;
}

}  // namespace kilolux
