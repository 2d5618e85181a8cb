// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/certify/triangle_coverage.h"

namespace kilolux {
namespace {

constexpr int kSize = 32;  // of the pictures [pixel]

void require_once(Findings& findings, std::string_view what, const std::vector<int>& counts) {
    const auto wrong = std::ranges::count_if(counts, [](int count) { return count != 1; });
    findings.none(what, static_cast<std::uint64_t>(wrong), counts.size());
}

// Draws a closed body from within, `far` away from the world's origin.
void try_body(const Gpu& gpu, Findings& findings, double far) {
    const glm::dvec3 centre(far, -far, 0.5 * far);
    glm::dmat4 world_from_object(1.0);
    world_from_object[3] = glm::dvec4(centre, 1.0);
    const Scene scene = scene_of_triangles(random_body(3), world_from_object);
    for (const glm::dvec3 ahead :
         {glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), glm::dvec3(0.3, 0.9, 0.1)}) {
        const glm::dvec3 eye = centre + glm::dvec3(0.01, 0.02, 0.03);
        Camera camera = look_at(eye, eye + ahead, {0.2, 0.3, 1}, 2.0);
        camera.z_near = 1e-3;
        require_once(findings, fmt::format("pixels in a body at {:g} m not covered once", far),
                     triangle_coverage(gpu, scene, camera, kSize, kSize));
    }
}

}  // namespace

void try_triangle_edges(const Gpu& gpu, Findings& findings) {
    for (const int spokes : {3, 4, 8, 24}) {
        const Scene scene = scene_of_triangles(fan({16.5f, 16.5f}, spokes));
        require_once(findings, "pixels of a fan not covered once",
                     triangle_coverage(gpu, scene, quad_camera(kSize, kSize), kSize, kSize));
    }
    try_body(gpu, findings, 0.0);
    try_body(gpu, findings, 0x1p20);
}

}  // namespace kilolux
