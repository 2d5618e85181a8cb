// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/gltf/material/material.h"
#include "host/scene/gltf/nodes.h"

namespace kilolux {

/// A mesh of the file in one shape; nodes that deform it alike share it.
struct MeshShape {
    std::size_t mesh = 0;
    Deformation deformation;
    // A skin, or morph weights or a normal map's transform that an animation drives.
    bool moves = false;
    // Of the primitives' normal maps, where an animation drives materials: tangents follow them.
    std::vector<glm::mat2> map_axes{};
    double metres_per_unit = 1.0;  // of object space, where the shape is placed first
    bool operator==(const MeshShape&) const = default;
};

/// A shape put into the world.
struct Placement {
    std::size_t shape = 0;
    glm::dmat4 world_from_object{1.0};
};

/// The shapes and placements that a file draws. Which there are does not depend on the time, only
/// their contents do.
struct ShapePlan {
    std::vector<MeshShape> shapes;
    std::vector<Placement> placements;
};

/// Throws Error for a transform that is not finite.
ShapePlan plan_shapes(const GltfDocument& document, const PlacedNodes& nodes);

/// Sets MeshShape::map_axes, and has the shapes move where the `extremes` of the materials differ.
void add_map_axes(const GltfDocument& document, const GltfMaterials& materials,
                  const std::vector<Material>& extremes, ShapePlan& plan);

/// One primitive of one shape.
struct PrimitiveJob {
    std::size_t shape = 0;
    std::size_t primitive = 0;
    int corners = 3;  // of a triangle; 2 of a segment, 1 of a point
};

/// The primitives that can be drawn, shape by shape.
std::vector<PrimitiveJob> list_primitives(const GltfDocument& document, const ShapePlan& plan);

/// Width of points and lines [m]: the options' share of the diagonal of what `meshes`, one per job
/// and without their width, cover.
double line_width_m(const GltfDocument& document, const ShapePlan& plan,
                    const std::vector<PrimitiveJob>& jobs, const std::vector<Mesh>& meshes);

/// What one primitive of a shape is made of, which does not depend on the time.
MeshPlan plan_primitive(const GltfDocument& document, const GltfMaterials& materials,
                        const MeshShape& shape, std::size_t primitive);

/// The mesh that a primitive's plan makes in its shape; see build_mesh() for points and lines.
Mesh build_primitive(const GltfDocument& document, const GltfMaterials& materials,
                     const MeshShape& shape, std::size_t primitive, const MeshPlan& plan);

}  // namespace kilolux
