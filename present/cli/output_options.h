// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/cli/options.h"

namespace kilolux {

/// Options of commands that write pictures.
struct OutputOptions {
    Encoding encoding;
    std::filesystem::path output;
    OcioOptions ocio;
    std::optional<FrameList> frames;
    double frames_per_second = 24.0;
    Shard shard;
    std::optional<PixelRect> crop;
    std::optional<TileGrid> tiles;
    std::optional<double> turntable;    // [degree] over the frames
    std::filesystem::path camera_keys;  // empty: none
    bool skip_existing = false;
    std::string stats;  // file, "-" for stdout, empty: none
    std::string reference;
    std::optional<double> threshold;
    std::string metric = "rmse";
    std::filesystem::path difference;  // empty: none
    bool mixed_devices = false;
    bool operator==(const OutputOptions&) const = default;
};

/// Width and height of what is written of the picture [pixel].
std::pair<int, int> written_size(const RenderSettings& settings,
                                 const std::optional<PixelRect>& crop);

/// The extensions of pictures and videos.
std::vector<std::string> output_extensions();

/// As those of SharedOptions.
void visit_settings(OutputOptions& options, const SettingVisitor& visit);

/// Throws UsageError for options that exclude or need each other.
void check_output_options(const SharedOptions& shared, const OutputOptions& options);

}  // namespace kilolux
