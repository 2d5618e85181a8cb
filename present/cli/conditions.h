// SPDX-License-Identifier: Apache-2.0
// The conditions that results depend on, kept with the tables of bench and report and with the
// choices of --max-error.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "present/cli/options.h"

namespace kilolux {

/// A text that changes with the content of files that change the picture: those that `settings`
/// name, which are the `shared` ones at least, every file that the scene's names (buffers, images,
/// IES profiles), and `more`. Empty where there is none. The folder does not matter. Throws Error
/// where reading the scene's file needs more than the bound of memory.
std::string input_content(const SharedOptions& shared, const std::vector<Setting>& settings,
                          const std::vector<std::filesystem::path>& more = {});

/// input_content(); of a generated scene without files its name.
std::string scene_content(const SharedOptions& shared);

/// A value as a JSON number, true or false where it is one, else as its text.
nlohmann::ordered_json value_json(const Setting& setting);

/// Every shared option that changes picture or time, by its word.
nlohmann::ordered_json settings_json(SharedOptions shared);

/// Program, scene, camera and settings.
nlohmann::ordered_json conditions_json(const SharedOptions& shared, const Scene& scene,
                                       const Camera& camera);

nlohmann::ordered_json program_json();

/// The first entry in which two documents differ, with both values; empty: none.
std::string first_difference(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);

}  // namespace kilolux
