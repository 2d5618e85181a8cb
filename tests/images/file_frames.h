// SPDX-License-Identifier: Apache-2.0
// Frames that tests write to files.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "host/picture/frame.h"

namespace kilolux {

// Not a multiple of anything, and more rows than EXR's blocks and TIFF's strips have.
inline constexpr int kFileWidth = 37;
inline constexpr int kFileHeight = 51;
inline constexpr std::size_t kFilePixels = std::size_t{kFileWidth} * kFileHeight;

inline Layer make_layer(const std::string& name, std::vector<std::string> channels, bool is_id) {
    Layer layer{name, std::move(channels)};
    for (std::size_t i = 0; i < kFilePixels * layer.channels.size(); ++i) {
        if (is_id) {
            layer.ids.push_back(16777217u + static_cast<std::uint32_t>(i) * 2'000'003u);
        } else {
            layer.values.push_back(std::sin(static_cast<float>(i)) * 1e4f);
        }
    }
    return layer;
}

inline Frame make_frame() {
    Frame frame;
    frame.width = kFileWidth;
    frame.height = kFileHeight;
    for (std::size_t i = 0; i < kFilePixels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            frame.radiance.push_back(std::exp(std::sin(static_cast<float>(3 * i + c)) * 8.0f));
            frame.display.push_back(static_cast<std::uint8_t>((i * 7 + c * 31) % 256));
        }
        frame.display.push_back(255);
    }
    // Values that a file of light must keep: unclamped, negative, infinite, smallest.
    frame.radiance[0] = 1e30f;
    frame.radiance[1] = -2.5f;
    frame.radiance[2] = std::numeric_limits<float>::infinity();
    frame.radiance[3] = std::numeric_limits<float>::denorm_min();
    return frame;
}

inline Frame make_layered_frame() {
    Frame frame = make_frame();
    frame.aovs = {make_layer("depth", {"Z"}, false),
                  make_layer("position", {"P.X", "P.Y", "P.Z"}, false),
                  make_layer("normal", {"N.X", "N.Y", "N.Z"}, false),
                  make_layer("albedo", {"albedo.R", "albedo.G", "albedo.B"}, false),
                  make_layer("roughness", {"roughness"}, false),
                  make_layer("metallic", {"metallic"}, false),
                  make_layer("emissive", {"emissive.R", "emissive.G", "emissive.B"}, false),
                  make_layer("light-count", {"light-count"}, true),
                  make_layer("cluster", {"cluster"}, true)};
    return frame;
}

}  // namespace kilolux
