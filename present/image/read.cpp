// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "host/base/error.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw Error(file.string() + ": cannot read the image: " + reason);
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored
    auto in = OIIO::ImageInput::open(file.string(), &config);
    if (!in) fail(file, OIIO::geterror());
    return in;
}

// Codes of integer formats as the nearest float of code / largest, whatever the reader's
// arithmetic.
void snap_to_codes(std::vector<float>& values, float largest) {
    for (float& value : values) value = std::round(value * largest) / largest;
}

}  // namespace

FloatImage read_image(const std::filesystem::path& file) {
    const auto in = open_image(file);
    const OIIO::ImageSpec& spec = in->spec();
    FloatImage image{spec.width, spec.height, {}, {}};
    const auto is_id = [&spec](int c) { return spec.channelformat(c) == OIIO::TypeDesc::UINT32; };
    std::size_t floats = 0;
    for (int c = 0; c < spec.nchannels; ++c) floats += is_id(c) ? 0 : 1;
    image.values.resize(spec.image_pixels() * floats);
    const auto read = [&](int begin, int end, OIIO::TypeDesc type, void* out, std::size_t count) {
        const auto stride = static_cast<OIIO::stride_t>(count * type.size());
        if (!in->read_image(0, 0, begin, end, type, out, stride)) fail(file, in->geterror());
    };
    for (int begin = 0, end = 0; begin < spec.nchannels; begin = end) {
        // Channels of floats are read in runs, ids one by one.
        end = begin + 1;
        while (!is_id(begin) && end < spec.nchannels && !is_id(end)) ++end;
        const std::vector<std::string> names(spec.channelnames.begin() + begin,
                                             spec.channelnames.begin() + end);
        if (is_id(begin)) {
            Layer layer{names[0], names};
            layer.ids.resize(spec.image_pixels() * names.size());
            read(begin, end, OIIO::TypeDesc::UINT32, layer.ids.data(), names.size());
            image.ids.push_back(std::move(layer));
        } else {
            float* first = image.values.data() + image.channels.size();
            read(begin, end, OIIO::TypeDesc::FLOAT, first, floats);
            image.channels.insert(image.channels.end(), names.begin(), names.end());
        }
    }
    if (spec.format == OIIO::TypeDesc::UINT8) snap_to_codes(image.values, 255.0f);
    if (spec.format == OIIO::TypeDesc::UINT16) snap_to_codes(image.values, 65535.0f);
    return image;
}

std::pair<int, int> image_size(const std::filesystem::path& file) {
    const auto in = open_image(file);
    return {in->spec().width, in->spec().height};
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
