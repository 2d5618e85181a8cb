// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/mesh/primitive.h"

namespace kilolux {

/// How an instance bends a mesh before it is placed.
struct Deformation {
    std::vector<double> weights;               // one per morph target; missing ones are 0
    std::vector<glm::dmat4> object_from_bind;  // one per joint; empty without a skin
    bool empty() const { return weights.empty() && object_from_bind.empty(); }
    bool operator==(const Deformation&) const = default;
};

/// What a primitive's material decides about its mesh.
struct MeshShading {
    int material = kDefaultMaterial;
    std::array<int, 2> texcoord_sets{0, 1};  // TEXCOORD_n that become Mesh::texcoords
    std::optional<TextureUse> tangent_map;   // by which tangents are made; none: not needed
};

/// What a primitive's mesh is made of at any time: which vertices there are depends on the file
/// alone.
struct MeshPlan {
    PrimitiveArrays arrays;               // without its corners
    std::vector<std::uint32_t> elements;  // of the attributes, by vertex
    std::vector<std::uint32_t> indices;   // of vertices
    // By vertex, the first of those that share a tangent: equal in the file and deformed alike.
    // Empty where the mesh is made once; build_mesh() groups its vertices then.
    std::vector<std::uint32_t> tangent_groups;
};

/// Charges the memory of the mesh, too. `moves`: build_mesh() makes it for many times.
MeshPlan plan_mesh(const GltfDocument& document, PrimitiveArrays arrays, const MeshShading& shading,
                   bool moves);

/// Converts a primitive. Vertices that no triangle uses are left out; without normals every
/// triangle gets its own vertices and its flat normal. Points and segments stay what they are:
/// their indices name 1 or 2 vertices each, until make_solid_mesh(). Throws Error for values that
/// are not finite.
Mesh build_mesh(const MeshPlan& plan, const MeshShading& shading, const Deformation& deformation);

/// The size of the solid that replaces a point (1 corner) or segment (2).
struct SolidSize {
    int corners = 1;
    double width = 0.0;  // in object space
};

/// Makes triangles of such a mesh, see make_solids().
void make_solid_mesh(const GltfDocument& document, Mesh& mesh, const SolidSize& size);

}  // namespace kilolux
