// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/instancing.h"

#include <array>

#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/mesh/accessor.h"
#include "host/scene/gltf/nodes.h"

namespace kilolux {
namespace {

constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";
constexpr std::array kAttributes = {"TRANSLATION", "ROTATION", "SCALE"};

void check_type(const GltfDocument& document, const ElementArray& array, const std::string& where,
                bool is_rotation) {
    expect_components(array, {is_rotation ? 4u : 3u}, where);
    const bool is_packed = is_rotation && array.normalized &&
                           (array.component_type == TINYGLTF_COMPONENT_TYPE_BYTE ||
                            array.component_type == TINYGLTF_COMPONENT_TYPE_SHORT);
    if (array.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT || is_packed) return;
    document.fail(where, "componentType is {}{}, must be 5126 (float){}", array.component_type,
                  array.normalized ? " normalized" : "",
                  is_rotation ? ", or 5120 or 5122 normalized" : "");
}

}  // namespace

std::optional<std::vector<glm::dmat4>> node_from_instances(const GltfDocument& document,
                                                           std::size_t node) {
    const auto* extension =
        find_extension(document.model.nodes[node].extensions, kInstancingExtension);
    if (extension == nullptr) return std::nullopt;
    const std::string place = node_name(document, node) + ": " + kInstancingExtension;
    const tinygltf::Value& attributes = extension->Get("attributes");  // null where empty
    std::array<std::optional<ElementArray>, kAttributes.size()> arrays;
    std::optional<std::size_t> count;
    for (std::size_t a = 0; a < kAttributes.size(); ++a) {
        if (!attributes.Has(kAttributes[a])) continue;
        const std::string where = fmt::format("{}.{}", place, kAttributes[a]);
        arrays[a] = open_accessor(document, member_or(attributes, kAttributes[a], 0));
        check_type(document, *arrays[a], where, a == 1);
        if (count && *count != arrays[a]->count) {
            document.fail(where, "has {} instances, the attributes before it have {}",
                          arrays[a]->count, *count);
        }
        count = arrays[a]->count;
    }
    if (!count) document.fail(place, "has none of TRANSLATION, ROTATION and SCALE");
    document.budget->charge(*count, sizeof(glm::dmat4), document.base.file + ": " + place);
    std::vector<glm::dmat4> out(*count);
    for (std::size_t i = 0; i < out.size(); ++i) {
        NodePose pose;
        if (arrays[0]) pose.translation = glm::dvec3(read_vector(*arrays[0], i));
        if (arrays[1]) {
            const glm::dvec4 q(read_vector(*arrays[1], i));
            pose.rotation = {q.w, q.x, q.y, q.z};
        }
        if (arrays[2]) pose.scale = glm::dvec3(read_vector(*arrays[2], i));
        out[i] = matrix_of(pose);
    }
    return out;
}

}  // namespace kilolux
