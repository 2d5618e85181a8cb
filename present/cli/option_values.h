// SPDX-License-Identifier: Apache-2.0
// Values of the command line, from text. All throw UsageError: "--option: 'text' is not <what it
// must be>".
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/scene/gltf/load_scene.h"
#include "present/cli/sequence.h"

namespace kilolux {

/// What a picture shows behind the scene.
struct BackgroundChoice {
    enum class Kind { environment, none, color } kind = Kind::environment;
    glm::vec3 color{0.0f};  // linear Rec. 709 radiance
    bool as_shown = false;  // color is what the display shows, not light
    bool operator==(const BackgroundChoice&) const = default;
};

/// Numbers that an option takes; the ends belong to the range unless `open`.
struct NumberRange {
    double min = -std::numeric_limits<double>::max();
    double max = std::numeric_limits<double>::max();
    bool open = false;
};

struct CountRange {
    std::uint64_t min = 0;
    std::uint64_t max = 0;
};

// Ranges of the settings that options and the window's saved values share.
inline constexpr double kMaxFloat = std::numeric_limits<float>::max();

inline constexpr NumberRange kAboveZeroRange{0.0, kMaxFloat, true};
inline constexpr NumberRange kZeroOrAboveRange{0.0, kMaxFloat};
inline constexpr NumberRange kExposureRange{-126.0, 126.0};  // [EV]
inline constexpr NumberRange kBloomRange{0.0, 1.0};
inline constexpr NumberRange kShareRange{0.0, 1.0};
inline constexpr NumberRange kAmbientRange = kZeroOrAboveRange;

inline constexpr CountRange kEdgeRange{1, 65536};  // of a picture [pixel]
inline constexpr CountRange kSamplesRange{1, 65536};
inline constexpr CountRange kAutoSamplesRange{8, 65536};
inline constexpr CountRange kAnisotropyRange{1, 16};
inline constexpr CountRange kShadowRaysRange{1, 65536};
inline constexpr CountRange kSeedRange{0, 4294967295};
// 31 bits: indices of lights and offsets of lists have 32 on the device.
inline constexpr CountRange kLightsRange{0, std::uint64_t{1} << 31};
inline constexpr CountRange kLightSeedRange{0, std::numeric_limits<std::uint64_t>::max()};
inline constexpr CountRange kTilesRange{1, 4096};
inline constexpr CountRange kSlicesRange{1, 64};  // per octave of depth

bool contains(const NumberRange& range, double value);
bool contains(const CountRange& range, double value);

/// A finite number within `range`; `or_auto`: 0 for "auto".
double parse_number(const std::string& option, std::string_view text, const NumberRange& range = {},
                    bool or_auto = false);

/// A whole number within `range`; also as "5k", "2M" (powers of 1000) or "1e6"; `or_auto`: 0 for
/// "auto".
std::uint64_t parse_count(const std::string& option, std::string_view text, const CountRange& range,
                          bool or_auto = false);

/// Bytes as "512M", "4G" (K, M, G, T are powers of 1024) or a plain number, at least 1; "auto": 0.
std::uint64_t parse_bytes(const std::string& option, std::string_view text);

/// `size` whole numbers within `range`, separated by commas; `form` is how they are written: "W,H".
std::vector<int> parse_counts(const std::string& option, std::string_view text,
                              std::string_view form, const CountRange& range);

/// "auto": the environment; "none"; "R,G,B": light, each at least 0; "#RRGGBB" or "RRGGBB":
/// what the display shows, in sRGB.
BackgroundChoice parse_background(const std::string& option, std::string_view text);

/// Width and height "W,H" or "WxH", each from 1 to 65536 [pixel].
std::pair<int, int> parse_resolution(const std::string& option, std::string_view text);

/// Tiles across and down, and slices for each doubling of depth: "X,Y,SLICES_PER_OCTAVE".
std::array<int, 3> parse_grid(const std::string& option, std::string_view text);

/// A power of two from 1 to 16, or 0 for "auto".
int parse_lanes(const std::string& option, std::string_view text);

/// Three numbers "X,Y,Z".
glm::dvec3 parse_vector(const std::string& option, std::string_view text);

/// Six numbers "x0,y0,z0,x1,y1,z1", each upper one at least the lower one.
Box parse_box(const std::string& option, std::string_view text);

/// Metres, or with a "%" a share of the scene's diagonal; above 0.
LineWidth parse_line_width(const std::string& option, std::string_view text);

/// Texts separated by commas, none of them empty.
std::vector<std::string> parse_list(const std::string& option, std::string_view text);

/// Frames "A:B", A <= B, or a list of frames and ranges in ascending order: "1-99x2,105".
FrameList parse_frames(const std::string& option, std::string_view text);

/// A part of a picture "X,Y,W,H" [pixel]; W and H at least 1.
PixelRect parse_crop(const std::string& option, std::string_view text);

/// "CxR": columns and rows, each from 1 to 256.
TileGrid parse_tiles(const std::string& option, std::string_view text);

/// Shard "I/N", 0 <= I < N; "auto" and "auto/N": see shard_of_task().
Shard parse_shard(const std::string& option, std::string_view text);

/// The index of a name in `names`; the message lists them and the nearest.
std::size_t parse_name(const std::string& option, std::string_view text,
                       const std::vector<std::string>& names);

/// Names of `names` separated by commas, each once, in the order given.
std::vector<std::string> parse_name_list(const std::string& option, std::string_view text,
                                         const std::vector<std::string>& names);

/// The text that an option reads back as the same value; empty for a value that was not given.
std::string text_of(const LineWidth& width);
std::string text_of(const std::vector<std::string>& words);
template <typename Number>
requires std::is_arithmetic_v<Number> std::string text_of(Number value) {
    return fmt::to_string(value);
}
std::string text_of(const glm::dvec3& value);
std::string text_of(const Box& value);
std::string text_of(const BackgroundChoice& value);
std::string text_of(const FrameList& frames);
std::string text_of(const Shard& shard);
std::string text_of(const PixelRect& rect);
std::string text_of(const TileGrid& tiles);
inline std::string text_of(const std::string& value) { return value; }
template <typename T>
requires requires(const T& value) { text_of(value); }
std::string text_of(const std::optional<T>& value) { return value ? text_of(*value) : ""; }

}  // namespace kilolux
