// SPDX-License-Identifier: Apache-2.0
// Nothing grows with the frames: many of them in one process, and a sequence by the program.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/support/child.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// Resident memory of a process [byte]; 0 once it is gone.
std::uint64_t resident_bytes(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/statm");
    std::uint64_t pages = 0, resident = 0;
    in >> pages >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t resident_now() {
    malloc_trim(0);
    return resident_bytes(getpid());
}

std::string mib(std::uint64_t bytes) {
    return std::to_string(static_cast<double>(bytes) / (1 << 20)) + " MiB";
}

// Ten thousand frames of a walk, with moving lights. Resident memory after each thousand is
// compared from the third on: lists and drivers have their room by then. A leak of 100 bytes a
// frame would be 0.7 MiB.
TEST(MemoryGrowth, TenThousandFramesTakeNoMoreThanThree) {
    constexpr int kFrames = 10'000;
    constexpr std::uint64_t kAllowed = std::uint64_t{3} << 19;
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(16, 16, 20);
    Renderer renderer(scene, settings);
    Camera camera = first_camera(scene);
    std::vector<std::uint64_t> resident;
    for (int i = 0; i < kFrames; ++i) {
        camera.position.x += i % 100 < 50 ? 1e-3 : -1e-3;
        renderer.render(camera, i % 250 / 25.0);
        if ((i + 1) % 1000 == 0) resident.push_back(resident_now());
    }
    std::string course;
    for (const std::uint64_t bytes : resident) course += mib(bytes) + " ";
    std::cout << course << std::endl;
    EXPECT_LE(resident.back(), resident[2] + kAllowed) << course;
}

// The same through the program, which writes a file for each frame.
TEST(MemoryGrowth, SequenceOfFiveHundredFramesIsConstant) {
    constexpr std::uint64_t kAllowed = std::uint64_t{6} << 20;
    const TemporaryFolder folder;
    const auto frames_there = [&] { return names_in(folder).size(); };
    std::uint64_t early = 0, late = 0;
    const ChildResult result =
        run_kilolux({"render", "plain", "--lights", "50", "--resolution", "48,32", "--frames",
                     "0:499", "--quiet", "-o", (folder / "f.###.png").string()},
                    [&](pid_t child) {
                        while (frames_there() < 495 && resident_bytes(child) > 0) {
                            const std::uint64_t now = resident_bytes(child);
                            if (frames_there() > 100 && early == 0) early = now;
                            if (frames_there() > 400) late = std::max(late, now);
                            std::this_thread::sleep_for(std::chrono::milliseconds(10));
                        }
                    });
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(frames_there(), 500u);
    ASSERT_GT(early, 0u);
    ASSERT_GT(late, 0u);
    EXPECT_LE(late, early + kAllowed) << mib(early) << " at frame 100, " << mib(late) << " at 400";
}

}  // namespace
}  // namespace kilolux
