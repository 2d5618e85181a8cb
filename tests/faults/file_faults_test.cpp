// SPDX-License-Identifier: Apache-2.0
// Faults of files, disks and memory: each ends in one line and exit code 1, leaves no temporary
// file, and leaves an earlier output as it was.
#include <fmt/format.h>
#include <sys/mount.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/faults/faults.h"

namespace kilolux {
namespace {

// PoCL's folder of kernels cannot be made, and no linker is on PATH: a private folder is used, and
// removed at the end.
TEST_F(Faults, AFolderOfKernelsThatCannotBeUsed) {
    const std::string temporary = "TMPDIR=" + elsewhere_.path().string();
    const Words homeless = {"POCL_CACHE_DIR=", "XDG_CACHE_HOME=", "HOME=/dev/null/x"};
    Words alone = homeless;
    alone.insert(alone.end(), {temporary, "PATH=/nowhere"});
    const ChildResult made =
        run_child(render_words(with_environment(alone), picture_, {"--geometry", "compute"}));
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(has(made.err,
                    "PoCL's folder of kernels /dev/null/x/.cache/pocl/kcache: cannot be "
                    "made: Not a directory; this run keeps them in a temporary folder"))
        << made.err;
    const std::size_t said = made.err.find("building kernels for ");
    EXPECT_LT(said, made.err.find("frame  ")) << made.err;
    EXPECT_EQ(made.err.find("building kernels for ", said + 1), std::string::npos) << made.err;
    EXPECT_EQ(names_in(elsewhere_), std::set<std::string>{});
    write_text(picture_, kOld);
    Words nowhere = homeless;
    nowhere.emplace_back("TMPDIR=/nowhere");
    expect_refused(with_environment(nowhere), "set POCL_CACHE_DIR to a folder that can be used");
}

TEST_F(Faults, AFolderOfKernelsWithoutSpaceOrExecution) {
    const fs::path mounted = elsewhere_ / "mounted";
    fs::create_directory(mounted);
    if (mount("kilolux", mounted.c_str(), "tmpfs", 0, "size=64m") != 0) {
        GTEST_SKIP() << "no permission to mount a tmpfs";
    }
    EXPECT_EQ(umount(mounted.c_str()), 0);
    const auto listed = [&](unsigned long flags, const char* options) {
        EXPECT_EQ(mount("kilolux", mounted.c_str(), "tmpfs", flags, options), 0);
        const ChildResult result = run_child({"/usr/bin/env", "POCL_CACHE_DIR=" + mounted.string(),
                                              program_file(), "info", "--list-devices"});
        EXPECT_EQ(umount(mounted.c_str()), 0);
        EXPECT_EQ(result.code, 0);
        EXPECT_TRUE(has(result.out, "OpenCL")) << result.out;
        return result.err;
    };
    const std::string no_code = listed(MS_NOEXEC, "size=64m");
    EXPECT_TRUE(has(no_code, "code in it may not run")) << no_code;
    EXPECT_TRUE(has(listed(0, "size=1m"), "less than 32 MiB are free"));
    EXPECT_TRUE(has(listed(MS_RDONLY, "size=64m"), "cannot be written to"));
    EXPECT_EQ(listed(0, "size=64m"), "");
}

TEST_F(Faults, FileSizeLimitAndFullDisk) {
    // Enough for the OpenCL compiler's files (preprocessed headers, 0.9 MB), too little for the
    // picture.
    const Words large = {"--resolution", "4000,2500"};
    ASSERT_EQ(run_child(render_words({}, elsewhere_ / "a.png", large)).code, 0);
    ASSERT_GT(fs::file_size(elsewhere_ / "a.png"), 1'700'000u);
    expect_refused({"/usr/bin/prlimit", "--fsize=1400000"}, "a.png: cannot write: File too large",
                   large);
    const fs::path mounted = elsewhere_ / "full";
    fs::create_directory(mounted);
    if (mount("kilolux", mounted.c_str(), "tmpfs", 0, "size=4k") != 0) {
        GTEST_SKIP() << "no permission to mount a tmpfs; the file-size limit was tested";
    }
    write_text(mounted / "b", std::string(4096, 'x'));
    write_text(mounted / "a.png", "");
    const ChildResult result = run_child(render_words({}, mounted / "a.png"));
    expect_failure(result, "a.png: cannot write: No space left on device");
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(mounted)) {
        names.insert(entry.path().filename().string());
    }
    EXPECT_EQ(names, (std::set<std::string>{"a.png", "b"}));
    EXPECT_EQ(umount(mounted.c_str()), 0);
}

TEST_F(Faults, MemoryThatIsShort) {
    for (const char* size : {"1K", "1M", "100M"}) {
        expect_refused({}, "--max-memory is ", {"--max-memory", size});
    }
    // Bloom needs the whole picture; without it there are strips.
    expect_refused({}, "memory: 65536x16384 pixels",
                   {"--resolution", "65536,16384", "--max-memory", "2G", "--bloom", "0.1"});
    expect_refused({}, "memory: the program and 2147483648 generated lights need",
                   {"--lights", "2147483648"});
#if !defined(__SANITIZE_ADDRESS__)
    expect_refused({"/usr/bin/prlimit", "--as=4000000000"}, "memory: 16384x8192 pixels",
                   {"--resolution", "16384,8192", "--bloom", "0.1"});
#endif
}

#if !defined(__SANITIZE_ADDRESS__)
// Libraries crash or wait for ever where the address space is short: none of them starts.
TEST_F(Faults, AddressSpaceThatIsShort) {
    constexpr std::uint64_t kLeast = 80;  // [MiB]; with less, the dynamic loader refuses
    for (const char* geometry : {"compute", "ids"}) {
        write_text(picture_, kOld);
        for (std::uint64_t limit = kLeast; limit < 2400; limit += limit < 440 ? 120 : 37) {
            SCOPED_TRACE(fmt::format("{} with {} MiB", geometry, limit));
            const ChildResult result =
                run_child(render_words({"/usr/bin/timeout", "-s", "KILL", "300", "/usr/bin/prlimit",
                                        fmt::format("--as={}", limit << 20)},
                                       picture_, {"--geometry", geometry}));
            if (result.code == 0) break;
            expect_failure(result, " MiB");
            EXPECT_EQ(result.err.find('\n') + 1, result.err.size()) << "one line\n" << result.err;
            expect_untouched();
        }
    }
}
#endif

TEST_F(Faults, OutputsThatCannotBeWritten) {
    const TemporaryFolder other;
    const fs::path lost = other / "gone/a.png";
    const ChildResult result = run_child(render_words({}, lost));
    expect_failure(result, "there is no folder");
    expect_refused({}, "there is no folder", {"--stats", (other / "gone/stats.json").string()});
    EXPECT_TRUE(names_in(other).empty());
}

// An unmounted share, a folder that another job moves: the task is started again.
TEST_F(Faults, AFolderThatVanishesEndsTheSequence) {
    const fs::path lost = elsewhere_ / "lost", moved = elsewhere_ / "moved";
    for (const char* name : {"f.####.png", "f.####.exr", "f.y4m"}) {
        fs::create_directory(lost);
        const ChildResult result =
            run_child(render_words({}, lost / name, {"--frames", "0:499", "--quiet"}), [&](pid_t) {
                for (int i = 0; i < 12000 && fs::is_empty(lost); ++i)
                    std::this_thread::sleep_for(std::chrono::milliseconds(5));
                fs::rename(lost, moved);
            });
        expect_failure(result, (lost / "f.").string());
        EXPECT_TRUE(has(result.err, "No such file or directory")) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        EXPECT_FALSE(fs::exists(lost)) << "it is not made again";
        fs::remove_all(lost);
        fs::remove_all(moved);
    }
}

// The table of exit codes in host/install/farm: 2 is not worth a retry.
TEST_F(Faults, BadOptionsAreTwoAndBadScenesOne) {
    write_text(elsewhere_ / "broken.gltf", "{\"asset\": {");
    write_text(elsewhere_ / "old.gltf", R"({"asset": {"version": "1.0"}})");
    write_text(elsewhere_ / "missing.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
"buffers":[{"byteLength":36,"uri":"no.bin"}]})");
    write_text(elsewhere_ / "text.glb", "this is no glTF");
    const struct {
        Words more;
        int code;
    } cases[] = {{{"--lights", "-1"}, 2},
                 {{"--no-such-option"}, 2},
                 {{"--frames", "5:1"}, 2},
                 {{"--frames", "0:3"}, 2},  // one file
                 {{"--shard", "4/4", "--frames", "0:9"}, 2},
                 {{"--shard", "auto/4", "--frames", "0:9"}, 2},  // no scheduler
                 {{"--crop", "40,0,9,9"}, 2},
                 {{"--tiles", "9x9"}, 2},  // one file
                 {{"-o", (elsewhere_ / "a.bmp").string()}, 2},
                 {{"--device", "no such device"}, 1},
                 {{(elsewhere_ / "broken.gltf").string()}, 1},
                 {{(elsewhere_ / "old.gltf").string()}, 1},
                 {{(elsewhere_ / "missing.gltf").string()}, 1},
                 {{(elsewhere_ / "text.glb").string()}, 1},
                 {{(elsewhere_ / "no_such.gltf").string()}, 1}};
    for (const auto& c : cases) {
        Words words = render_words({}, picture_, c.more);
        // A scene takes the place of the usual one.
        if (!c.more.front().starts_with("-")) {
            words[2] = c.more.front();
            words.pop_back();
        }
        const ChildResult result = run_child(words);
        EXPECT_EQ(result.code, c.code) << c.more.front() << ": " << result.err;
        EXPECT_TRUE(result.err.starts_with("kilolux: ")) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        expect_untouched();
    }
}

}  // namespace
}  // namespace kilolux
