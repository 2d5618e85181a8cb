// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "host/scene/camera_path.h"
#include "present/cli/output_options.h"

namespace kilolux {

/// The keys of a JSON file: a list of {"time", "position", "focal_point", "angle"}, angles [degree]
/// optional, else `angle`. Throws Error with file, key and what is wrong.
std::vector<CameraKey> read_camera_keys(const std::filesystem::path& file, double angle);

/// The camera of each frame of a sequence: that of the options, turned or on the way that
/// --turntable or --camera-keys asks for. A closed form of frame and time.
class CameraMotion {
 public:
    CameraMotion(const SharedOptions& shared, const OutputOptions& output);

    /// Throws Error as choose_camera() does.
    Camera at(const Scene& scene, int frame, double time) const;

 private:
    const SharedOptions& shared_;
    const OutputOptions& output_;
    std::optional<CameraPath> path_;
};

}  // namespace kilolux
