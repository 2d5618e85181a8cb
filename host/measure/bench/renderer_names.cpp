// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/renderer_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/base/error.h"

namespace kilolux {

namespace {

constexpr const char* kNames[] = {"deferred", "forward-plus", "forward", "deferred-all"};

}  // namespace

std::string renderer_name(RendererKind renderer) {
    return kNames[static_cast<std::size_t>(renderer)];
}

RendererKind renderer_of_name(std::string_view name) {
    const auto* found = std::find(std::begin(kNames), std::end(kNames), name);
    if (found == std::end(kNames)) throw Error(fmt::format("'{}' is no renderer", name));
    return static_cast<RendererKind>(found - std::begin(kNames));
}

}  // namespace kilolux
