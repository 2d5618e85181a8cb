// SPDX-License-Identifier: Apache-2.0
// The command line: exit codes, messages, help, completion.
#include "present/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>
#include <thread>
#include <tuple>

#include "host/base/version.h"
#include "present/exit_code.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

// One line of the program's own.
void expect_one_line(const std::string& err) {
    EXPECT_TRUE(err.starts_with("kilolux: ")) << err;
    EXPECT_EQ(err.find('\n'), err.size() - 1) << err;
}

TEST(Program, CommandLinesThatCannotBeObeyedExitWithTwo) {
    const struct {
        std::vector<std::string> arguments;
        const char* message;
    } cases[] = {
        {{}, "no command given"},
        {{"redner"},
         "'redner' is no command; there are render, view, bench, report, certify, info, "
         "photometry, export, score, "
         "assemble, merge; did you "
         "mean 'render'?"},
        {{"--frobnicate"}, "unknown option --frobnicate"},
        {{"bench", "--turntable", "90"}, "--turntable: bench times one view"},
        {{"bench", "--camera-keys=keys.json"}, "--camera-keys: bench times one view"},
        {{"render"}, "--output: needs a file"},
        {{"render", "--ligths", "5", "-o", "a.png"},
         "unknown option --ligths; did you mean '--lights'?"},
        {{"render", "--ligths=5", "-o", "a.png"},
         "unknown option --ligths; did you mean '--lights'?"},
        {{"render", "-x"}, "unknown option -x"},
        {{"render", "--lights"}, "--lights: 1 required N missing"},
        {{"render", "--lights", "many", "-o", "a.png"}, "--lights: 'many' is not a whole number"},
        {{"render", "atriumm", "-o", "a.png"}, "scene 'atriumm' is no file, and none of atrium"},
        {{"render", "atrium", "grid", "-o", "a.png"}, "unexpected argument 'grid'"},
        {{"render", "-o", "a.bmp"}, "image type '.bmp' is none of"},
        {{"render", "--quiet=perhaps", "-o", "a.png"}, "quiet"},
        // Before the scene is looked for.
        {{"render", "no.glb", "--renderer", "forward", "--show", "false-positives", "-o", "a.png"},
         "--show false-positives: shows the lists"},
        {{"render", "no.glb", "--renderer", "forward", "--shadows", "exact", "-o", "a.png"},
         "shadows: the forward renderers cast none"},
        {{"render", "no.glb", "--aov", "sample-count", "-o", "a.exr"},
         "aov sample-count: needs --samples auto"},
        {{"info", "--frames", "1:2"}, "unknown option --frames"},
        {{"render", "-o", "a.png", "--stats", "-", "--progress", "alf"}, "--progress: its lines"},
        {{"render", "-o", "-", "--progress", "openjd"}, "--progress: its lines"},
        {{"bench", "--json", "--progress", "openjd"}, "--progress: its lines"},
        {{"report", "--json", "--progress", "openjd"}, "--progress: its lines"},
        {{"certify", "-o", "-", "--progress", "openjd"}, "--progress: its lines"},
        {{"--completion", "csh"}, "--completion: 'csh' is none of bash"},
        {{"help", "redner"}, "did you mean 'render'?"},
        {{"render", "-o", "a.png", "--threshold", "1"}, "--threshold: needs --reference"},
        {{"render", "photo.jpg", "-o", "a.png"}, "scene 'photo.jpg' is a picture"},
        {{"render", "room.blend", "-o", "a.png"}, "is a .blend file; a scene is a .gltf or .glb"},
        {{"info", "cube.OBJ"}, "is a .OBJ file; a scene is a .gltf or .glb"},
        // Behind the mark no word is an option.
        {{"render", "-o", "a.png", "--", "-o"}, "scene '-o' is no file, and none of atrium"},
        {{"render", "-o", "a.png", "--", "grid", "--lights"}, "unexpected argument '--lights'"},
        {{"render", "--"}, "--output: needs a file"},
    };
    for (const auto& c : cases) {
        const ChildResult result = run_kilolux(c.arguments);
        EXPECT_EQ(result.code, 2) << c.message << " / " << result.err;
        EXPECT_TRUE(contains(result.err, c.message)) << c.message << " / " << result.err;
        EXPECT_EQ(result.out, "");
        expect_one_line(result.err);
    }
}

