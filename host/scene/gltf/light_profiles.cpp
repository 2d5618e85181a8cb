// SPDX-License-Identifier: Apache-2.0
// EXT_lights_ies: photometric files, and the nodes that carry them.
#include "host/scene/gltf/light_profiles.h"

#include <algorithm>
#include <cmath>

#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/lights_cameras.h"
#include "host/scene/lights/photometry/photometry_file.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kMostTextBytes = std::uint64_t{16} << 20;  // a real file has some 50 kB

std::string read_text(const GltfDocument& document, const tinygltf::Value& light,
                      const std::string& where) {
    const auto uri = member_or<std::string>(light, "uri", "");
    const int view = member_or(light, "bufferView", -1);
    if (uri.empty() == (view < 0)) {
        document.fail(where, "must have either a uri or a bufferView");
    }
    if (view >= 0 && !light.Has("mimeType")) {
        document.fail(where, "has a bufferView but no mimeType");
    }
    const FileBytes file = read_source(document, uri, view, where);
    const auto bytes = file.bytes;
    if (bytes.size() > kMostTextBytes) {
        document.fail(where, "the photometric file has {} bytes, at most {} are read", bytes.size(),
                      kMostTextBytes);
    }
    return {bytes.begin(), bytes.end()};
}

PhotometricWeb read_profile(const GltfDocument& document, const tinygltf::Value& light,
                            const std::string& where) {
    const auto uri = member_or<std::string>(light, "uri", "");
    const bool is_file = !uri.empty() && !is_data_uri(uri);
    const std::string shown = where + (is_file ? " '" + shown_uri(uri) + "'" : "");
    const std::string place = document.base.file + ": " + shown;
    PhotometricWeb web = read_photometric_web(read_text(document, light, where), place);
    web.name = member_or<std::string>(light, "name", "");
    document.budget->charge_memory(
        web.text.size() + sizeof(double) * web.candela.size() + sizeof(float) * web.table.size(),
        place);
    constexpr double kStated = 1e-3;  // of the peak
    if (web.table_error > kStated) {
        document.leave_out(
            fmt::format("{}: its angles are finer than 0.1 x 0.5 degrees, or of type A or B: up to "
                        "{:.1g} of its peak is lost",
                        shown, web.table_error));
    }
    return web;
}

SceneLight light_of(const tinygltf::Value& use, const PhotometricWeb& web,
                    const glm::dmat4& world_from_node) {
    SceneLight out;
    out.position = glm::dvec3(world_from_node[3]);
    // Without a side the light is rejected and counted like any light without a direction.
    if (!aim_light(out, world_from_node)) out.direction = glm::dvec3(0.0);
    const double peak = member_or(use, "multiplier", 1.0) * web.peak;
    const std::vector<double> color = numbers_member(use, "color");
    for (glm::length_t c = 0; c < 3; ++c) {
        const double share = color.empty() ? 1.0 : color[static_cast<std::size_t>(c)];
        out.intensity[c] = to_float(std::clamp(share, 0.0, 1.0) * peak);
    }
    return out;
}

}  // namespace

std::vector<PhotometricWeb> read_profiles(const GltfDocument& document) {
    std::vector<PhotometricWeb> webs;
    const tinygltf::Value* extension = find_extension(document.model.extensions, kPhotometric);
    if (extension == nullptr || !extension->Has("lights")) return webs;
    const tinygltf::Value& lights = extension->Get("lights");
    for (std::size_t i = 0; i < lights.ArrayLen(); ++i) {
        webs.push_back(read_profile(document, lights.Get(static_cast<int>(i)),
                                    fmt::format("extensions.{}.lights[{}]", kPhotometric, i)));
    }
    profile_starts(webs);
    return webs;
}

void add_profile_lights(const GltfDocument& document, const PlacedNodes& nodes, Scene& scene) {
    scene.aimed_profiles.clear();
    for (const std::size_t n : nodes.in_scene) {
        const auto* use = find_extension(document.model.nodes[n].extensions, kPhotometric);
        if (use == nullptr || nodes.visibility[n] == NodeVisibility::hidden) continue;
        const auto web = static_cast<std::size_t>(member_or(*use, "light", 0));
        SceneLight light = light_of(*use, scene.webs[web], nodes.world_from_node[n]);
        if (nodes.visibility[n] != NodeVisibility::visible) light.intensity = glm::vec3(0.0f);
        light.profile = static_cast<int>(scene.aimed_profiles.size());
        light.node = static_cast<int>(n);
        const bool mirrored = glm::determinant(glm::dmat3(nodes.world_from_node[n])) < 0.0;
        scene.aimed_profiles.push_back({web, mirrored});
        scene.lights.push_back(light);
    }
}

}  // namespace kilolux
