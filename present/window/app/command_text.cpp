// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/command_text.h"

#include <fmt/format.h>

#include "host/base/text.h"
#include "present/cli/names.h"
#include "present/cli/option_values.h"
#include "present/cli/scene_choice.h"

namespace kilolux {

std::string camera_options(const CameraRig& rig, const SharedOptions& first, const Scene& scene) {
    const Camera& camera = rig.camera();
    const Camera start = choose_camera(first, scene);
    std::string out;
    if (first.camera.view != SeenFrom::automatic) out = " --view " + name_of(first.camera.view);
    const bool stays = rig.is_unmoved() && camera.position == start.position &&
                       camera.world_from_view == start.world_from_view;
    if (stays && first.camera.index) {
        out += fmt::format(" --camera-index {}", *first.camera.index);
    }
    if (stays && first.camera.framed) out += " --camera-index auto";
    if (stays && first.camera.fit != Fit::both) out += " --fit " + name_of(first.camera.fit);
    const bool named = first.camera.position || first.camera.focal_point || first.camera.view_up;
    if (!stays || named) {
        const glm::dvec3 up = camera.world_from_view[1];
        out += " --camera-position " + text_of(camera.position) + " --camera-focal-point " +
               text_of(rig.focal_point());
        if (rig.is_unmoved()) out += " --camera-view-up " + text_of(up);
    }
    if (!stays || first.camera.view_angle) {
        out += " --camera-view-angle " + text_of(glm::degrees(camera.y_fov));
    }
    if (camera.orthographic && first.camera.orthographic) out += " --camera-orthographic";
    return out.empty() ? out : out.substr(1);
}

std::string render_command(const CameraRig& rig, const SharedOptions& options, const Scene& scene) {
    SharedOptions said = options;
    said.camera = {};                 // camera_options() writes it
    said.settings.want.aovs.clear();  // a PNG has no layers
    if (said.settings.light_mix.gains.empty()) said.light_groups.clear();
    SharedOptions defaults;
    const std::string out =
        "kilolux render " + shell_word(options.scene) +
        option_words(settings_of(said), settings_of(defaults), Changes::neither);
    const std::string camera = camera_options(rig, options, scene);
    return fmt::format("{}{}{} -o kilolux.png", out, camera.empty() ? "" : " ", camera);
}

}  // namespace kilolux