TEST(Program, RuntimeErrorsExitWithOne) {
    const TemporaryFolder folder;
    const std::string picture = (folder / "a.png").string();
    write_text(folder / "broken.glb", "not a scene");
    const struct {
        std::vector<std::string> arguments;
        std::string message;
    } cases[] = {
        {{"render", (folder / "none.glb").string(), "-o", picture}, "none.glb: no such scene file"},
        {{"render", (folder / "broken.glb").string(), "-o", picture}, "broken.glb: "},
        {{"render", "-o", picture, "--", "--quiet.glb"}, "--quiet.glb: no such scene file"},
        {{"render", folder.path().string(), "-o", picture}, "is a folder, not a scene file"},
        {{"render", "-o", (folder / "no/a.png").string()}, "there is no folder"},
        {{"render", "-o", picture, "--stats", (folder / "no/s").string()}, "there is no folder"},
        {{"render", "-o", picture, "--reference", (folder / "r.exr").string()},
         "r.exr: no such reference"},
        {{"render", "-o", picture, "--config", (folder / "c.toml").string()},
         "c.toml: cannot read: No such file or directory"},
        {{"render", "-o", picture, "--device", "no such device"}, "no such device"},
    };
    for (const auto& c : cases) {
        const ChildResult result = run_kilolux(c.arguments);
        EXPECT_EQ(result.code, 1) << c.message << " / " << result.err;
        EXPECT_TRUE(contains(result.err, c.message)) << c.message << " / " << result.err;
        expect_one_line(result.err);
    }
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"broken.glb"}));
}

TEST(Program, StandardOutputThatIsFullIsAnError) {
    const ChildResult result = run_child({"/bin/sh", "-c", program_file() + " --help > /dev/full"});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, "kilolux: standard output: cannot write\n");
}

TEST(Program, VersionAndHelpGoToStandardOutput) {
    const ChildResult said = run_kilolux({"--version"});
    EXPECT_EQ(said.code, 0);
    EXPECT_TRUE(said.out.starts_with("kilolux " + version() + ", commit ")) << said.out;
    for (const char* word : {"\nbuilt with ", ", OpenImageIO 2.", ", OPENCL "}) {
        EXPECT_TRUE(contains(said.out, word)) << said.out;
    }
    const ChildResult help = run_kilolux({"--help"});
    EXPECT_EQ(help.code, 0);
    for (const char* word : {"render", "info", "Exit codes:", "130", "143"}) {
        EXPECT_TRUE(contains(help.out, word)) << word;
    }
    EXPECT_EQ(run_kilolux({"-h"}).out, help.out);
}

TEST(Program, PeoplesWaysToAskForHelpAndVersion) {
    const std::string help = run_kilolux({"--help"}).out;
    EXPECT_EQ(run_kilolux({"help"}).out, help);
    const std::string of_render = run_kilolux({"render", "--help"}).out;
    EXPECT_TRUE(of_render.starts_with("Render a scene")) << of_render;
    EXPECT_EQ(run_kilolux({"help", "render"}).out, of_render);
    EXPECT_EQ(run_kilolux({"--help", "render"}).out, of_render);
    const std::string said = run_kilolux({"--version"}).out;
    EXPECT_EQ(run_kilolux({"version"}).out, said);
    EXPECT_EQ(run_kilolux({"-V"}).out, said);
    // These are answered whatever else is wrong with the line.
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"render", "--lights", "x", "--help"},
          {"render", "--lights", "--help"},
          {"render", "--frobnicate", "-h"}}) {
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.out, of_render);
    }
}

