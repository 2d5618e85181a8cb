// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include "host/base/system/parallel.h"

namespace kilolux {
namespace {

constexpr std::size_t kVerticesAtOnce = 4096;
constexpr float kSamePoint = 1e-6f;  // of a coordinate: points that near each other are one
constexpr double kParallel = 1e-12;  // relative area of axes that rounding leaves of a line
constexpr double kSpeck = 1e-5;      // of the largest instance's size: no picture shows it
constexpr int kRounds = 8;           // until all boxes are made exact

using Positions = std::vector<glm::vec3>;

// Whether an instance's scale flattens it to a point or a line.
bool is_hidden(const Instance& instance) {
    const glm::dmat3 axes(instance.world_from_object);
    double area = 0.0, longest = 0.0;
    for (int i = 0; i < 3; ++i) {
        area = std::max(area, glm::length(glm::cross(axes[i], axes[(i + 1) % 3])));
        longest = std::max(longest, glm::length(axes[i]));
    }
    return area <= kParallel * longest * longest;
}

Box joined_boxes(Box a, const Box& b) {
    a.min = glm::min(a.min, b.min);
    a.max = glm::max(a.max, b.max);
    return a;
}

double size_of(const Box& box) { return box.empty() ? 0.0 : glm::length(box.size()); }

// Whether a triangle is a point, as where a bone's scale or a morph target hides it, or a line.
bool has_area(const Mesh& mesh, std::size_t triangle) {
    const std::uint32_t* corner = &mesh.indices[3 * triangle];
    const glm::vec3& a = mesh.positions[corner[0]];
    const glm::vec3 u = mesh.positions[corner[1]] - a, v = mesh.positions[corner[2]] - a;
    const glm::vec3 extent = glm::max(glm::abs(u), glm::abs(v)), place = glm::abs(a);
    const float size = std::max({extent.x, extent.y, extent.z});
    if (size <= kSamePoint * std::max({place.x, place.y, place.z})) return false;
    return glm::cross(u / size, v / size) != glm::vec3(0.0f);
}

// Of triangles that have an area.
Positions corners_with_area(const Mesh& mesh) {
    std::vector<bool> is_corner(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) {
        if (!has_area(mesh, i)) continue;
        for (std::size_t k = 0; k < 3; ++k) is_corner[mesh.indices[3 * i + k]] = true;
    }
    Positions out;
    for (std::size_t i = 0; i < is_corner.size(); ++i) {
        if (is_corner[i]) out.push_back(mesh.positions[i]);
    }
    return out;
}

glm::dvec3 placed(const glm::vec3& position, const glm::dmat4& world_from_object) {
    return glm::dvec3(world_from_object * glm::dvec4(position, 1.0));
}

Box bounds(const Positions& positions, const glm::dmat4& world_from_object) {
    const auto add = [&](std::size_t i, Box box) {
        box.add(placed(positions[i], world_from_object));
        return box;
    };
    return parallel_reduce(positions.size(), Box{}, add, joined_boxes, kVerticesAtOnce);
}

// A bit for each side of the box that the point touches.
unsigned sides_at(const Box& box, const glm::dvec3& p) {
    unsigned sides = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] == box.min[axis]) sides |= 1u << axis;
        if (p[axis] == box.max[axis]) sides |= 8u << axis;
    }
    return sides;
}

// Whether triangles with an area touch all sides of the box of a mesh's vertices.
bool is_box_of_triangles(const Mesh& mesh, const glm::dmat4& world_from_object, const Box& box) {
    constexpr unsigned kAll = 63;
    std::vector<std::uint8_t> sides(mesh.positions.size());
    const auto find_sides = [&](std::size_t i) {
        const glm::dvec3 p = placed(mesh.positions[i], world_from_object);
        sides[i] = static_cast<std::uint8_t>(sides_at(box, p));
    };
    parallel_for(std::size_t{0}, sides.size(), find_sides, kVerticesAtOnce);
    unsigned touched = 0;
    for (std::size_t i = 0; i < mesh.indices.size() && touched != kAll; ++i) {
        const unsigned more = sides[mesh.indices[i]] & ~touched;
        if (more != 0 && has_area(mesh, i / 3)) touched |= more;
    }
    return touched == kAll;
}

