// SPDX-License-Identifier: Apache-2.0
// Programs, buffers and timers: their messages when the device refuses.
#include "host/gpu/program.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "host/base/hash.h"
#include "host/base/source.h"
#include "host/base/system/memory.h"
#include "host/base/text.h"
#include "host/gpu/buffer.h"
#include "host/gpu/stage_timer.h"
#include "tests/support/environment_variable.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

template <typename Body>
std::string build_error(const Body& body) {
    try {
        body();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

void expect_contains(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

TEST(Program, BuildFailureNamesFileDeviceOptionsAndLog) {
    const Gpu gpu = test_gpu();
    const std::string message = build_error([&] {
        build_program(gpu, "tonemap", BuildOptions().define("fv", "no_such_function")).built();
    });
    expect_contains(message,
                    "kernels/picture/tonemap.cl: build failed with CL_BUILD_PROGRAM_FAILURE");
    expect_contains(message, gpu.info.name);
    expect_contains(message, "-Dfv=no_such_function");
    expect_contains(message, "no_such_function");
}

// A text that an #if leaves out is spliced where it is included next.
TEST(Program, IncludesFollowConditions) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.h") << "#ifndef A_H\n#define A_H\n#include \"b.h\"\nint a;\n#endif\n";
    std::ofstream(folder / "b.h") << "#ifndef B_H\n#define B_H\nint b;\n#endif\n";
    std::ofstream(folder / "c.cl") << "#if 0\n#include \"a.h\"\n#endif\n#include \"b.h\"\n#include "
                                      "\"a.h\"\n#include \"b.h\"\n";
    const EnvironmentVariable root("KILOLUX_SOURCE_DIR", folder.path().string());
    const SplicedSource source = splice_source("c.cl", false);
    const std::string rest = source.text.substr(source.text.find("#line 3 \"c.cl\""));
    const auto count = [&](const std::string& line) {
        std::size_t found = 0;
        for (std::size_t at = rest.find(line); at != std::string::npos;
             at = rest.find(line, at + 1))
            ++found;
        return found;
    };
    EXPECT_EQ(count("int a;"), 1u) << source.text;
    EXPECT_EQ(count("int b;"), 1u) << source.text;
    EXPECT_EQ(source.files, (std::vector<std::string>{"c.cl", "a.h", "b.h"}));
}

TEST(Program, CompilerMessagesNameTheFileAndLineOfAnInclude) {
    if (!test_gpu().info.is_cpu) GTEST_SKIP() << "NVIDIA's compiler ignores #line";
    const TemporaryFolder folder;
    for (const std::string& path : embedded_paths("kernels/")) {
        std::filesystem::create_directories((folder / path).parent_path());
        std::ofstream(folder / path) << embedded_text(path);
    }
    std::ofstream(folder / "kernels/device/lanes.h") << "// broken on line 3\n\nint oops = ;\n";
    const EnvironmentVariable root("KILOLUX_SOURCE_DIR", folder.path().string());
    const std::string message = build_error([] { build_program(test_gpu(), "tonemap").built(); });
    expect_contains(message, "kernels/device/lanes.h:3");
}

// PoCL's own header declares hypot().
TEST(Program, PoclReadsOurDeclarationsAlone) {
    const DeviceInfo& device = test_gpu().info;
    if (!takes_our_declarations(device)) {
        GTEST_SKIP() << device.driver << " reads its own declarations";
    }
    const std::string text = "kernel void f(global float* a) { a[0] = hypot(a[1], a[2]); }";
    expect_contains(build_error([&] { build_text(test_gpu(), "f", text, {}).built(); }), "hypot");
}

TEST(Program, UnknownStageIsAnError) {
    expect_contains(build_error([] { build_program(test_gpu(), "no_such_stage"); }),
                    "kernels/no_such_stage.cl");
}

TEST(Program, SameTextAndOptionsAreBuiltOnce) {
    const Gpu gpu = test_gpu();
    const cl::Program first = build_program(gpu, "build_clusters").built();
    EXPECT_EQ(first(), build_program(gpu, "build_clusters").built()());
    EXPECT_NE(first(),
              build_program(gpu, "build_clusters", BuildOptions().define("UNUSED", 1)).built()());
    const int other_lanes = gpu.info.lane_width == 2 ? 4 : 2;
    EXPECT_NE(first(), build_program(test_gpu(other_lanes), "build_clusters").built()());
}

// A window opens a Gpu for every change of settings: contexts and programs must be released with
// it.
TEST(Program, ContextsAndProgramsGoWithTheLastGpu) {
    const cl::Device device = test_gpu().device;
    const cl::Context context(device);
    const cl::CommandQueue queue(context, device, cl::QueueProperties::Profiling);
    const auto before = context.getInfo<CL_CONTEXT_REFERENCE_COUNT>();
    for (int change = 0; change < 3; ++change) {
        const Gpu gpu(context, queue);
        const cl::Program program = build_program(gpu, "build_clusters").built();
        EXPECT_EQ(build_program(gpu.with_lanes(0), "build_clusters").built()(), program());
    }
    EXPECT_EQ(context.getInfo<CL_CONTEXT_REFERENCE_COUNT>(), before);
}

TEST(Program, LaunchFailureNamesStageAndError) {
    const std::string message = build_error([] {
        in_stage("cull_lights", [] {
            Gpu gpu = test_gpu();
            const cl::Program program = build_program(gpu, "build_clusters").built();
            cl::Kernel kernel(program, "no_such_kernel");
        });
    });
    expect_contains(message, "cull_lights: ");
    expect_contains(message, "failed with CL_INVALID_KERNEL_NAME");
    EXPECT_EQ(cl_error_name(-9999), "OpenCL error -9999");
}

TEST(GrowingBuffer, GrowsAndNeverShrinks) {
    GrowingBuffer buffer(test_gpu(), "test");
    EXPECT_EQ(buffer.bytes(), 0u);
    buffer.reserve(0);
    EXPECT_EQ(buffer.bytes(), 16u);
    const cl::Buffer first = buffer.reserve(1000);
    EXPECT_EQ(buffer.bytes(), 1000u);
    EXPECT_EQ(first.getInfo<CL_MEM_SIZE>(), 1000u);
    EXPECT_EQ(buffer.reserve(999)(), first());
    EXPECT_EQ(buffer.reserve(1000)(), first());
    EXPECT_NE(buffer.reserve(1001)(), first());
    EXPECT_EQ(buffer.get().getInfo<CL_MEM_SIZE>(), 1001u);
}

TEST(GrowingBuffer, MoreThanTheDeviceAllocatesIsAnErrorAndKeepsWhatThereIs) {
    const Gpu gpu = test_gpu();
    GrowingBuffer buffer(gpu, "cull_lights");
    buffer.reserve(64);
    const std::size_t limit = gpu.info.max_allocation_bytes;
    const std::string message = build_error([&] { buffer.reserve(limit + 1); });
    expect_contains(message, "cull_lights: needs a buffer of ");
    expect_contains(message, gpu.info.name + " allocates at most " + mebibytes(limit));
    EXPECT_EQ(buffer.bytes(), 64u);
    EXPECT_EQ(buffer.get().getInfo<CL_MEM_SIZE>(), 64u);
}

Gpu gpu_with_budget(std::uint64_t limit) {
    Gpu gpu = test_gpu();
    gpu.budget = std::make_shared<MemoryBudget>();
    gpu.budget->limit = limit;
    return gpu;
}

TEST(GrowingBuffer, SlackIsLeftOutWhereOnlyTheNeedFits) {
    const Gpu gpu = gpu_with_budget(1000);
    GrowingBuffer buffer(gpu, "test");
    buffer.reserve(400, 100);
    EXPECT_EQ(buffer.bytes(), 500u);
    buffer.reserve(900, 112);
    EXPECT_EQ(buffer.bytes(), 900u);
    EXPECT_EQ(gpu.budget->used, 900u);
    expect_contains(build_error([&] { buffer.reserve(1001, 0); }), "--max-memory");
}

TEST(GrowingBuffer, BudgetCountsTheOldBufferWhileACopyHoldsIt) {
    const Gpu gpu = gpu_with_budget(1000);
    GrowingArray<std::byte> array(gpu, "test");
    DeviceArray<std::byte> held = array.reserve(400);
    expect_contains(build_error([&] { array.reserve(700); }), "--max-memory");
    EXPECT_EQ(array.reserve(600).count(), 600u);
    EXPECT_EQ(gpu.budget->used, 1000u);
    held = {};
    EXPECT_EQ(gpu.budget->used, 600u);
}

TEST(DeviceArray, TakesACallersBufferAsLargeAsItIs) {
    const Gpu gpu = test_gpu();
    const DeviceArray<uint> array = new_buffer(gpu, std::vector<uint>{1, 2, 3, 4, 5});
    EXPECT_EQ(array.count(), 5u);
    EXPECT_EQ(download(gpu, array), (std::vector<uint>{1, 2, 3, 4, 5}));
    EXPECT_EQ(download(gpu, array, 2, 3), (std::vector<uint>{4, 5}));
    EXPECT_EQ(DeviceArray<uint>().count(), 0u);
}

TEST(DownloadIndices, WidensThem) {
    const Gpu gpu = test_gpu();
    const cl::Buffer narrow = new_buffer(gpu, std::vector<std::uint16_t>{7, 65535, 9});
    EXPECT_EQ(download_indices(gpu, narrow, 16, 2, 1), (std::vector<uint>{65535, 9}));
    const cl::Buffer wide = new_buffer(gpu, std::vector<uint>{7, 70000, 9});
    EXPECT_EQ(download_indices(gpu, wide, 32, 1, 1), (std::vector<uint>{70000}));
}

TEST(Text, SplitsAndLowers) {
    EXPECT_EQ(split("a,,b,", ','), (std::vector<std::string_view>{"a", "", "b", ""}));
    EXPECT_EQ(split("", ','), (std::vector<std::string_view>{""}));
    EXPECT_EQ(lower("NVIDIA h200-Z"), "nvidia h200-z");
    EXPECT_EQ(hash_text("foobar"), "d78fda63144c5c84");
}

TEST(StageTimer, SumsEventsByStageInOrderOfFirstUse) {
    const Gpu gpu = test_gpu();
    const std::vector<uint> values(1000, 7);
    const cl::Buffer buffer = new_buffer(gpu, values);
    StageTimer timer;
    for (const char* stage : {"b", "a", "b"}) {
        cl::Event event;
        gpu.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, 4000, values.data(), nullptr, &event);
        timer.record(stage, event);
    }
    const auto times = timer.take();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].stage, "b");
    EXPECT_EQ(times[1].stage, "a");
    EXPECT_GE(times[0].ms, 0.0);
    EXPECT_TRUE(timer.take().empty());
}

