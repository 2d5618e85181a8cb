// SPDX-License-Identifier: Apache-2.0
#include "present/commands/camera_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/base/error.h"
#include "host/base/system/read_text.h"
#include "present/cli/scene_choice.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

double finite_number(const Json& value, const std::string& where) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
        throw Error(fmt::format("{} is {}, must be a number", where, value.dump()));
    }
    return value.get<double>();
}

glm::dvec3 point_of(const Json& value, const std::string& where) {
    if (!value.is_array() || value.size() != 3) {
        throw Error(fmt::format("{} is {}, must be [x, y, z]", where, value.dump()));
    }
    glm::dvec3 out;
    for (int i = 0; i < 3; ++i) out[i] = finite_number(value[static_cast<std::size_t>(i)], where);
    return out;
}

CameraKey key_of(const Json& json, const std::string& where, double angle) {
    if (!json.is_object()) throw Error(where + " is no object");
    CameraKey key;
    key.angle = angle;
    for (const auto& [name, value] : json.items()) {
        const std::string member = where + ": " + name;
        if (name == "time") {
            key.time = finite_number(value, member);
        } else if (name == "position") {
            key.position = point_of(value, member);
        } else if (name == "focal_point") {
            key.focal_point = point_of(value, member);
        } else if (name == "angle") {
            key.angle = finite_number(value, member);
            if (key.angle > 0.0 && key.angle < 180.0) continue;
            throw Error(fmt::format("{} is {}, must be above 0 and below 180", member, key.angle));
        } else {
            throw Error(member + ": keys have time, position, focal_point and angle");
        }
    }
    for (const char* name : {"time", "position", "focal_point"}) {
        if (!json.contains(name)) throw Error(fmt::format("{} has no {}", where, name));
    }
    if (key.position == key.focal_point) {
        throw Error(where + ": position and focal_point are the same point");
    }
    return key;
}

}  // namespace

std::vector<CameraKey> read_camera_keys(const std::filesystem::path& file, double angle) {
    Json json;
    try {
        json = Json::parse(read_text(file));
    } catch (const Json::parse_error& error) {
        throw Error(fmt::format("{}: no JSON, at byte {}", file.string(), error.byte));
    }
    if (!json.is_array() || json.empty()) {
        throw Error(file.string() + ": must be a list of at least one key");
    }
    std::vector<CameraKey> keys;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string where = fmt::format("{}: key {}", file.string(), i);
        keys.push_back(key_of(json[i], where, angle));
        if (i > 0 && !(keys[i].time > keys[i - 1].time)) {
            throw Error(fmt::format("{}: time is {}, must be above {}, that of the key before",
                                    where, keys[i].time, keys[i - 1].time));
        }
    }
    return keys;
}

CameraMotion::CameraMotion(const SharedOptions& shared, const OutputOptions& output)
    : shared_(shared), output_(output) {
    constexpr double kUsualAngle = 45.0;
    if (output.camera_keys.empty()) return;
    path_.emplace(
        read_camera_keys(output.camera_keys, shared.camera.view_angle.value_or(kUsualAngle)));
}

Camera CameraMotion::at(const Scene& scene, int frame, double time) const {
    const RenderSettings& s = shared_.settings;
    const double aspect = static_cast<double>(s.width) / s.height;
    CameraChoice choice = shared_.camera;
    if (path_) {
        const CameraKey key = path_->at(time);
        choice.position = key.position;
        choice.focal_point = key.focal_point;
        choice.view_angle = key.angle;
    }
    const Camera camera = choose_camera(choice, scene, aspect);
    if (!output_.turntable) return camera;
    const Box box = resting_bounds(scene);
    const FrameList& frames = *output_.frames;
    const double done = static_cast<double>(frame) - frames.first();
    const double all = static_cast<double>(frames.last()) - frames.first() + 1.0;
    return turned(camera, box.empty() ? glm::dvec3(0.0) : box.center(),
                  *output_.turntable * done / all);
}

}  // namespace kilolux