TEST(Program, HelpOfACommandHasOptionsDefaultsMeaningsAndExamples) {
    const ChildResult help = run_kilolux({"render", "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    for (const char* text : {"Usage: kilolux render [SCENE] [OPTIONS]",
                             "--renderer NAME",
                             "deferred - clustered deferred",
                             "forward-plus - clustered forward",
                             "--resolution W,H",
                             "[default: 1920,1080]",
                             "--lights N",
                             "[default: 5000",
                             "--time T",
                             "--camera-position",
                             "--exposure",
                             "neutral - Khronos PBR Neutral",
                             "--aov NAME,...",
                             "--show NAME",
                             "--samples",
                             "--frames A:B",
                             "--shard I/N",
                             "--device",
                             "--list-devices",
                             "--stats FILE",
                             "--reference FILE",
                             "--difference FILE",
                             "--threshold",
                             "--quiet",
                             "--verbose",
                             "--output, -o FILE",
                             "--help-all",
                             "Examples:\n  kilolux render -o atrium.png"}) {
        EXPECT_TRUE(contains(help.out, text)) << text;
    }
    EXPECT_TRUE(contains(help.out, "kilolux render --help-all lists every option."));
    for (const char* text : {"--range-budget", "--math", "--ocio-view", "--max-error"}) {
        EXPECT_FALSE(contains(help.out, text)) << text;
    }
}

TEST(Program, HelpAllHasPagesOfEightyColumns) {
    const Program program;
    for (const CLI::App* command : program.app().get_subcommands({})) {
        const std::string help = run_kilolux({command->get_name(), "--help-all"}).out;
        std::istringstream lines(help.substr(0, help.find("Examples:")));
        for (std::string line; std::getline(lines, line);) {
            const bool is_form = contains(line, "|");  // a list of names is not broken
            EXPECT_TRUE(line.size() <= 80 || is_form) << line;
        }
    }
}

struct Query {
    std::string words;  // typed so far; the last one is being completed
    std::string offers;
};

TEST(Completion, BashOffersWhatFits) {
    const std::vector<Query> queries = {
        {"kilolux re", "render report"},
        {"kilolux ren", "render"},
        {"kilolux render --renderer forw", "forward-plus forward"},
        {"kilolux render --tonemap ''", "none neutral aces agx pbr-neutral"},
        {"kilolux render --aov depth,no", "depth,normal"},
        {"kilolux render --light-r", "--light-radius"},
        {"kilolux render --light-radius a", "auto"},
        {"kilolux render --lights 1", ""},
        {"kilolux info --js", "--json"},
        {"kilolux --comp", "--completion"},
        {"kilolux render atri", "atrium"},
        {"kilolux render -o /etc/host", "/etc/host"},
    };
    std::string script = std::string("cd /; source <(") + program_file() + " --completion bash)\n";
    for (const Query& query : queries) {
        script += "COMP_WORDS=(" + query.words +
                  "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _kilolux; echo \"${COMPREPLY[*]}\"\n";
    }
    std::istringstream answers(run_child({"/bin/bash", "-c", script}).out);
    for (const Query& query : queries) {
        std::string answer;
        std::getline(answers, answer);
        const bool files_too = query.words.ends_with("host");
        const std::string seen = files_too ? answer.substr(0, query.offers.size()) : answer;
        EXPECT_EQ(seen, query.offers) << query.words;
    }
}

TEST(Completion, KnowsEveryOption) {
    const Program program;
    const ChildResult script = run_kilolux({"--completion", "bash"});
    EXPECT_EQ(script.code, 0) << script.err;
    for (const CLI::App* command : program.app().get_subcommands({})) {
        for (const std::string& name : option_names(*command)) {
            EXPECT_TRUE(contains(script.out, name)) << name;
        }
    }
    EXPECT_EQ(run_child({"/bin/bash", "-c", program_file() + " --completion bash | bash -n"}).code,
              0);
}

