// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

namespace kilolux {

/// Which buffers and buffer views any part of a file names that could be read. The others may be
/// broken: nothing reads them.
struct UsedParts {
    std::vector<bool> buffers;
    std::vector<bool> views;
};

/// Of a file's JSON that parse_gltf_json() checked.
UsedParts used_parts(const nlohmann::json& root);

}  // namespace kilolux
