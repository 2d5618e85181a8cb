// SPDX-License-Identifier: Apache-2.0
// The same command gives the same bytes, for any division of the work.
#include <gtest/gtest.h>

#include "host/base/hash.h"
#include "tests/support/child.h"
#include "tests/support/full.h"
#include "tests/support/paths.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

std::uint64_t hash_of(const Frame& frame) {
    return hash64(std::as_bytes(std::span(frame.radiance))) ^
           hash64(std::as_bytes(std::span(frame.display))) << 1;
}

RenderSettings usual() {
    RenderSettings settings = small_settings(90, 70, 500);
    settings.bloom = 0.2f;
    settings.opened = nullptr;  // each renderer builds its own
    return settings;
}

TEST(Determinism, LanesGroupsChunksAndGridsChangeNoBit) {
    const Scene scene = grid_with_every_light();
    const auto hash = [&](const RenderSettings& settings) {
        return hash_of(render_once(scene, settings, 0.7));
    };
    const std::uint64_t expected = hash(usual());
    for (int again = 0; again < 3; ++again) EXPECT_EQ(hash(usual()), expected);
    for (const int lanes : lane_widths()) {
        RenderSettings settings = usual();
        settings.kernels.lanes = lanes;
        EXPECT_EQ(hash(settings), expected) << lanes << " lanes";
    }
    for (const int rows : {1, 16}) {
        RenderSettings settings = usual();
        settings.kernels.group_height = rows;
        EXPECT_EQ(hash(settings), expected) << rows << " rows a work-group";
    }
    for (const int chunks : {1, 3, 64}) {
        RenderSettings settings = usual();
        settings.kernels.chunks = chunks;
        EXPECT_EQ(hash(settings), expected) << chunks << " chunks";
    }
    for (const int tiles : {1, 40}) {
        RenderSettings settings = usual();
        settings.grid.tiles_x = settings.grid.tiles_y = tiles;
        settings.grid.slices_per_octave = tiles > 10 ? 16 : 1;
        EXPECT_EQ(hash(settings), expected) << tiles << " tiles";
    }
}

// A renderer that made other frames before, larger and with more lights in view, makes the same
// picture.
TEST(Determinism, FramesBeforeChangeNoBit) {
    const Scene scene = make_generated_scene("grid");
    Renderer renderer(scene, usual());
    const Camera camera = first_camera(scene);
    const std::uint64_t expected = hash_of(renderer.render(camera, 1.0));
    Camera far = camera;
    far.position += camera.world_from_view[2] * 20.0;
    for (const double time : {0.0, 3.0, 7.5}) {
        renderer.render(far, time);
        EXPECT_EQ(hash_of(renderer.render(camera, 1.0)), expected);
    }
}

// Whole files, by the program: runs, one or two compute units, PoCL's ways to run work-groups.
TEST(Determinism, RunsComputeUnitsAndWorkGroupMethodsChangeNoByte) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.exr").string();
    const auto bytes_with = [&](const std::string& variable) {
        const ChildResult result = run_child({"/usr/bin/env", variable, program_file(), "render",
                                              "grid", "--lights", "200", "--resolution", "64,48",
                                              "--aov", "depth,light-count", "--quiet", "-o", file});
        EXPECT_EQ(result.code, 0) << result.err;
        return text_of_file(file);
    };
    const std::string expected = bytes_with("KILOLUX_NOTHING=1");
    ASSERT_GT(expected.size(), 1000u);
    // PoCL's usual method is loopvec.
    for (const char* variable :
         {"KILOLUX_NOTHING=2", "POCL_MAX_PTHREAD_COUNT=1", "POCL_MAX_PTHREAD_COUNT=2",
          "POCL_WORK_GROUP_METHOD=loops", "POCL_WORK_GROUP_METHOD=cbs"}) {
        const std::string bytes = bytes_with(variable);
        EXPECT_TRUE(bytes == expected) << variable;
    }
}

}  // namespace
}  // namespace kilolux
