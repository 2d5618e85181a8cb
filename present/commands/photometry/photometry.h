// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "present/cli/options.h"
#include "present/commands/photometry/points_choice.h"
#include "present/program.h"

namespace kilolux {

struct PhotometryOptions {
    SharedOptions shared;
    std::filesystem::path points;  // CSV; empty: `plane`
    MeasuringGrid plane;
    std::optional<std::uint64_t> exact_points;  // most that float64 computes; none: automatic
    std::filesystem::path output;               // .csv or .json; empty: standard output alone
    bool json = false;
    bool operator==(const PhotometryOptions&) const = default;
};

void visit_settings(PhotometryOptions& options, const SettingVisitor& visit);
void add_photometry_options(CLI::App& command, PhotometryOptions& options);
void add_photometry_command(Program& program);

}  // namespace kilolux
