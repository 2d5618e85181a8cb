// SPDX-License-Identifier: Apache-2.0
// Runtime errors (device, driver, disk, memory, signals): each ends in one line and exit code 1
// (130 for signals), leaves no temporary file, and leaves an earlier output as it was.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

constexpr const char* kOld = "an earlier output";

// `render` of a small scene to `file`, run by `before`: a program with its options that changes the
// environment, e.g. prlimit.
Words render_words(Words before, const fs::path& file, const Words& more = {}) {
    const Words render = {program_file(), "render", "plain", "--lights",   "50",
                          "--resolution", "48,32",  "-o",    file.string()};
    before.insert(before.end(), render.begin(), render.end());
    before.insert(before.end(), more.begin(), more.end());
    return before;
}

Words with_environment(const Words& variables) {
    Words words = {"/usr/bin/env"};
    words.insert(words.end(), variables.begin(), variables.end());
    return words;
}

bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

// The last line is the error; warnings of the program or of drivers may stand before it.
void expect_failure(const ChildResult& result, std::string_view part) {
    EXPECT_EQ(result.code, 1) << "signal " << result.signal << "\n" << result.err;
    EXPECT_TRUE(has(result.err, part)) << result.err;
    EXPECT_TRUE(has("\n" + result.err, "\nkilolux: ")) << result.err;
}

class Faults : public testing::Test {
 protected:
    Faults() { write_text(picture_, kOld); }

    void expect_untouched() const {
        EXPECT_EQ(names_in(folder_), std::set<std::string>{"a.png"});
        EXPECT_EQ(text_of_file(picture_), kOld);
    }
    void expect_refused(const Words& before, std::string_view part, const Words& more = {}) const {
        SCOPED_TRACE(std::string(part));
        expect_failure(run_child(render_words(before, picture_, more)), part);
        expect_untouched();
    }

    TemporaryFolder folder_;
    TemporaryFolder elsewhere_;
    fs::path picture_ = folder_ / "a.png";
};

// One of two devices fails in a call of its renderer: the other one makes its pictures again, and
// the exit code tells. A call that opens the first renderer ends the job.
TEST_F(Faults, ADeviceOfTwoIsLeftOut) {
    const auto render = [&](const std::string& fault, const fs::path& file) {
        Words words = with_environment({"OPENCL_LAYERS=" KILOLUX_FAULT_LAYER,
                                        "KILOLUX_FAULT=" + fault, "POCL_DEVICES=pthread pthread"});
        return run_child(render_words(words, file, {"--device", "0,1", "--frames", "0:7"}));
    };
    const ChildResult whole = render("0:0", elsewhere_ / "a.y4m");
    ASSERT_EQ(whole.code, 0) << whole.err;
    int left_out = 0;
    for (const int call : {600, 900, 1200}) {
        const ChildResult result = render(std::to_string(call) + ":-5", elsewhere_ / "b.y4m");
        if (result.code == 0) break;  // there are fewer calls
        EXPECT_EQ(result.code, 1) << result.err;
        left_out += has(result.err, " is left out: ") ? 1 : 0;
        EXPECT_TRUE(has(result.err, "CL_OUT_OF_RESOURCES")) << result.err;
        EXPECT_TRUE(has(result.err, "; the other devices made the rest")) << result.err;
        EXPECT_EQ(text_of_file(elsewhere_ / "b.y4m"), text_of_file(elsewhere_ / "a.y4m"));
    }
    EXPECT_GT(left_out, 0);
}

// The same of one picture: the other device makes the rows of the one that fails.
TEST_F(Faults, ADeviceOfTwoThatMakeAPictureIsLeftOut) {
    const auto render = [&](const std::string& fault, const fs::path& file) {
        Words words = with_environment({"OPENCL_LAYERS=" KILOLUX_FAULT_LAYER,
                                        "KILOLUX_FAULT=" + fault, "POCL_DEVICES=pthread pthread"});
        return run_child(render_words(words, file, {"--device", "0,1", "--samples", "16"}));
    };
    const ChildResult whole = render("0:0", elsewhere_ / "a.png");
    ASSERT_EQ(whole.code, 0) << whole.err;
    int left_out = 0;
    for (const int call : {600, 900, 1200, 1500, 1800}) {
        const ChildResult result = render(std::to_string(call) + ":-5", elsewhere_ / "b.png");
        if (result.code == 0) break;  // there are fewer calls
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_TRUE(has(result.err, "CL_OUT_OF_RESOURCES")) << result.err;
        if (!has(result.err, " is left out: ")) continue;  // of the first renderer's beginning
        ++left_out;
        EXPECT_TRUE(has(result.err, "; the other devices made the rest")) << result.err;
        EXPECT_EQ(text_of_file(elsewhere_ / "b.png"), text_of_file(elsewhere_ / "a.png"));
    }
    EXPECT_GT(left_out, 0);
}

