// SPDX-License-Identifier: Apache-2.0
// What a frame asks of the driver: on a GPU each launch and each wait costs the host as much time
// as a small kernel takes.
#include <gtest/gtest.h>

#include "tests/support/cl_calls.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// The calls of a frame whose lists have their room, whose camera has moved.
ClCalls calls_of_frame(const RenderSettings& settings) {
    const Scene scene = make_generated_scene("grid");
    Renderer renderer(scene, settings);
    Camera camera = first_camera(scene);
    ClCalls before;
    for (int i = 0; i < 4; ++i) {
        before = cl_calls();
        camera.position.x += 1e-3;
        renderer.render(camera, 0.1 * i);
    }
    return cl_calls() - before;
}

TEST(FrameCalls, AFrameHasFewLaunchesAndNoBlockingRead) {
    RenderSettings settings = small_settings(64, 48, 200);
    settings.geometry = Geometry::compute;
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::deferred_all}) {
        settings.renderer = kind;
        const ClCalls calls = calls_of_frame(settings);
        EXPECT_EQ(calls.blocking_reads, 0) << static_cast<int>(kind);
        EXPECT_EQ(calls.finishes, 1) << static_cast<int>(kind) << ": for the picture";
        EXPECT_LE(calls.launches, kind == RendererKind::deferred ? 27 : 11)
            << static_cast<int>(kind);
    }
}

}  // namespace
}  // namespace kilolux
