// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/skin.h"

#include <glm/gtc/matrix_transform.hpp>

namespace kilolux {
namespace {

struct JointSet {
    const ElementArray* joints = nullptr;
    ElementArray weights;
};

std::vector<JointSet> joint_sets(const PrimitiveArrays& arrays) {
    std::vector<JointSet> sets;
    for (int n = 0;; ++n) {
        const auto joints = arrays.attributes.find(fmt::format("JOINTS_{}", n));
        const auto weights = arrays.attributes.find(fmt::format("WEIGHTS_{}", n));
        if (joints == arrays.attributes.end() || weights == arrays.attributes.end()) return sets;
        expect_components(joints->second, {4}, joints->first);
        expect_components(weights->second, {4}, weights->first);
        sets.push_back({&joints->second, weights->second});
        sets.back().weights.normalized = true;
    }
}

glm::dmat4 blend(const std::vector<JointSet>& sets, std::size_t element,
                 std::span<const glm::dmat4> object_from_bind) {
    glm::dmat4 sum(0.0);
    double total = 0.0;
    for (const JointSet& set : sets) {
        const glm::vec4 joints = read_vector(*set.joints, element);
        const glm::vec4 weights = read_vector(set.weights, element);
        for (glm::length_t c = 0; c < 4; ++c) {
            if (weights[c] == 0.0f) continue;
            if (!(joints[c] >= 0.0f) ||
                !(joints[c] < static_cast<float>(object_from_bind.size()))) {
                throw Error(fmt::format("{}: element {} names joint {}, the skin has {}",
                                        set.joints->where, element, joints[c],
                                        object_from_bind.size()));
            }
            sum += static_cast<double>(weights[c]) *
                   object_from_bind[static_cast<std::size_t>(joints[c])];
            total += weights[c];
        }
    }
    return total == 0.0 ? object_from_bind[0] : sum / total;
}

// Cofactors, the inverse transpose times the determinant: also defined for parts scaled to zero.
// The sign keeps the normals of mirrored parts outwards.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0.0 ? -cofactors : cofactors;
}

// Unit before it becomes float: cofactors of small scales would vanish there.
glm::vec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? glm::vec3(v / length) : glm::vec3(0.0f);
}

}  // namespace

PlacedSkin place_skin(const GltfDocument& document, std::size_t index, const PlacedNodes& nodes) {
    const tinygltf::Skin& skin = document.model.skins[index];
    PlacedSkin out;
    if (skin.joints.empty()) document.fail(element_name("skins", index), "has no joints");
    const glm::dvec3 origin(nodes.world_from_node[static_cast<std::size_t>(skin.joints[0])][3]);
    out.world_from_object = glm::translate(glm::dmat4(1.0), origin);
    const glm::dmat4 object_from_world = glm::translate(glm::dmat4(1.0), -origin);
    ElementArray bind;
    if (skin.inverseBindMatrices >= 0) {
        bind = open_accessor(document, skin.inverseBindMatrices);
        expect_components(bind, {16}, "inverseBindMatrices");
        if (bind.count < skin.joints.size()) {
            document.fail(element_name("skins", index),
                          "has {} joints and {} inverse bind matrices", skin.joints.size(),
                          bind.count);
        }
    }
    document.budget->charge(skin.joints.size(), sizeof(glm::dmat4),
                            document.base.file + ": " + element_name("skins", index));
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const auto joint = static_cast<std::size_t>(skin.joints[j]);
        const glm::dmat4 joint_from_bind =
            skin.inverseBindMatrices < 0 ? glm::dmat4(1.0) : read_matrix(bind, j);
        out.object_from_bind.push_back(object_from_world * nodes.world_from_node[joint] *
                                       joint_from_bind);
    }
    return out;
}

void skin_mesh(Mesh& mesh, const PrimitiveArrays& arrays, std::span<const std::uint32_t> elements,
               std::span<const glm::dmat4> object_from_bind) {
    const std::vector<JointSet> sets = joint_sets(arrays);
    if (sets.empty()) throw Error(arrays.where + ": is skinned but has no JOINTS_0 and WEIGHTS_0");
    for (std::size_t v = 0; v < elements.size(); ++v) {
        const glm::dmat4 matrix = blend(sets, elements[v], object_from_bind);
        const glm::dmat3 linear(matrix);
        mesh.positions[v] = glm::vec3(matrix * glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0));
        if (!mesh.normals.empty()) {
            mesh.normals[v] = unit_or_zero(normal_matrix(linear) * glm::dvec3(mesh.normals[v]));
        }
        if (!mesh.tangents.empty()) {
            const glm::dvec3 tangent = linear * glm::dvec3(glm::vec3(mesh.tangents[v]));
            // Normals of mirrored parts stay outwards, so their cross product turns round.
            const float turn = glm::determinant(linear) < 0.0 ? -1.0f : 1.0f;
            mesh.tangents[v] = glm::vec4(unit_or_zero(tangent), turn * mesh.tangents[v].w);
        }
    }
}

}  // namespace kilolux
