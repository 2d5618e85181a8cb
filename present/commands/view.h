// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "present/cli/options.h"
#include "present/program.h"
#include "present/window/serve/page_server.h"

namespace kilolux {

struct ViewOptions {
    SharedOptions shared;
    std::uint64_t exit_after = 0;  // pictures; 0: never
    std::string screenshot;
    std::string script;
    bool fresh = false;
    std::optional<ServeAddress> serve;  // in a browser; none: in a window
    ServerOptions server;               // its address is not used: see `serve`
    bool operator==(const ViewOptions&) const = default;
};

void visit_settings(ViewOptions& options, const SettingVisitor& visit);
void add_view_options(CLI::App& command, ViewOptions& options);
void add_view_command(Program& program);

}  // namespace kilolux
