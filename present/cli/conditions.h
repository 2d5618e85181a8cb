// SPDX-License-Identifier: Apache-2.0
// What results depend on, for whatever keeps them: the tables of bench and report, the choices of
// --max-error.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "present/cli/options.h"

namespace kilolux {

/// A text that changes with what the files of the options hold: the scene's file, every file that
/// it names (buffers, images, IES profiles), and the environment. A generated scene is its name.
/// The folder does not matter.
std::string scene_content(const SharedOptions& shared);

/// A value as a JSON number, true or false where it is one, else as its text.
nlohmann::ordered_json value_json(const Setting& setting);

/// Every shared option that changes picture or time, by its word.
nlohmann::ordered_json settings_json(SharedOptions shared);

/// Program, scene, camera and settings.
nlohmann::ordered_json conditions_json(const SharedOptions& shared, const Scene& scene,
                                       const Camera& camera);

nlohmann::ordered_json program_json();

/// The first entry that two documents do not share or whose values differ, with both values;
/// empty: none.
std::string first_difference(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);

}  // namespace kilolux
