// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/glow/glowing_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/system/parallel.h"
#include "host/scene/lights/glow/glowing_triangles.h"

namespace kilolux {
namespace {

// Points at which all emission that varies is read together, about: a second of one core.
constexpr std::size_t kAllEmissionPoints = std::size_t{1} << 24;
constexpr std::size_t kTrianglesAtOnce = 512;

// The material of a mesh that glows, now or, as the animation drives it, at another time.
const Material* glowing_material(const GlowingParts& parts, const Mesh& mesh) {
    if (mesh.material < 0) return nullptr;
    const auto number = static_cast<std::size_t>(mesh.material);
    const Material& material = parts.materials[number];
    const auto& extremes = parts.scene.extremes;
    const bool glows_later = !extremes.empty() && glows(extremes[extremes.size() / 2 + number]);
    return glows(material) || (parts.moves && glows_later) ? &material : nullptr;
}

std::size_t triangles_of(const Mesh& mesh) { return mesh.indices.size() / 3; }

SceneLight dark_light(const Material& material) {
    SceneLight light;
    light.type = LightType::triangle;
    light.width = light.height = 1.0f;
    light.intensity = {};
    light.two_sided = material.double_sided;
    light.of_surface = true;
    return light;
}

std::vector<bool> shown_meshes(const GlowingParts& parts) {
    std::vector<bool> shown(parts.meshes.size(), false);
    for (const Instance& instance : parts.instances) {
        shown[static_cast<std::size_t>(instance.mesh)] = true;
    }
    return shown;
}

}  // namespace

GlowingParts glowing_parts(const Scene& scene) {
    GlowingParts out{scene, scene.materials, {}, scene.instances};
    for (const Mesh& mesh : scene.meshes) out.meshes.push_back(&mesh);
    return out;
}

std::string text_of(const GlowCounts& counts) {
    std::string out = fmt::format(
        "{} triangles of {} glowing meshes are {} lights, {} of them rectangles", counts.triangles,
        counts.meshes, counts.triangles - counts.rectangles, counts.rectangles);
    if (counts.left_out > 0) {
        out += fmt::format("; {} triangles are left out: no area, or values out of range",
                           counts.left_out);
    }
    if (counts.varied > 0) {
        out += fmt::format(
            "; emission within {} triangles differs from its mean by {:.3g} % (root mean square)",
            counts.varied, 100.0 * counts.deviation);
    }
    return out;
}

// Reads the maps of all meshes that changed, in pieces of triangles on all cores.
void GlowingSurfaces::read_maps(const GlowingParts& parts) {
    struct Piece {
        std::size_t mesh, first, end;
    };
    std::vector<std::size_t> varied;
    std::size_t triangles = 0;
    const std::vector<bool> shown = shown_meshes(parts);
    read_.resize(parts.meshes.size());
    for (std::size_t m = 0; m < parts.meshes.size(); ++m) {
        const Mesh& mesh = *parts.meshes[m];
        const Material* material = shown[m] ? glowing_material(parts, mesh) : nullptr;
        const bool varies = material != nullptr && has_varied_emission(*material);
        if (!varies) {
            read_[m] = {};
            continue;
        }
        varied.push_back(m);
        triangles += triangles_of(mesh);
    }
    if (triangles == 0) return;
    const std::size_t most =
        std::clamp(kAllEmissionPoints / triangles, std::size_t{64}, kMostEmissionPoints);
    std::vector<Piece> pieces;
    for (const std::size_t m : varied) {
        const Mesh& mesh = *parts.meshes[m];
        const bool is_kept = &mesh == &parts.scene.meshes[m];
        ReadMesh next{std::nullopt, *glowing_material(parts, mesh), most, {}};
        if (is_kept) next.revision = mesh.revision;
        ReadMesh& read = read_[m];
        if (is_kept && read.revision == next.revision && read.material == next.material &&
            read.most_points == most) {
            continue;
        }
        next.emission.resize(triangles_of(mesh));
        read = std::move(next);
        for (std::size_t i = 0; i < triangles_of(mesh); i += kTrianglesAtOnce) {
            pieces.push_back({m, i, std::min(i + kTrianglesAtOnce, triangles_of(mesh))});
        }
    }
    parallel_each(pieces.size(), [&](std::size_t i) {
        const auto& [mesh, first, end] = pieces[i];
        ReadMesh& read = read_[mesh];
        for (std::size_t t = first; t < end; ++t) {
            read.emission[t] =
                mean_emission(parts.scene, *parts.meshes[mesh], read.material, t, most);
        }
    });
}

std::vector<SceneLight> GlowingSurfaces::lights(const GlowingParts& parts) {
    std::vector<const Instance*> sources;
    std::size_t triangles = 0;
    for (const Instance& instance : parts.instances) {
        const Mesh& mesh = *parts.meshes[static_cast<std::size_t>(instance.mesh)];
        if (glowing_material(parts, mesh) == nullptr) continue;
        sources.push_back(&instance);
        triangles += triangles_of(mesh);
    }
    const std::string where = parts.scene.name + ": lights of glowing surfaces";
    MemoryCharge charge =
        budget_->borrow_memory(triangles * (sizeof(SceneLight) + sizeof(MeanEmission)), where);
    const MemoryCharge working =
        budget_->borrow_memory(triangles * kBytesPerGlowingTriangle, where);
    read_maps(parts);
    std::vector<TriangleLights> made(sources.size());
    parallel_each(sources.size(), [&](std::size_t i) {
        const auto mesh = static_cast<std::size_t>(sources[i]->mesh);
        made[i] = make_triangle_lights({*parts.meshes[mesh],
                                        *glowing_material(parts, *parts.meshes[mesh]),
                                        read_[mesh].emission, sources[i]->world_from_object});
    });
    GlowCounts counts;
    double squares = 0.0, area = 0.0;
    std::vector<SceneLight> out;
    out.reserve(triangles);
    std::vector<bool> gives_light(parts.meshes.size(), false);
    for (std::size_t i = 0; i < made.size(); ++i) {
        const TriangleLights& of = made[i];
        counts.triangles += of.triangles;
        counts.rectangles += of.rectangles;
        counts.left_out += of.left_out;
        counts.varied += of.varied;
        squares += of.squares;
        area += of.varied_area;
        if (of.triangles > 0) gives_light[static_cast<std::size_t>(sources[i]->mesh)] = true;
        out.insert(out.end(), of.lights.begin(), of.lights.end());
        if (!parts.moves) continue;
        const auto mesh = static_cast<std::size_t>(sources[i]->mesh);
        const SceneLight dark = dark_light(*glowing_material(parts, *parts.meshes[mesh]));
        out.resize(out.size() + triangles_of(*parts.meshes[mesh]) - of.lights.size(), dark);
    }
    counts.meshes = static_cast<std::size_t>(std::ranges::count(gives_light, true));
    counts.deviation = area > 0.0 ? std::sqrt(squares / area) : 0.0;
    counts_ = counts;
    charge_ = std::move(charge);
    return out;
}

}  // namespace kilolux
