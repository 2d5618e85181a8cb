// SPDX-License-Identifier: Apache-2.0
// Faults of OpenCL devices and of OpenGL: each ends in one line and exit code 1, or other devices
// do the work.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/faults/faults.h"

namespace kilolux {
namespace {

// One of two devices fails in a call of its renderer: the other one makes its pictures again, and
// the exit code tells. A call that opens the first renderer ends the job.
TEST_F(Faults, ADeviceOfTwoIsLeftOut) {
    const auto render = [&](const std::string& fault, const fs::path& file) {
        Words words = with_fault(fault, {"POCL_DEVICES=pthread pthread"});
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
        Words words = with_fault(fault, {"POCL_DEVICES=pthread pthread"});
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
        Words words = with_fault(fault, {"POCL_DEVICES=pthread pthread"});
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

// Groups of 256 are built in for GPUs; a device may allow fewer.
TEST_F(Faults, ADeviceOfSmallWorkGroups) {
    const fs::path expected = elsewhere_ / "large.png", small_file = elsewhere_ / "small.png";
    const std::string device = "KILOLUX_DEVICE_KIND=gpu";
    const auto expect_same = [&](const Words& more, const std::vector<std::string>& sizes) {
        const ChildResult large =
            run_child(render_words(with_environment({device}), expected, more));
        EXPECT_EQ(large.code, 0) << large.err;
        for (const std::string& size : sizes) {
            const std::string most = "POCL_MAX_WORK_GROUP_SIZE=" + size;
            const ChildResult small =
                run_child(render_words(with_environment({device, most}), small_file, more));
            EXPECT_EQ(small.code, 0) << most << small.err;
            EXPECT_EQ(read_image(small_file).values, read_image(expected).values) << most;
        }
    };
    expect_same({"--geometry", "compute", "--shadows", "exact", "--bloom", "0.1", "--bits", "16"},
                {"64", "8", "4", "2"});
    // Lists of that many lights are refined by groups of 128, where the device allows them.
    expect_same({"--geometry", "compute", "--lights", "70000"}, {"64"});
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

// OpenCL lights surfaces that blend over opaque ones that either has drawn.
TEST_F(Faults, OpenGlThatCannotBeUsedIsNotMissedByWhatBlends) {
    const std::string scene = (elsewhere_ / "glass.gltf").string();
    write_text(scene, R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"alphaMode":"BLEND"}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
"buffers":[{"byteLength":36,"uri":
"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    for (const char* geometry : {"ids", "auto", "compute"}) {
        for (const char* variable :
             {"LIBGL_DRIVERS_PATH=/nowhere", "__EGL_VENDOR_LIBRARY_DIRS=/nowhere"}) {
            Words words = with_environment({variable});
            const Words render = {program_file(), "render",       scene,   "-q", "--geometry",
                                  geometry,       "--resolution", "48,32", "-o", picture_.string()};
            words.insert(words.end(), render.begin(), render.end());
            const ChildResult result = run_child(words);
            if (std::string_view(geometry) == "ids") {
                expect_failure(result, "EGL: no headless OpenGL 4.5 context");
                expect_untouched();
            } else {
                EXPECT_EQ(result.code, 0) << result.err;
            }
        }
    }
}

TEST_F(Faults, DeviceLostOnTheWay) {
    for (const int call : {1, 2, 30, 90, 120})
        expect_refused(with_fault(std::to_string(call) + ":-5"), "CL_OUT_OF_RESOURCES");
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
        const ChildResult result = render(with_fault(fmt::format("{}:-2:lost", call)), folder);
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

}  // namespace
}  // namespace kilolux
