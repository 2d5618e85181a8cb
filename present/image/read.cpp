// SPDX-License-Identifier: Apache-2.0
#include "present/image/read.h"

#include <algorithm>
#include <cmath>

#include "host/base/error.h"
#include "host/images/images.h"

namespace kilolux {
namespace {

// Codes of integer formats as the nearest float of code / largest, whatever the reader's
// arithmetic.
void snap_to_codes(std::vector<float>& values, float largest) {
    for (float& value : values) value = std::round(value * largest) / largest;
}

bool is_code(const ImageChannel& channel) {
    return channel.type == SampleType::uint8 || channel.type == SampleType::uint16;
}

}  // namespace

FloatImage read_image(const std::filesystem::path& file) {
    const auto in = open_image(file);
    const ImageLayout& layout = in->layout();
    const int count = static_cast<int>(layout.channels.size());
    FloatImage image{layout.width, layout.height, {}, {}};
    const auto channel = [&layout](int c) { return layout.channels[static_cast<std::size_t>(c)]; };
    const auto is_id = [&](int c) { return channel(c).type == SampleType::uint32; };
    std::size_t floats = 0;
    for (int c = 0; c < count; ++c) floats += is_id(c) ? 0 : 1;
    image.values.resize(layout.pixels() * floats);
    for (int begin = 0, end = 0; begin < count; begin = end) {
        // Channels of floats are read in runs, ids one by one.
        end = begin + 1;
        while (!is_id(begin) && end < count && !is_id(end)) ++end;
        if (is_id(begin)) {
            Layer layer{channel(begin).name, {channel(begin).name}};
            layer.ids.resize(layout.pixels());
            in->read(begin, end, SampleType::uint32, layer.ids.data(), sizeof layer.ids[0]);
            image.ids.push_back(std::move(layer));
        } else {
            float* first = image.values.data() + image.channels.size();
            in->read(begin, end, SampleType::float32, first, floats * sizeof(float));
            for (int c = begin; c < end; ++c) image.channels.push_back(channel(c).name);
        }
    }
    const auto& channels = layout.channels;
    if (!channels.empty() && std::all_of(channels.begin(), channels.end(), is_code)) {
        snap_to_codes(image.values, channel(0).type == SampleType::uint8 ? 255.0f : 65535.0f);
    }
    return image;
}

std::pair<int, int> image_size(const std::filesystem::path& file) {
    const auto in = open_image(file);
    return {in->layout().width, in->layout().height};
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
