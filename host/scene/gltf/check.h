// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "host/scene/gltf/json/json_text.h"

namespace kilolux {

/// Parses and checks a glTF file's JSON, so that its readers meet only the types, ranges and
/// indices that the rules promise; a whole number written as 3.0 becomes an integer.
///
/// Throws Error "<name>: accessors[7].count is "x", must be an integer from 0 to ...".
nlohmann::json parse_gltf_json(const JsonText& text, const std::string& name);

}  // namespace kilolux
