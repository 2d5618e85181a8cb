// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/meshopt_vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace kilolux {
namespace {

constexpr unsigned char kFormat1 = 0xa1;
constexpr std::size_t kLeastTail = 24;  // [byte]
constexpr std::size_t kGroup = 16;      // elements

// Takes bytes from the front; afterwards none, once there are too few.
class Source {
 public:
    explicit Source(ByteSpan bytes) : bytes_(bytes) {}

    ByteSpan take(std::size_t count) {
        static constexpr std::array<unsigned char, 256> kZeros{};
        is_whole_ = is_whole_ && count <= bytes_.size();
        if (!is_whole_) return ByteSpan(kZeros).first(count);
        const ByteSpan out = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return out;
    }

    bool is_whole() const { return is_whole_; }
    bool is_used_up() const { return is_whole_ && bytes_.empty(); }

 private:
    ByteSpan bytes_;
    bool is_whole_ = true;
};

// Deltas of `bits` bits; the largest of these says that a whole byte follows.
void read_group(Source& source, unsigned bits, unsigned char* out) {
    if (bits == 0) return;
    const ByteSpan packed = source.take(kGroup * bits / 8);
    const unsigned sentinel = (1u << bits) - 1;
    for (unsigned i = 0; i < kGroup; ++i) {
        const unsigned place = i * bits % 8;
        const unsigned shift = bits == 1 ? place : 8 - bits - place;  // single bits from the lowest
        const unsigned value = packed[i * bits / 8] >> shift & sentinel;
        const bool is_far = bits < 8 && value == sentinel;
        out[i] = static_cast<unsigned char>(is_far ? source.take(1)[0] : value);
    }
}

// The deltas of one byte of `count` elements, in a control mode; `out` is zero.
void read_plane(Source& source, unsigned control, std::size_t count, unsigned char* out) {
    constexpr unsigned kBits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    if (control == 2) return;
    if (control == 3) {
        std::ranges::copy(source.take(count), out);
        return;
    }
    const std::size_t groups = (count + kGroup - 1) / kGroup;
    const ByteSpan header = source.take((groups + 3) / 4);
    for (std::size_t g = 0; g < groups && source.is_whole(); ++g) {
        read_group(source, kBits[control][header[g / 4] >> g % 4 * 2 & 3], out + g * kGroup);
    }
}

// Zigzag codes of `T`, the sign in the lowest bit.
template <typename T>
T signed_delta(T code) {
    return static_cast<T>((code & 1) != 0 ? ~(code >> 1) : code >> 1);
}

template <typename T>
void add_deltas(unsigned char* value, const unsigned char* delta) {
    for (std::size_t at = 0; at < 4; at += sizeof(T)) {
        T v, d;
        std::memcpy(&v, value + at, sizeof v);
        std::memcpy(&d, delta + at, sizeof d);
        v = static_cast<T>(v + signed_delta(d));
        std::memcpy(value + at, &v, sizeof v);
    }
}

// Turns the 4 bytes of the last element into those of the next.
void apply_delta(unsigned char mode, unsigned char* value, const unsigned char* delta) {
    if (mode == 0) return add_deltas<std::uint8_t>(value, delta);
    if (mode == 1) return add_deltas<std::uint16_t>(value, delta);
    std::uint32_t v, d;
    std::memcpy(&v, value, sizeof v);
    std::memcpy(&d, delta, sizeof d);
    v ^= std::rotr(d, mode >> 4);
    std::memcpy(value, &v, sizeof v);
}

bool is_channel_mode(unsigned char mode) { return mode < 2 || (mode & 15) == 2; }

template <typename T>
void undo_color(unsigned char* element) {
    std::array<T, 4> in;
    std::memcpy(in.data(), element, sizeof in);
    using Signed = std::make_signed_t<T>;
    const int y = in[0], co = static_cast<Signed>(in[1]), cg = static_cast<Signed>(in[2]);
    const int most = (1 << std::bit_width(in[3])) - 1;
    const int half = in[3] & most >> 1;
    const double scale = std::numeric_limits<T>::max() / static_cast<double>(std::max(most, 1));
    const std::array rgba = {y + co - cg, y + cg, y - co - cg, half << 1 | (half & 1)};
    for (std::size_t c = 0; c < 4; ++c) {
        in[c] = static_cast<T>(std::lround(std::clamp(rgba[c], 0, most) * scale));
    }
    std::memcpy(element, in.data(), sizeof in);
}

}  // namespace

bool is_vertex_format_1(ByteSpan source) { return !source.empty() && source[0] == kFormat1; }

bool decode_vertex_format_1(ByteSpan source, std::size_t stride, std::span<unsigned char> out) {
    const std::size_t channels = stride / 4;
    const std::size_t tail = stride + channels;
    if (source.size() < 1 + std::max(tail, kLeastTail)) return false;
    const ByteSpan modes = source.last(channels);
    if (!std::ranges::all_of(modes, is_channel_mode)) return false;
    std::array<unsigned char, 256> value{};
    std::ranges::copy(source.last(tail).first(stride), value.begin());
    Source data(source.first(source.size() - std::max(tail, kLeastTail)).subspan(1));
    const std::size_t most = std::min<std::size_t>(8192 / stride & ~(kGroup - 1), 256);
    std::vector<unsigned char> planes;
    for (std::size_t left = out.size() / stride; left > 0 && data.is_whole();) {
        const std::size_t count = std::min(left, most);
        const ByteSpan control = data.take(channels);
        planes.assign(stride * most, 0);
        for (std::size_t k = 0; k < stride; ++k) {
            read_plane(data, control[k / 4] >> k % 4 * 2 & 3, count, &planes[k * most]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < channels; ++c) {
                unsigned char delta[4];
                for (std::size_t b = 0; b < 4; ++b) delta[b] = planes[(4 * c + b) * most + i];
                apply_delta(modes[c], &value[4 * c], delta);
            }
            std::memcpy(&out[out.size() - (left - i) * stride], value.data(), stride);
        }
        left -= count;
    }
    return data.is_used_up();
}

void undo_color_filter(std::span<unsigned char> elements, std::size_t stride) {
    for (std::size_t at = 0; at < elements.size(); at += stride) {
        stride == 4 ? undo_color<std::uint8_t>(&elements[at])
                    : undo_color<std::uint16_t>(&elements[at]);
    }
}

}  // namespace kilolux
