// SPDX-License-Identifier: Apache-2.0
#include "host/scene/export/buffer.h"

#include <algorithm>
#include <limits>

namespace kilolux {
namespace {

// glTF 2.0's codes.
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

using Json = nlohmann::ordered_json;

template <typename T>
std::span<const unsigned char> bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const unsigned char*>(values.data()), values.size_bytes()};
}

// Least and largest of each component; doubles, as JSON writes them exactly.
void add_bounds(Json& accessor, std::span<const float> values, std::size_t components) {
    std::vector<double> least(components, std::numeric_limits<double>::infinity());
    std::vector<double> largest(components, -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double value = values[i];
        least[i % components] = std::min(least[i % components], value);
        largest[i % components] = std::max(largest[i % components], value);
    }
    accessor["min"] = least;
    accessor["max"] = largest;
}

}  // namespace

int ExportBuffer::add_bytes(std::span<const unsigned char> bytes) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);  // as the alignment of all that follows
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return static_cast<int>(views_.size()) - 1;
}

int ExportBuffer::add_accessor(Json accessor) {
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
}

int ExportBuffer::add_vertices(std::span<const float> values, int components, bool bounded) {
    constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto width = static_cast<std::size_t>(components);
    Json accessor{{"bufferView", add_bytes(bytes_of(values))},
                  {"componentType", kFloat},
                  {"count", values.size() / width},
                  {"type", kTypes[width - 1]}};
    views_.back()["target"] = kVertexTarget;
    if (bounded) add_bounds(accessor, values, width);
    return add_accessor(std::move(accessor));
}

int ExportBuffer::add_indices(std::span<const std::uint32_t> indices) {
    // The largest 16-bit value restarts primitives and is not an index.
    const bool narrow = std::all_of(indices.begin(), indices.end(), [](std::uint32_t i) {
        return i < std::numeric_limits<std::uint16_t>::max();
    });
    int view = 0;
    if (narrow) {
        const std::vector<std::uint16_t> shorts(indices.begin(), indices.end());
        view = add_bytes(bytes_of(std::span<const std::uint16_t>(shorts)));
    } else {
        view = add_bytes(bytes_of(indices));
    }
    views_.back()["target"] = kIndexTarget;
    return add_accessor({{"bufferView", view},
                         {"componentType", narrow ? kUnsignedShort : kUnsignedInt},
                         {"count", indices.size()},
                         {"type", "SCALAR"}});
}

}  // namespace kilolux
