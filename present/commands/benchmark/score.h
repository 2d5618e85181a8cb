// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "present/cli/options.h"
#include "present/program.h"

namespace kilolux {

struct ScoreOptions {
    ScoreOptions() { shared.scene.clear(); }
    SharedOptions shared;           // no scene where `reference` is given
    std::filesystem::path picture;  // linear, of any renderer
    std::filesystem::path reference;
    bool inverse_square = false;  // lights have no ranges
    bool json = false;
    bool operator==(const ScoreOptions&) const = default;
};

void visit_settings(ScoreOptions& options, const SettingVisitor& visit);
void add_score_options(CLI::App& command, ScoreOptions& options);
void add_score_command(Program& program);

}  // namespace kilolux
