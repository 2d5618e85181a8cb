// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/command_text.h"

#include <charconv>

#include "present/cli/frame_summary.h"
#include "present/cli/names.h"

namespace kilolux {
namespace {

// The shortest text that reads back as the same float.
std::string float_text(float value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return {text, end};
}

std::string vector_text(const glm::dvec3& v) {
    return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

// In single quotes unless it is a plain word for a shell.
std::string quoted(const std::string& word) {
    const bool plain = word.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                           "0123456789_-./:,+@%") == std::string::npos;
    if (plain && !word.empty()) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

class OptionList {
 public:
    void add(const std::string& name, const std::string& value, const std::string& standard) {
        if (value != standard) text += " " + name + " " + quoted(value);
    }
    std::string text;
};

void add_picture(OptionList& list, const RenderSettings& s, const RenderSettings& d) {
    list.add("--renderer", name_of(s.renderer), name_of(d.renderer));
    list.add("--gbuffer", gbuffer_names().at(s.gbuffer), gbuffer_names().at(d.gbuffer));
    list.add("--shading", name_of(s.shading), name_of(d.shading));
    list.add("--ambient", float_text(s.ambient), float_text(d.ambient));
    list.add("--samples", std::to_string(s.samples), std::to_string(d.samples));
    list.add("--show", name_of(s.want.view), name_of(d.want.view));
    list.add("--bloom", float_text(s.bloom), float_text(d.bloom));
    list.add("--exposure", float_text(s.exposure), float_text(d.exposure));
    list.add("--tonemap", name_of(s.tone_curve), name_of(d.tone_curve));
    const auto grid = [](const GridSettings& g) {
        return std::to_string(g.tiles_x) + "," + std::to_string(g.tiles_y) + "," +
               std::to_string(g.slices_per_octave);
    };
    list.add("--grid", grid(s.grid), grid(d.grid));
    list.add("--lanes", std::to_string(s.kernels.lanes), "0");
    list.add("--device", s.device, d.device);
}

void add_lights(OptionList& list, const LightOptions& l, const LightOptions& d) {
    list.add("--lights", std::to_string(l.count), std::to_string(d.count));
    list.add("--light-seed", std::to_string(l.seed), std::to_string(d.seed));
    list.add("--light-radius", number_text(l.radius), "0");
    list.add("--light-intensity", number_text(l.intensity), "0");
    if (l.box.empty()) return;
    list.add("--light-box", vector_text(l.box.min) + "," + vector_text(l.box.max), "");
}

}  // namespace

std::string camera_options(const CameraRig& rig, const SharedOptions& first, const Scene& scene) {
    const Camera& camera = rig.camera();
    const Camera start = choose_camera(first.camera, scene);
    std::string out;
    const bool stays = rig.is_unmoved() && camera.position == start.position &&
                       camera.world_from_view == start.world_from_view;
    if (stays && first.camera.index) {
        out = " --camera-index " + std::to_string(*first.camera.index);
    }
    const bool named = first.camera.position || first.camera.focal_point || first.camera.view_up;
    if (!stays || named) {
        const glm::dvec3 up = camera.world_from_view[1];
        out += " --camera-position " + vector_text(camera.position) + " --camera-focal-point " +
               vector_text(rig.focal_point());
        if (rig.is_unmoved()) out += " --camera-view-up " + vector_text(up);
    }
    if (!stays || first.camera.view_angle) {
        out += " --camera-view-angle " + number_text(glm::degrees(camera.y_fov));
    }
    if (camera.orthographic && first.camera.orthographic) out += " --camera-orthographic";
    return out.empty() ? out : out.substr(1);
}

std::string render_command(const CameraRig& rig, const SharedOptions& options, const Scene& scene) {
    const SharedOptions standard;
    OptionList list;
    const RenderSettings& s = options.settings;
    list.add("--resolution", std::to_string(s.width) + "," + std::to_string(s.height), "1920,1080");
    add_picture(list, s, standard.settings);
    add_lights(list, s.lights, standard.settings.lights);
    list.add("--time", number_text(options.time), "0");
    const std::string camera = camera_options(rig, options, scene);
    return "kilolux render " + quoted(options.scene) + list.text +
           (camera.empty() ? "" : " " + camera) + " -o kilolux.png";
}

}  // namespace kilolux
