// SPDX-License-Identifier: Apache-2.0
#include "tests/render/ways/ways.h"

#include <array>
#include <cmath>
#include <limits>

#include "host/surfaces/surface_scene.h"
#include "host/surfaces/triangle_ids.h"

namespace kilolux {
namespace {

RenderSettings drawn_by(RenderSettings settings, Geometry geometry) {
    settings.geometry = geometry;
    return settings;
}

// The least height [pixel] of a triangle whose vertices are in view space; infinite where some of
// it is behind the camera.
double least_height(const View& view, const std::array<glm::dvec3, 3>& triangle) {
    std::array<glm::dvec2, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& v = triangle[i];
        if (v.z >= 0.0) return std::numeric_limits<double>::infinity();
        corners[i] = glm::dvec2(v.x / view.ray.x, v.y / view.ray.z) / -v.z;
    }
    const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[1];
    const double longest = std::max({glm::length(a), glm::length(b), glm::length(a + b)});
    return std::abs(a.x * b.y - a.y * b.x) / longest;
}

}  // namespace

glm::dvec3 pixel_radiance(const Frame& frame, const ShownPixel& pixel) {
    const auto i = 3 * static_cast<std::size_t>(pixel.y * frame.width + pixel.x);
    return {frame.radiance[i], frame.radiance[i + 1], frame.radiance[i + 2]};
}

RenderSettings way_settings() {
    RenderSettings settings = small_settings(kWayWidth, kWayHeight, 200);
    settings.shading = Shading::pbr;
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.1f;
    settings.anisotropy = 1;  // on every device
    return settings;
}

Ways::Ways(const Scene& scene, const Camera& camera, const RenderSettings& settings)
    : scene_(scene),
      camera_(camera),
      settings_(settings),
      shared_(shared_scene(scene)),
      renderer_(shared_, drawn_by(settings, Geometry::compute)) {}

Way Ways::deferred(Geometry geometry) {
    settings_.renderer = RendererKind::deferred;
    settings_.geometry = geometry;
    renderer_.change(settings_);
    Way out{renderer_.render(camera_, 0.0), {}};
    out.surfaces = renderer_.lit_surfaces().surfaces;
    return out;
}

Way Ways::forward(RendererKind kind) {
    settings_.renderer = kind;
    settings_.geometry = Geometry::ids;
    renderer_.change(settings_);
    return {renderer_.render(camera_, 0.0), {}};
}

std::vector<uint> Ways::ids() const {
    const GpuScene& meshes = shared_->meshes(GpuSceneUse::covered, settings_.anisotropy);
    shared_->make_current();
    IdsPass pass(meshes);
    pass.draw(camera_, settings_.width, settings_.height);
    const View of = view();
    std::vector<uint> out(std::size_t{of.stride} * of.height);
    read_plane(pass.targets(), pass.targets().reads().front(), of.stride, out.data());
    return out;
}

// By id.
std::vector<double> Ways::triangle_heights() const {
    std::vector<double> out(1);
    const std::vector<Draw> draws = DrawList(scene_).visible(
        camera_, settings_.width, settings_.height, false, DrawOrder::front_to_back);
    for (const Draw& draw : draws) {
        const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(draw.mesh)];
        const Instance& instance = scene_.instances[static_cast<std::size_t>(draw.instance)];
        const glm::dmat4 from_object = view_from_object(camera_, instance.world_from_object);
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            std::array<glm::dvec3, 3> triangle;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const glm::dvec3 position = mesh.positions[mesh.indices[i + corner]];
                triangle[corner] = from_object * glm::dvec4(position, 1.0);
            }
            out.push_back(least_height(view(), triangle));
        }
    }
    return out;
}

std::vector<ShownPixel> Ways::shown() const {
    const std::vector<uint> ids = this->ids();
    const std::vector<double> heights = triangle_heights();
    std::vector<ShownPixel> out;
    for (int y = 0; y < settings_.height; ++y) {
        for (int x = 0; x < settings_.width; ++x) {
            const std::size_t at =
                static_cast<std::size_t>(y) * view().stride + static_cast<std::size_t>(x);
            if (ids[at] != 0) out.push_back({x, y, at, ids[at], heights.at(ids[at])});
        }
    }
    return out;
}

std::vector<uint> Ways::compute_ids() const {
    const Gpu& gpu = renderer_.gpu();
    const Tuning tuning = default_tuning(gpu.info);
    const SurfaceFeatures features =
        surface_features(scene_, renderer_.plan().gbuffer, settings_.anisotropy);
    SurfaceScene surfaces(gpu, tuning, scene_, features);
    TriangleIds triangles(gpu, tuning, scene_, features);
    const std::vector<Draw> draws = triangles.visible(camera_, settings_.width, settings_.height);
    StageTimer timer;
    const View of = view();
    return download<uint>(gpu, triangles.draw(surfaces.at(draws), draws, of, timer),
                          std::size_t{of.stride} * of.height);
}

void Ways::light_by(float ambient, std::uint64_t lights) {
    settings_.ambient = ambient;
    settings_.lights.count = lights;
}

}  // namespace kilolux
