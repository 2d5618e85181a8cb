// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/scene/gltf/load_budget.h"
#include "host/scene/lights/glow/mean_emission.h"
#include "host/scene/scene.h"

namespace kilolux {

/// Whether emissive surfaces are lights. `automatic`: where the file has no other light, none is
/// generated, there is no environment map, and shading and shadows take lights with a size.
enum class EmissiveLights { automatic, on, off };

/// The parts of a scene whose emissive surfaces become lights.
struct GlowingParts {
    const Scene& scene;  // its name, images, textures and extremes
    std::span<const Material> materials;
    std::vector<const Mesh*> meshes;
    std::span<const Instance> instances;
    bool moves = false;  // at other times the parts differ
};

/// Those of the scene itself.
GlowingParts glowing_parts(const Scene& scene);

/// What became lights, and how well these stand for their surfaces.
struct GlowCounts {
    std::size_t meshes = 0;
    std::size_t triangles = 0;   // that are lights, alone or in a rectangle
    std::size_t rectangles = 0;  // of two triangles each
    std::size_t left_out = 0;    // triangles
    std::size_t varied = 0;      // triangles whose emission varies
    // Of their emission, root mean square over area, relative to each triangle's mean.
    double deviation = 0.0;
};

/// One line: how many lights, of what, and the error of averaging.
std::string text_of(const GlowCounts& counts);

/// Makes lights of emissive surfaces: of each triangle in the world a `triangle` with the mean of
/// its emission, or of two that together are a rectangle, within 1e-5 of its diagonal, and emit
/// evenly the same, a `rectangle`. They have SceneLight::of_surface, no range, and shine to the
/// side that is drawn: the front, of double-sided materials both. Emission that a coat dims counts
/// whole.
///
/// Triangles without an area are left out and counted: those thinner than 1e-5 of their longest
/// edge, and those whose size or intensity no float holds. Where parts move, each triangle that
/// glows at any time has a light, a dark one where it gives none or is part of a rectangle: kernels
/// are made for their number.
class GlowingSurfaces {
 public:
    explicit GlowingSurfaces(std::shared_ptr<LoadBudget> budget) : budget_(std::move(budget)) {}

    /// In the order of instances and triangles, whatever the number of threads. Keeps what it read
    /// of maps for the next call: of a mesh of the scene while its revision and material are the
    /// same. Throws MemoryError "<scene>: lights of glowing surfaces: ..." where the budget has not
    /// enough.
    std::vector<SceneLight> lights(const GlowingParts& parts);

    /// Of the last lights().
    const GlowCounts& counts() const { return counts_; }

 private:
    // A mesh whose emission varies, as it was read.
    struct ReadMesh {
        std::optional<std::uint32_t> revision{};  // none: it is not the scene's
        Material material;
        std::size_t most_points = 0;         // of a triangle
        std::vector<MeanEmission> emission;  // by triangle
    };
    void read_maps(const GlowingParts& parts);

    std::shared_ptr<LoadBudget> budget_;
    MemoryCharge charge_;         // for the last lights
    std::vector<ReadMesh> read_;  // by mesh
    GlowCounts counts_;
};

}  // namespace kilolux