// The same of a report: others measure the settings again, with the same errors, and all times.
TEST_F(Faults, ADeviceOfTwoThatMeasureAReportIsLeftOut) {
    const auto report = [&](const std::string& fault) {
        Words words = with_environment({"OPENCL_LAYERS=" KILOLUX_FAULT_LAYER,
                                        "KILOLUX_FAULT=" + fault, "POCL_DEVICES=pthread pthread"});
        const Words more = {
            program_file(), "report", "plain",    "--lights", "50",        "--quick",
            "--resolution", "48,32",  "--frames", "1",        "--warm-up", "0",
            "--axes",       "lanes",  "--device", "0,1",      "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return run_child(words);
    };
    const auto errors = [](const ChildResult& result) {
        std::vector<nlohmann::json> out;
        const nlohmann::json json = nlohmann::json::parse(result.out);
        for (const auto& row : json.at("rows"))
            out.push_back(
                {row.at("R1 rmse"), row.at("R2 rmse"), row.at("R3 flip mean"), row.at("k*")});
        return out;
    };
    const ChildResult whole = report("0:0");
    ASSERT_EQ(whole.code, 0) << whole.err;
    int left_out = 0;
    for (const int call : {300, 700, 1800}) {
        const ChildResult result = report(std::to_string(call) + ":-5");
        if (result.code == 0) break;  // there are fewer calls
        SCOPED_TRACE(call);
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_TRUE(has(result.err, "CL_OUT_OF_RESOURCES")) << result.err;
        if (!has(result.err, " is left out: ")) continue;  // of the first device's beginning
        ++left_out;
        EXPECT_TRUE(has(result.err, "; the other devices measured the rest")) << result.err;
        EXPECT_EQ(errors(result), errors(whole));
    }
    EXPECT_GT(left_out, 0);
}

TEST_F(Faults, NoPlatformNoDeviceNoOpenGl) {
    const std::string empty = elsewhere_.path().string();
    expect_refused(with_environment({"OCL_ICD_VENDORS=" + empty}), "OpenCL: no device found");
    expect_refused(with_environment({"POCL_DEVICES=none"}), "OpenCL: no device found");
    Words list = with_environment({"OCL_ICD_VENDORS=" + empty});
    list.insert(list.end(), {program_file(), "--list-devices"});
    expect_failure(run_child(list), "OpenCL: no device found");
    expect_refused(with_environment({"__EGL_VENDOR_LIBRARY_FILENAMES=" + empty + "/none.json"}),
                   "EGL: no headless OpenGL 4.5 context", {"--geometry", "ids"});
    write_text(elsewhere_ / "broken.icd", "libno-such-driver.so.1\n");
    expect_refused(with_environment({"OCL_ICD_VENDORS=" + empty}), "OpenCL: no device found");
    write_text(elsewhere_ / "broken.icd", "libm.so.6\n");  // a library, but no driver
    expect_refused(with_environment({"OCL_ICD_VENDORS=" + empty}), "OpenCL: no device found");
}

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

// Groups of 256 are built in for GPUs; a device may allow fewer.
TEST_F(Faults, ADeviceOfSmallWorkGroups) {
    const fs::path expected = elsewhere_ / "large.png", small_file = elsewhere_ / "small.png";
    const Words more = {"--geometry", "compute", "--shadows", "exact",
                        "--bloom",    "0.1",     "--bits",    "16"};
    const std::string device = "KILOLUX_DEVICE_KIND=gpu";
    const ChildResult large = run_child(render_words(with_environment({device}), expected, more));
    EXPECT_EQ(large.code, 0) << large.err;
    for (const char* most : {"POCL_MAX_WORK_GROUP_SIZE=64", "POCL_MAX_WORK_GROUP_SIZE=8",
                             "POCL_MAX_WORK_GROUP_SIZE=4"}) {
        const ChildResult small =
            run_child(render_words(with_environment({device, most}), small_file, more));
        EXPECT_EQ(small.code, 0) << most << small.err;
        EXPECT_EQ(read_image(small_file).values, read_image(expected).values) << most;
    }
}

// Where OpenGL was not asked for, OpenCL draws; libEGL's own messages are not printed.
TEST_F(Faults, OpenGlThatCannotBeUsedIsNotNeeded) {
    // A device for which OpenGL was not measured to be slower.
    const std::string device = "KILOLUX_DEVICE_KIND=gpu", nothing_kept = "XDG_CACHE_HOME=/dev/null";
    const fs::path expected = elsewhere_ / "compute.png", file = elsewhere_ / "auto.png";
    ASSERT_EQ(
        run_child(render_words(with_environment({device}), expected, {"--geometry", "compute"}))
            .code,
        0);
    for (const char* variable :
         {"LIBGL_DRIVERS_PATH=/nowhere", "__EGL_VENDOR_LIBRARY_DIRS=/nowhere",
          "GALLIUM_DRIVER=softpipe", "MESA_GL_VERSION_OVERRIDE=3.1"}) {
        const ChildResult made =
            run_child(render_words(with_environment({variable, device, nothing_kept}), file));
        EXPECT_EQ(made.code, 0) << variable << made.err;
        EXPECT_TRUE(has(made.err, "OpenCL draws in place of OpenGL: EGL: no headless OpenGL 4.5"))
            << variable << made.err;
        EXPECT_FALSE(has(made.err, "libEGL warning")) << made.err;
        EXPECT_EQ(read_image(file).values, read_image(expected).values) << variable;
    }
}

// Only OpenGL draws surfaces that blend.
TEST_F(Faults, OpenGlThatCannotBeUsedIsMissedByWhatBlends) {
    const std::string scene = (elsewhere_ / "glass.gltf").string();
    write_text(scene, R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"alphaMode":"BLEND"}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
"buffers":[{"byteLength":36,"uri":
"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    for (const char* variable :
         {"LIBGL_DRIVERS_PATH=/nowhere", "__EGL_VENDOR_LIBRARY_DIRS=/nowhere"}) {
        for (const char* geometry : {"auto", "ids", "compute"}) {
            Words words = with_environment({variable});
            const Words render = {program_file(), "render",       scene,   "-q", "--geometry",
                                  geometry,       "--resolution", "48,32", "-o", picture_.string()};
            words.insert(words.end(), render.begin(), render.end());
            const ChildResult result = run_child(words);
            expect_failure(result,
                           "kilolux: surfaces that blend (alphaMode BLEND) are drawn by OpenGL: "
                           "EGL: no headless OpenGL 4.5 context");
            EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
            expect_untouched();
        }
    }
}

TEST_F(Faults, DeviceLostOnTheWay) {
    const std::string layer = "OPENCL_LAYERS=" KILOLUX_FAULT_LAYER;
    for (const int call : {1, 2, 30, 90, 120}) {
        expect_refused(with_environment({layer, "KILOLUX_FAULT=" + std::to_string(call) + ":-5"}),
                       "CL_OUT_OF_RESOURCES");
    }
}

TEST_F(Faults, KernelsThatDoNotBuild) {
    for (const char* room : {"kernels", "raster"}) {
        fs::copy(fs::path(source_root()) / room, elsewhere_ / room, fs::copy_options::recursive);
    }
    const Words developer = with_environment({"KILOLUX_SOURCE_DIR=" + elsewhere_.path().string()});
    const std::string shade = text_of_file(elsewhere_ / "kernels/shading/shade.cl");
    write_text(elsewhere_ / "kernels/shading/shade.cl", shade + "\nthis is no OpenCL C\n");
    const ChildResult result = run_child(render_words(developer, picture_));
    expect_failure(result,
                   "kernels/shading/shade.cl: build failed with CL_BUILD_PROGRAM_FAILURE on ");
    expect_untouched();
    for (const char* part :
         {"options '-cl-std=CL1.2", "unknown type name 'this'", "error: kernels/shading/shade.cl:",
          "kilolux: warning: sources are read from KILOLUX_SOURCE_DIR="}) {
        EXPECT_TRUE(has(result.err, part)) << part << "\n" << result.err;
    }
    fs::remove(elsewhere_ / "kernels/shading/shade.cl");
    expect_refused(developer, "kernels/shading/shade.cl: cannot read");
    write_text(elsewhere_ / "kernels/shading/shade.cl", shade);
    write_text(elsewhere_ / "raster/shaders/coverage.frag", "#version 450\nthis is no GLSL\n");
    expect_refused(developer, "raster/shaders/coverage.frag", {"--geometry", "ids"});
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

// Once lost, a device fails every call. The next try makes what is missing.
TEST_F(Faults, ADeviceThatIsLostEndsTheSequence) {
    const auto render = [&](const Words& before, const std::string& folder) {
        fs::create_directories(elsewhere_ / folder);
        return run_child(render_words(before, elsewhere_ / folder / "f.#.png",
                                      {"--frames", "0:5", "--quiet", "--skip-existing"}));
    };
    ASSERT_EQ(render({}, "whole").code, 0);
    std::set<std::size_t> made;
    for (int call = 400;; call += 200) {
        const std::string folder = fmt::to_string(call);
        const ChildResult result =
            render(with_environment({"OPENCL_LAYERS=" KILOLUX_FAULT_LAYER,
                                     fmt::format("KILOLUX_FAULT={}:-2:lost", call)}),
                   folder);
        if (result.code == 0) break;  // there are fewer calls
        SCOPED_TRACE(call);
        expect_failure(result, "CL_DEVICE_NOT_AVAILABLE");
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        std::size_t files = 0;
        for (const auto& entry : fs::directory_iterator(elsewhere_ / folder)) {
            files += entry.path().extension() == ".png" ? 1 : 100;
        }
        made.insert(files);
        ASSERT_EQ(render({}, folder).code, 0);
        for (int frame = 0; frame < 6; ++frame) {
            const std::string name = fmt::format("f.{}.png", frame);
            EXPECT_EQ(text_of_file(elsewhere_ / folder / name),
                      text_of_file(elsewhere_ / "whole" / name));
        }
    }
    ASSERT_FALSE(made.empty()) << "no call was lost";
    EXPECT_LT(*made.rbegin(), 6u) << "no file but pictures";
    EXPECT_GT(made.size(), 1u) << "at several frames of the sequence";
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

// Waits until the program handles the signal, which it blocks for a thread that waits for it
// (proc_pid_status(5)), or has ended.
void wait_until_handled(pid_t child, int number) {
    for (siginfo_t ended = {}; ended.si_pid != child;) {
        const std::string status = text_of_file(fmt::format("/proc/{}/status", child));
        const std::size_t at = status.find("SigBlk:");
        if (at != std::string::npos) {
            const std::uint64_t blocked = std::stoull(status.substr(at + 7), nullptr, 16);
            if ((blocked >> (number - 1) & 1) != 0) return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
    }
}

// SIGINT and SIGTERM at any moment from start to end: one in four while libraries are loaded, the
// others after main() has begun to handle them.
TEST_F(Faults, SignalsAtRandomMoments) {
    using Clock = std::chrono::steady_clock;
    const Words words = render_words({}, picture_, {"--quiet"});
    ASSERT_EQ(run_child(words).code, 0) << "builds the kernels";
    Clock::time_point start, handled;
    ASSERT_EQ(run_child(words,
                        [&](pid_t child) {
                            start = Clock::now();
                            wait_until_handled(child, SIGINT);
                            handled = Clock::now();
                        })
                  .code,
              0);
    const Clock::duration loading = handled - start, working = Clock::now() - handled;
    std::mt19937 random(11);
    int interrupted = 0, finished = 0, early = 0;
    for (int i = 0; i < 16; ++i) {
        const int number = i % 2 == 0 ? SIGINT : SIGTERM;
        const bool loads = i % 8 < 2;
        const auto moment = (loads ? loading : working) * static_cast<int>(random() % 1000) / 1000;
        write_text(picture_, kOld);
        const ChildResult result = run_child(words, [&](pid_t child) {
            if (!loads) wait_until_handled(child, number);
            std::this_thread::sleep_for(moment);
            kill(child, number);
        });
        SCOPED_TRACE(fmt::format("signal {} after {} s{}\n{}", number,
                                 std::chrono::duration<double>(moment).count(),
                                 loads ? " of loading" : "", result.err));
        EXPECT_EQ(names_in(folder_), std::set<std::string>{"a.png"});
        if (result.signal != 0) {
            EXPECT_TRUE(loads) << "main() handles signals";
            EXPECT_EQ(result.signal, number);
            EXPECT_EQ(text_of_file(picture_), kOld);
            ++early;
        } else if (result.code == 0) {
            EXPECT_NE(text_of_file(picture_), kOld);
            ++finished;
        } else {
            EXPECT_EQ(result.code, 128 + number);
            EXPECT_EQ(result.err, "kilolux: interrupted\n");
            EXPECT_EQ(text_of_file(picture_), kOld);
            ++interrupted;
        }
    }
    EXPECT_GT(interrupted, 5) << early << " early, " << finished << " finished";
}

// A sequence that is interrupted leaves whole frames only.
TEST_F(Faults, InterruptedSequenceLeavesWholeFrames) {
    const std::string pattern = (elsewhere_ / "f.###.exr").string();
    const ChildResult result =
        run_child(render_words({}, picture_, {"-o", pattern, "--frames", "0:999", "--quiet"}),
                  [&](pid_t child) {
                      while (names_in(elsewhere_).size() < 5) {
                          std::this_thread::sleep_for(std::chrono::milliseconds(20));
                      }
                      kill(child, SIGTERM);
                  });
    EXPECT_EQ(result.code, 143) << result.err;
    std::uintmax_t size = 0;
    for (const std::string& name : names_in(elsewhere_)) {
        EXPECT_TRUE(name.starts_with("f.") && name.ends_with(".exr")) << name;
        EXPECT_GT(fs::file_size(elsewhere_ / name), 500u) << name;
        size += fs::file_size(elsewhere_ / name);
    }
    EXPECT_GT(size, 0u);
}

}  // namespace
}  // namespace kilolux
