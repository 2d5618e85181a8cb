// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "host/base/error.h"
#include "host/base/half.h"
#include "present/image/encode.h"

namespace kilolux {
namespace {

// CIE xy of red, green, blue and white of Rec. 709 (ITU-R BT.709-6, 1.3 and 1.4).
constexpr float kRec709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

// Column-major with column vectors is, byte for byte, the row-major with row vectors of OpenEXR.
void set_matrix(OIIO::ImageSpec& spec, const char* name, const glm::dmat4& matrix) {
    const glm::mat4 narrow(matrix);
    spec.attribute(name, OIIO::TypeDesc::TypeMatrix, &narrow[0][0]);
}

void describe_camera(OIIO::ImageSpec& spec, const Camera& camera, const Frame& frame) {
    glm::dmat4 view_from_world(glm::transpose(camera.world_from_view));
    view_from_world[3] = glm::dvec4(glm::dmat3(view_from_world) * -camera.position, 1.0);
    set_matrix(spec, "worldToCamera", view_from_world);
    set_matrix(spec, "worldToNDC",
               clip_from_view(camera, frame.width, frame.height) * view_from_world);
}

void add_channel(OIIO::ImageSpec& spec, const std::string& name, const OIIO::TypeDesc& format) {
    for (const std::string& known : spec.channelnames) {
        if (known == name) throw Error("EXR: two layers have a channel '" + name + "'");
    }
    spec.channelnames.push_back(name);
    spec.channelformats.push_back(format);
    ++spec.nchannels;
}

// Copies interleaved values, `count` a pixel, into every pixel's slots from `offset` bytes on.
template <typename T>
void place(std::vector<unsigned char>& pixels, std::size_t offset, std::size_t pixel_bytes,
           const std::vector<T>& values, std::size_t count) {
    unsigned char* out = pixels.data() + offset;
    for (std::size_t i = 0; i < values.size(); i += count, out += pixel_bytes) {
        std::memcpy(out, &values[i], count * sizeof(T));
    }
}

std::vector<std::uint16_t> half_of(const std::vector<float>& values) {
    std::vector<std::uint16_t> out(values.size());
    std::transform(values.begin(), values.end(), out.begin(), half_bits_clamped);
    return out;
}

}  // namespace

OIIO::ImageSpec exr_spec(const Frame& frame, const ImageNotes& notes, const ImageOptions& options) {
    OIIO::ImageSpec spec(frame.width, frame.height, 0, OIIO::TypeDesc::FLOAT);
    const OIIO::TypeDesc colour =
        options.half_colour ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
    spec.channelnames.clear();
    for (const char* name : {"R", "G", "B"}) add_channel(spec, name, colour);
    for (const Layer& layer : frame.aovs) {
        for (const std::string& channel : layer.channels) {
            add_channel(spec, channel,
                        layer.is_id() ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
        }
    }
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kRec709);
    // OpenImageIO writes the hour as capDate unless there is a date; one that is no text is left
    // out, which it would remark on.
    spec.attribute("DateTime", 0);
    OIIO::attribute("debug", 0);
    if (notes.camera) describe_camera(spec, *notes.camera, frame);
    return spec;
}

std::vector<unsigned char> exr_pixels(const Frame& frame, const OIIO::ImageSpec& spec) {
    const std::size_t pixel_bytes = spec.pixel_bytes(true);
    std::vector<unsigned char> pixels(pixel_bytes * spec.image_pixels());
    std::size_t channel = 0;
    std::size_t offset = 0;
    const auto add = [&](const auto& values, std::size_t count) {
        if (values.size() != count * spec.image_pixels()) {
            throw Error(fmt::format("EXR: channel '{}' has {} values, needs {}",
                                    spec.channelnames[channel], values.size() / count,
                                    spec.image_pixels()));
        }
        place(pixels, offset, pixel_bytes, values, count);
        offset += count * sizeof values[0];
        channel += count;
    };
    if (spec.channelformats[0] == OIIO::TypeDesc::HALF) {
        add(half_of(frame.radiance), 3);
    } else {
        add(frame.radiance, 3);
    }
    for (const Layer& layer : frame.aovs) {
        if (layer.is_id()) {
            add(layer.ids, layer.channels.size());
        } else {
            add(layer.values, layer.channels.size());
        }
    }
    return pixels;
}

}  // namespace kilolux