// The output and the return value of exit_code_of(), in a process of its own.
template <typename Act>
ChildResult end_of(Act act) {
    const TemporaryFolder folder;
    const std::string file = (folder / "err").string();
    const pid_t child = fork();
    if (child == 0) {
        dup2(open(file.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        _exit(act());
    }
    ChildResult result;
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
    result.err = text_of_file(file);
    return result;
}

TEST(ExitCode, WhateverIsThrownIsOneLine) {
    const std::string too_long = "kilolux: " + std::string(256, 'a') + ": File name too long\n";
    const char* const name_too_long = too_long.c_str();
    const struct {
        std::function<void()> work;
        int code;
        const char* line;
    } cases[] = {
        {[] {}, 0, ""},
        {[] { throw Error("a.glb: broken"); }, 1, "kilolux: a.glb: broken\n"},
        {[] { throw UsageError("--x"); }, 2, "kilolux: --x\n"},
        {[] { throw ComparisonFailed("a.png"); }, 3, "kilolux: a.png\n"},
        {[] { throw Interrupted(); }, 130, "kilolux: interrupted\n"},
        {[] { throw std::bad_alloc(); }, 1, "kilolux: out of memory\n"},
        {[] { std::ignore = std::filesystem::file_size(std::string(256, 'a')); }, 1, name_too_long},
        {[] { throw 7; }, 1, "kilolux: internal error: an exception of unknown type\n"}};
    for (const auto& c : cases) {
        const ChildResult result = end_of([&] { return exit_code_of(c.work); });
        EXPECT_EQ(result.code, c.code) << c.line;
        EXPECT_EQ(result.err, c.line);
    }
}

TEST(ExitCode, AnExceptionThatLeavesAThreadIsOneLine) {
    const ChildResult result = end_of([] {
        end_on_uncaught_exceptions();
        std::thread([] { throw std::bad_alloc(); }).join();
        return 99;
    });
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.err, "kilolux: out of memory\n");
}

// A file in its place hides libEGL.so.1.
TEST(Program, RendersWithoutOpenGL) {
    const TemporaryFolder folder;
    std::ofstream(folder / "libEGL.so.1") << "hidden";
    const std::string picture = (folder / "picture.png").string();
    const auto render = [&](const std::string& geometry) {
        return run_child({"/usr/bin/env", "LD_LIBRARY_PATH=" + folder.path().string(),
                          program_file(), "render", "grid", "--resolution", "64,36", "--lights",
                          "50", "--quiet", "--geometry", geometry, "-o", picture});
    };
    const ChildResult ids = render("ids");
    EXPECT_EQ(ids.code, 1);
    EXPECT_NE(ids.err.find("libEGL.so.1"), std::string::npos) << ids.err;
    EXPECT_NE(ids.err.find("--geometry compute"), std::string::npos) << ids.err;
    for (const char* geometry : {"compute", "auto"}) {
        const ChildResult result = render(geometry);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(std::filesystem::exists(picture)) << geometry;
        std::filesystem::remove(picture);
    }
}

// OpenImageIO brings 260 libraries, which take longer to load than these commands do.
TEST(Program, LoadsOpenImageIoForImagesAlone) {
    const TemporaryFolder folder;
    const std::string picture = (folder / "picture.png").string();
    const auto loads_it = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"/usr/bin/env", "LD_DEBUG=files", program_file()});
        const ChildResult result = run_child(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return result.err.find("libOpenImageIO") != std::string::npos;
    };
    EXPECT_FALSE(loads_it({"--help"}));
    EXPECT_FALSE(loads_it({"info", "grid"}));
    EXPECT_TRUE(loads_it(
        {"render", "grid", "--resolution", "64,36", "--lights", "50", "--quiet", "-o", picture}));
}

TEST(Program, SaysThatTheLibraryOfImagesIsMissing) {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "an instrumented program has the whole path of this library";
#endif
    const TemporaryFolder folder;
    std::ofstream(folder / "libkilolux_images.so") << "hidden";
    const std::string picture = (folder / "picture.png").string();
    const ChildResult result = run_child(
        {"/usr/bin/env", "LD_LIBRARY_PATH=" + folder.path().string(), program_file(), "render",
         "grid", "--resolution", "64,36", "--lights", "50", "--quiet", "-o", picture});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("cannot load the library of images: "), std::string::npos);
    EXPECT_NE(result.err.find("libkilolux_images.so"), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(picture));
}

}  // namespace
}  // namespace kilolux
