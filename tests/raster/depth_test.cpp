// SPDX-License-Identifier: Apache-2.0
// The depth buffer gives back the position: view_position() against the ray's hit with the plane.
#include <random>

#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using DepthTest = GlTest;

// Relative error of a reconstructed position. llvmpipe interpolates depth in float32 from a plane
// equation over the whole triangle; 4.5e-7 was seen.
constexpr double kDepthTolerance = 1e-6;

struct Case {
    const char* name;
    Camera camera;
    double distance;  // of the surface [m]
};

Camera base_camera() {
    Camera camera = look_at({3, 1, 2}, {1, 0.5, -4}, {0.1, 1, 0}, glm::radians(60.0));
    camera.z_near = 0.1;
    return camera;
}

std::vector<Case> cases() {
    std::vector<Case> out;
    out.push_back({"infinite far", base_camera(), 5});
    out.push_back({"infinite far, distant", base_camera(), 5e4});
    Camera finite = base_camera();
    finite.z_far = 100;
    out.push_back({"finite far", finite, 40});
    finite.z_near = 1e-3;
    finite.z_far = 1e4;
    out.push_back({"far/near 1e7", finite, 20});
    Camera shifted = base_camera();
    shifted.shear = {0.5, -0.3};
    shifted.jitter = {0.25, -0.4};
    out.push_back({"off-centre, jittered", shifted, 3});
    Camera parallel = base_camera();
    parallel.orthographic = true;
    parallel.y_extent = 4;
    parallel.z_near = 0;
    parallel.z_far = 50;
    out.push_back({"orthographic", parallel, 10});
    parallel.z_near = -20;
    parallel.shear = {0.2, 0.1};
    parallel.jitter = {-0.3, 0.2};
    out.push_back({"orthographic, near behind, off-centre", parallel, 4});
    return out;
}

// A triangle that covers the picture, tilted, in view space; and its plane.
struct DepthSurface {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;
    double offset;
};

DepthSurface surface_at(double distance, double extent, std::mt19937& random) {
    std::uniform_real_distribution<double> tilt(-0.3, 0.3);
    const double dx = tilt(random);
    const double dy = tilt(random);
    const auto point = [&](double x, double y) {
        return glm::dvec3(x * extent, y * extent, -distance + (dx * x + dy * y) * extent * 0.2);
    };
    DepthSurface s{{point(-4, -3), point(5, -3), point(0, 6)}, {}, 0};
    s.normal = glm::normalize(glm::cross(s.corners[1] - s.corners[0], s.corners[2] - s.corners[0]));
    return s;
}

// Where the ray of pixel coordinates (px, py) meets the plane, in double, from the projection
// alone.
glm::dvec3 hit(const Camera& camera, const DepthSurface& s, int width, int height, double px,
               double py) {
    const glm::dmat4 view_from_clip = glm::inverse(clip_from_view(camera, width, height));
    const auto unproject = [&](double depth) {
        const glm::dvec4 p =
            view_from_clip * glm::dvec4(2 * px / width - 1, 1 - 2 * py / height, depth, 1.0);
        return glm::dvec3(p) / p.w;
    };
    const glm::dvec3 a = unproject(1.0);
    const glm::dvec3 direction = unproject(0.5) - a;
    const double t = glm::dot(s.corners[0] - a, s.normal) / glm::dot(direction, s.normal);
    return a + t * direction;
}

TEST_F(DepthTest, ReconstructsPositions) {
    std::mt19937 random(11);
    constexpr int kDepthWidth = 67;
    constexpr int kDepthHeight = 45;
    for (const Case& c : cases()) {
        const double extent = c.camera.orthographic ? 10.0 : c.distance;
        DepthSurface s = surface_at(c.distance, extent, random);
        // Vertices are float32 in the object's space, which is view space turned and moved in
        // double.
        Mesh mesh;
        for (glm::dvec3& corner : s.corners) {
            mesh.positions.emplace_back(corner);
            corner = glm::dvec3(mesh.positions.back());
        }
        s.normal =
            glm::normalize(glm::cross(s.corners[1] - s.corners[0], s.corners[2] - s.corners[0]));
        mesh.normals.assign(3, glm::vec3(s.normal));
        mesh.indices = {0, 1, 2};
        glm::dmat4 world_from_view(c.camera.world_from_view);
        world_from_view[3] = glm::dvec4(c.camera.position, 1.0);
        const Scene scene = one_object(mesh, {}, world_from_view);
        GBufferNeeds full;
        full.layout = GBUFFER_FULL;
        const HostGBuffer g = draw_gbuffer(scene, c.camera, kDepthWidth, kDepthHeight, full);
        const View view = view_of(c.camera, kDepthWidth, kDepthHeight);
        double worst = 0.0;
        double worst_full = 0.0;
        int covered = 0;
        for (int y = 0; y < kDepthHeight; ++y) {
            for (int x = 0; x < kDepthWidth; ++x) {
                const float depth = g.depth(x, y);
                if (depth == 0.0f) continue;
                ++covered;
                const auto px = static_cast<float>(x) + 0.5f;
                const auto py = static_cast<float>(y) + 0.5f;
                const FV3 p = view_position(view, px, py, view_depth(view, px, py, depth));
                const glm::dvec3 expected = hit(c.camera, s, kDepthWidth, kDepthHeight, px, py);
                const double scale = glm::length(expected) + (c.camera.orthographic ? 20.0 : 0.0);
                worst = std::max(worst, glm::length(glm::dvec3(p.x, p.y, p.z) - expected) / scale);
                worst_full = std::max(
                    worst_full, glm::length(g.vector(PLANE_POSITION_X, x, y) - expected) / scale);
            }
        }
        EXPECT_GT(covered, kDepthWidth * kDepthHeight / 2) << c.name;
        EXPECT_LT(worst, kDepthTolerance) << c.name;
        EXPECT_LT(worst_full, kDepthTolerance) << c.name << ": the full layout's position";
    }
}

TEST_F(DepthTest, FarSurfacesAreNotBackground) {
    const Scene scene = one_object(quad_mesh(1e7f), {}, translation({0, 0, -1e6}));
    EXPECT_GT(draw_gbuffer(scene, front_camera(1), 8, 8).depth(4, 4), 0.0f);
}

}  // namespace
}  // namespace kilolux