// Boxes of a scene's instances: of their vertices, and where that matters of their triangles.
class InstanceBoxes {
 public:
    explicit InstanceBoxes(const Scene& scene)
        : scene_(scene),
          boxes_(scene.instances.size()),
          exact_(boxes_.size(), 0),
          corners_(scene.meshes.size()) {
        parallel_for(std::size_t{0}, boxes_.size(), [&](std::size_t i) {
            const Instance& instance = scene_.instances[i];
            if (is_hidden(instance)) return;
            boxes_[i] = bounds(mesh_of(i).positions, instance.world_from_object);
        });
    }

    Box joined() const {
        double largest = 0.0;
        for (const Box& box : boxes_) largest = std::max(largest, size_of(box));
        Box out;
        for (const Box& box : boxes_) {
            if (size_of(box) >= kSpeck * largest) out = joined_boxes(out, box);
        }
        return out;
    }

    // Makes boxes exact that touch sides of `whole`, or all of them; false where all those are.
    bool make_exact(const Box& whole, bool all) {
        bool made = false;
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            const bool matters =
                all || sides_at(whole, boxes_[i].min) != 0 || sides_at(whole, boxes_[i].max) != 0;
            if (exact_[i] != 0 || !matters) continue;
            exact_[i] = 1;
            made = true;
            make_exact(i);
        }
        return made;
    }

 private:
    const Mesh& mesh_of(std::size_t i) const {
        return scene_.meshes[static_cast<std::size_t>(scene_.instances[i].mesh)];
    }

    void make_exact(std::size_t i) {
        const Instance& instance = scene_.instances[i];
        if (boxes_[i].empty()) return;
        if (is_box_of_triangles(mesh_of(i), instance.world_from_object, boxes_[i])) return;
        std::optional<Positions>& corners = corners_[static_cast<std::size_t>(instance.mesh)];
        if (!corners) corners = corners_with_area(mesh_of(i));
        boxes_[i] = bounds(*corners, instance.world_from_object);
    }

    const Scene& scene_;
    std::vector<Box> boxes_;
    std::vector<std::uint8_t> exact_;
    std::vector<std::optional<Positions>> corners_;  // with an area, by mesh
};

}  // namespace

glm::vec3 dielectric_reflectance(const Material& material) {
    // The default ior gives exactly the constant of kernels/shared/evaluate.h.
    const float root = (material.ior - 1.0f) / (material.ior + 1.0f);
    const float f0 = material.ior == Material{}.ior ? 0.04f : root * root;
    return f0 * material.specular_color;
}

bool has_own_reflectance(const Material& material) {
    const Material standard;
    return material.ior != standard.ior || material.specular != standard.specular ||
           material.specular_color != standard.specular_color ||
           material.specular_texture.present() || material.specular_color_texture.present();
}

std::size_t zero_normal_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& n : mesh.normals) {
            const float size = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
            if (!(size > 0.0f && std::isfinite(size))) ++count;
        }
    }
    return count;
}

Box resting_bounds(const Scene& scene) {
    return scene.still_box.empty() ? bounds(scene) : scene.still_box;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) {
        count += scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size() / 3;
    }
    return count;
}

const Material& material_of(const Scene& scene, const Mesh& mesh) {
    static const Material kDefault;
    return mesh.material == kDefaultMaterial
               ? kDefault
               : scene.materials[static_cast<std::size_t>(mesh.material)];
}

std::vector<const Material*> looks_of(const Scene& scene, const Mesh& mesh) {
    std::vector<const Material*> out = {&material_of(scene, mesh)};
    const auto index = static_cast<std::size_t>(mesh.material);
    const std::size_t count = scene.extremes.size() / 2;
    if (mesh.material == kDefaultMaterial || index >= count) return out;
    out.insert(out.end(), {&scene.extremes[index], &scene.extremes[count + index]});
    return out;
}

std::size_t material_row(const Scene& scene, const Mesh& mesh) {
    return mesh.material == kDefaultMaterial ? scene.materials.size()
                                             : static_cast<std::size_t>(mesh.material);
}

bool is_blended(const Material& material) {
    return material.alpha_mode == AlphaMode::blend || material.transmission > 0.0f;
}

bool is_blended(const Scene& scene, const Mesh& mesh) {
    return std::ranges::any_of(looks_of(scene, mesh),
                               [](const Material* look) { return is_blended(*look); });
}

bool has_blended_surfaces(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return is_blended(scene, scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    });
}

// The order of the vertices changes no box: minima and maxima are exact.
Box bounds(const Scene& scene) {
    InstanceBoxes boxes(scene);
    Box out = boxes.joined();
    for (int round = 1; boxes.make_exact(out, round == kRounds); ++round) out = boxes.joined();
    return out;
}

}  // namespace kilolux
