// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "host/scene/export/export_scene.h"
#include "host/scene/scene.h"

namespace kilolux {

/// A scene with everything that an export can hold: lights of all types, both kinds of cameras,
/// materials with every member off its default, textures, samplers, mirrored and sheared instances.
Scene scene_of_everything();

/// Writes all files of an exported scene into a folder.
void write_export(const ExportedScene& exported, const std::filesystem::path& folder);

/// The first difference of two scenes, bit for bit; "" for none. Names are not compared.
std::string scene_difference(const Scene& a, const Scene& b);

}  // namespace kilolux
