// SPDX-License-Identifier: Apache-2.0
// The triangles that pixels show, drawn in OpenCL alone.
#pragma once

#include "host/surfaces/surface_scene.h"
#include "host/surfaces/triangle_ids.h"
#include "tests/support/test_gpu.h"

namespace kilolux {

inline constexpr uint kNone = ~0u;

// The triangle of a pixel: kNone, or a triangle of an instance.
struct Shown {
    uint instance = kNone, triangle = kNone;
    bool operator==(const Shown&) const = default;
};

class Drawing {
 public:
    Drawing(const Scene& scene, const Gpu& gpu, const Tuning& tuning)
        : gpu_(gpu),
          features_(surface_features(scene, {}, 1)),
          surfaces_(gpu, tuning, scene, features_),
          ids_(gpu, tuning, scene, features_) {}
    explicit Drawing(const Scene& scene)
        : Drawing(scene, test_gpu(), default_tuning(test_gpu().info)) {}

    std::vector<Shown> at(const Camera& camera, int width, int height,
                          const OpenTiles* open = nullptr) {
        return of(ids_.visible(camera, width, height, open), camera, width, height, open);
    }
    std::uint64_t triangles() const { return ids_.triangles(); }
    std::uint64_t pairs() const { return ids_.pairs(); }

 private:
    std::vector<Shown> of(const std::vector<Draw>& draws, const Camera& camera, int width,
                          int height, const OpenTiles* open) {
        const View view = view_of(camera, width, height);
        StageTimer timer;
        const std::vector<uint> ids =
            download(gpu_, ids_.draw(surfaces_.at(draws), draws, view, timer, open));
        std::vector<Shown> out;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const uint id =
                    ids[static_cast<std::size_t>(y) * view.stride + static_cast<std::size_t>(x)];
                Shown& shown = out.emplace_back();
                for (const Draw& draw : draws) {
                    if (id == 0 || draw.row.first_triangle > id - 1) break;
                    shown = {static_cast<uint>(draw.instance), id - 1 - draw.row.first_triangle};
                }
            }
        }
        return out;
    }

    Gpu gpu_;
    SurfaceFeatures features_;
    SurfaceScene surfaces_;
    TriangleIds ids_;
};

}  // namespace kilolux
