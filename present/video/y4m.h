// SPDX-License-Identifier: Apache-2.0
// YUV4MPEG2 streams: a line of text, then frames of planes. Read by ffmpeg, mpv, x264, aomenc, ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kilolux {

/// Size and pace of a video.
struct VideoFormat {
    int width = 0;                   // [pixel]
    int height = 0;                  // [pixel]
    double frames_per_second = 0.0;  // > 0
};

/// A ratio of whole numbers.
struct Ratio {
    std::uint32_t numerator = 0;
    std::uint32_t denominator = 1;
};

/// The ratio of the smallest terms within 1e-9 of `value`, relative, where 31 bits hold it, else
/// a near one; 0 < value < 2^31.
Ratio ratio_of(double value);

/// The stream's first line: 4:4:4, 8 bits, progressive, square pixels. Parameters that begin with X
/// say what the format has no place for: codes of limited range by the matrix of BT.709, and, in
/// hexadecimal digits, the hash of a note. At most 95 bytes, which is what ffmpeg reads.
std::string y4m_header(const VideoFormat& format, const std::string& note = {});

/// Makes the planes Y', Cb and Cr, one after the other, of display codes R, G, B, A. Each code is
/// the nearest to ITU-R BT.709-6, 3.2 to 3.5: Y' 16 to 235, Cb and Cr 16 to 240.
using PlaneMaker = void (*)(const std::uint8_t* rgba, std::size_t pixels, char* planes);

/// The makers that this processor can run, the fastest last; they give the same bits.
std::span<const PlaneMaker> plane_makers();

/// Replaces `out` by a frame of display codes R, G, B, A: "FRAME\n" and its planes.
void y4m_frame(std::span<const std::uint8_t> rgba, std::string& out);

}  // namespace kilolux
