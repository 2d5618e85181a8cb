// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gltf_seeds.h"

#include "tests/support/gltf_compressed.h"

namespace kilolux {
namespace {

using nlohmann::json;

// A quad with everything that a file may say about nodes: lights, cameras, skin, morph, animation.
GltfBuilder busy_file() {
    GltfBuilder file = quad_with_normal_map();
    json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_0"] = file.add_accessor(Blob(16), {kUnsignedByte, "VEC4", 4, false, 0});
    attributes["WEIGHTS_0"] =
        file.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    attributes["COLOR_0"] = file.add_accessor(Blob(16, 200), {kUnsignedByte, "VEC4", 4, true, 0});
    const int delta = file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.primitive()["targets"] = {{{"POSITION", delta}}};
    file.root["accessors"][static_cast<std::size_t>(delta)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", file.add_view(Blob{2})}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", file.add_view(Blob(12))}}}};
    file.root["meshes"][0]["weights"] = {0.5};
    file.add("skins", {{"joints", {1}}});
    file.root["nodes"][0]["skin"] = 0;
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"color", {1, 1, 1}}, {"range", 3}, {"spot", {{"outerConeAngle", 1}}}}};
    file.add_node({{"camera", 0},
                   {"children", {2}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.add("nodes", {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1}}});
    const int input = file.add_floats("SCALAR", {0, 1, 2});
    const int output = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0});
    file.add(
        "animations",
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    file.root["materials"][0]["extensions"] = {{"KHR_materials_ior", {{"ior", 1.4}}}};
    file.root["materials"][0]["normalTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1}, {"scale", {2, 2}}}}};
    file.root["textures"][0]["sampler"] = file.add("samplers", {{"wrapS", 33071}});
    return file;
}

}  // namespace

std::vector<GltfBuilder> gltf_seeds() {
    return {busy_file(),
            triangle_file(),
            meshopt_quad("TRIANGLES"),
            meshopt_quad("INDICES"),
            draco_file(draco_quad(kDracoEdgebreaker)),
            draco_file(draco_quad(kDracoSequential))};
}

}  // namespace kilolux
