// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/cli/options.h"
#include "present/program.h"

namespace kilolux {

struct InfoOptions {
    SharedOptions shared;
    bool json = false;
    bool costs = false;
    bool measure_limits = false;
    bool check_limits = false;
    bool operator==(const InfoOptions&) const = default;
};

void visit_settings(InfoOptions& options, const SettingVisitor& visit);
void add_info_command(Program& program);

}  // namespace kilolux
