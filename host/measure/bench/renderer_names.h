// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/render/settings.h"

namespace kilolux {

/// The name of a renderer on the command line and in files.
std::string renderer_name(RendererKind renderer);

/// Throws Error for an unknown name.
RendererKind renderer_of_name(std::string_view name);

}  // namespace kilolux