TEST(ProgramCache, SaysOnceThatBuildsTakeLong) {
    ProgramCache cache;
    EXPECT_FALSE(cache.add_build_time(0.4));
    EXPECT_FALSE(cache.add_build_time(0.4));
    EXPECT_TRUE(cache.add_build_time(0.4));
    EXPECT_FALSE(cache.add_build_time(5.0));
    EXPECT_NEAR(cache.build_seconds(), 6.2, 1e-9);
}

TEST(ProgramCache, TimesOfThreadsThatBuildAtOnceCountOnce) {
    ProgramCache cache;
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::future<void>> builds;
    for (int i = 0; i < 4; ++i) {
        builds.push_back(std::async(std::launch::async, [&] {
            cache.begin_build();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            cache.end_build();
        }));
    }
    builds.clear();  // waits
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_GE(cache.build_seconds(), 0.02);
    EXPECT_LE(cache.build_seconds(), taken.count());
}

TEST(ProgramCache, BuildsWhileTheCallerGoesOn) {
    if (has_address_space_limit()) GTEST_SKIP() << "builds wait where memory is limited";
    ProgramCache cache;
    cache.build_in_background();
    std::promise<void> begun;
    cache.find("a", [&] {
        begun.set_value();
        return cl::Program();
    });
    // Nobody has asked for the program.
    EXPECT_EQ(begun.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
    EXPECT_EQ(cache.find("a", [] { return cl::Program(); }),
              cache.find("a", [] { return cl::Program(); }));
}

TEST(ProgramCache, AFailedBuildTellsAllWhoUseItAndIsTriedAgain) {
    ProgramCache cache;
    const auto fails = [&]() -> cl::Program { throw Error("no"); };
    const auto build = cache.find("a", fails);
    EXPECT_THROW(build->program(), Error);
    EXPECT_THROW(build->program(), Error);
    const auto other = cache.find("a", [] { return cl::Program(); });
    EXPECT_NE(other, build);
    EXPECT_NO_THROW(other->program());
}

// With more programs than threads that build.
TEST(ProgramCache, ProgramsThatOutliveItAreNotBuilt) {
    std::vector<std::shared_ptr<ProgramBuild>> builds;
    std::atomic<int> begun = 0;
    {
        ProgramCache cache;
        cache.build_in_background();
        for (int i = 0; i < 50; ++i) {
            builds.push_back(cache.find(std::to_string(i), [&] {
                ++begun;
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                return cl::Program();
            }));
        }
    }
    const int of_the_cache = begun;
    EXPECT_LT(of_the_cache, 50);
    int failed = 0;
    for (const auto& build : builds) {
        failed += build_error([&] { build->program(); }) != "no error" ? 1 : 0;
    }
    EXPECT_EQ(failed, 50 - of_the_cache);
    EXPECT_EQ(begun, of_the_cache);
}

}  // namespace
}  // namespace kilolux
