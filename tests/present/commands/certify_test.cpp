// SPDX-License-Identifier: Apache-2.0
// `kilolux certify`: its exit codes, its table and its JSON.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <limits>
#include <regex>

#include "host/base/error.h"
#include "present/commands/certify/certify.h"
#include "present/commands/certify/certify_json.h"
#include "tests/support/cache_sandbox.h"
#include "tests/support/child.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Certify : public CacheSandbox {};

// Without the size of the device's memory: that of a virtual machine grows while it runs.
std::string without_memory(const std::string& text) {
    return std::regex_replace(text, std::regex("\\n *\"memory_bytes\": [0-9]+,"), "");
}

TEST_F(Certify, RunsTheChosenCasesAndWritesTheirJson) {
    const TemporaryFolder folder;
    const std::string file = (folder / "device.json").string();
    const ChildResult result =
        run_kilolux({"certify", "--case", "M2,nothing", "--lanes", "1,8", "--quiet", "-o", file});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(contains(result.out, "| 27 ")) << result.out;
    EXPECT_TRUE(contains(result.out, "| idle-lights ")) << result.out;
    EXPECT_FALSE(contains(result.out, "| 26 ")) << result.out;
    const Json json = Json::parse(text_of_file(file));
    EXPECT_TRUE(json.at("passed"));
    EXPECT_EQ(json.at("failed"), Json::array());
    for (const char* key : {"version", "commit"}) {
        EXPECT_FALSE(json.at("program").at(key).get<std::string>().empty()) << key;
    }
    for (const char* key :
         {"name", "version", "driver", "platform", "vendor", "opencl_c", "host_processor"}) {
        EXPECT_FALSE(json.at("device").at(key).get<std::string>().empty()) << key;
    }
    ASSERT_EQ(json.at("cases").size(), 2u);
    const Json& nothing = json.at("cases").at(0);
    EXPECT_EQ(nothing.at("case"), "27");
    EXPECT_EQ(nothing.at("name"), "nothing");
    EXPECT_EQ(nothing.at("lanes"), Json({1, 8}));
    for (const char* key : {"tried", "threshold", "passed"}) EXPECT_TRUE(nothing.contains(key));
    for (const char* key : {"what", "worst", "limit", "checked", "where"}) {
        EXPECT_TRUE(nothing.at("findings").at(0).contains(key)) << key;
    }
    EXPECT_EQ(names_in(folder), std::set<std::string>{"device.json"});
}

TEST_F(Certify, PrintsJsonInsteadOfTheTableAndTheSameOneEachTime) {
    const std::vector<std::string> words = {"certify", "--case", "30", "--lanes", "4", "-o", "-"};
    const ChildResult first = run_kilolux(words);
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(Json::parse(first.out).at("cases").at(0).at("name"), "alternating-frames");
    EXPECT_EQ(without_memory(run_kilolux(words).out), without_memory(first.out));
}

TEST_F(Certify, WritesEquality) {
    const ChildResult result = run_kilolux(
        {"certify", "--case", "none", "--with", "equality,tuning", "-o", "-", "--quiet"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("cases"), Json::array());
    std::set<std::string> tried;
    for (const Json& picture : json.at("equality").at("pictures")) {
        EXPECT_EQ(picture.at("different"), 0) << picture;
        EXPECT_GT(picture.at("lit"), 50000) << picture;
        tried.insert(picture.at("shading"));
        tried.insert(picture.at("shadows"));
    }
    EXPECT_EQ(tried, (std::set<std::string>{"lambert", "blinn-phong", "pbr", "off", "exact"}));
    EXPECT_GT(json.at("tuning").at("values").at("lanes"), 0);
    EXPECT_FALSE(json.contains("stages"));
}

TEST_F(Certify, WritesStagesOfAFrame) {
    const ChildResult result =
        run_kilolux({"certify", "--case", "none", "--with", "stages", "--quiet", "-o", "-"});
    ASSERT_EQ(result.code, 0) << result.err;
    std::set<std::string> stages;
    const Json json = Json::parse(result.out).at("stages");
    for (const Json& row : json.at("rows")) stages.insert(row.at("stage"));
    for (const char* name : {"raster_triangles", "cull_lights", "shade", "frame"})
        EXPECT_TRUE(stages.contains(name)) << name;
    EXPECT_FALSE(stages.contains("ids")) << "no OpenGL: it is no part of the device";
    EXPECT_GT(json.at("limits").at("fma_flops"), 0.0);
}

TEST_F(Certify, RunsAFrameUnderOclgrind) {
    set("KILOLUX_SHIPPED_TUNING", nullptr);  // oclgrind knows no prefetch
    // It loads its library before that of AddressSanitizer in an instrumented program.
    set("ASAN_OPTIONS", "verify_asan_link_order=0");
    const ChildResult result =
        run_kilolux({"certify", "--case", "none", "--with", "oclgrind", "-o", "-"});
    ASSERT_EQ(result.code, 0) << result.out;
    const Json json = Json::parse(result.out).at("oclgrind");
    if (!json.at("ran").get<bool>()) GTEST_SKIP() << json;
    EXPECT_EQ(json.at("report_lines"), 0);
}

TEST_F(Certify, ProcessesOfTheirOwnFindTheSame) {
    std::vector<std::string> words = {"certify", "--case", "27,M2", "--lanes", "1,8",
                                      "--with",  "tuning", "-o",    "-"};
    const ChildResult one = run_kilolux(words);
    words.push_back("--isolate");
    const ChildResult several = run_kilolux(words);
    ASSERT_EQ(several.code, 0) << several.err;
    EXPECT_EQ(without_memory(several.out), without_memory(one.out));
    words.insert(words.end(), {"--jobs", "2"});
    EXPECT_EQ(without_memory(run_kilolux(words).out), without_memory(one.out)) << "two at a time";
}

// A file that an interrupted run left: a case is done, another lacks a lane width, and a part ended
// with an error.
TEST_F(Certify, GoesOnWithAnInterruptedRun) {
    const TemporaryFolder folder;
    const std::string file = (folder / "result.json").string();
    const std::vector<std::string> words = {"certify", "--case", "27,M2",     "--lanes", "1,8",
                                            "--with",  "tuning", "--isolate", "-o",      file};
    ASSERT_EQ(run_kilolux(words).code, 0);
    const std::string whole = text_of_file(file);
    Json json = Json::parse(whole);
    const Json kept = json.at("cases").at(0).at("findings");
    json["cases"][0]["findings"][0]["worst"] = -1.0;  // to be seen: this case is not run again
    json["cases"][1]["lanes"] = {8};
    json["tuning"] = {{"passed", false}, {"error", "the process ended"}};
    json["unfinished"] = 2;
    write_text(file, json.dump());
    EXPECT_TRUE(contains(run_kilolux({"certify", "--table", file}).err, "unfinished: 2 processes"));
    std::vector<std::string> resumed = words;
    resumed.push_back("--resume");
    const ChildResult result = run_kilolux(resumed);
    ASSERT_EQ(result.code, 0) << result.err;
    const Json resumed_file = Json::parse(text_of_file(file));
    Json found = resumed_file;
    EXPECT_EQ(found["cases"][0]["findings"][0]["worst"], -1.0);
    found["cases"][0]["findings"] = kept;
    // The file had findings of both widths for one of them: those of the other come again.
    Json& again = found["cases"][1]["findings"][0]["checked"];
    const Json once = Json::parse(whole)["cases"][1]["findings"][0]["checked"];
    EXPECT_GT(again, once);
    again = once;
    EXPECT_EQ(found, Json::parse(whole));
    const ChildResult more =
        run_kilolux({"certify", "--case", "27", "--lanes", "2", "--resume", "--quiet", "-o", file});
    ASSERT_EQ(more.code, 0) << more.err;
    Json wider = Json::parse(text_of_file(file));
    EXPECT_EQ(wider["cases"][0]["lanes"], Json({1, 2, 8}));
    EXPECT_EQ(wider["cases"][1], resumed_file["cases"][1]) << "what was not asked for stays";
    EXPECT_EQ(wider["tuning"], found["tuning"]);
    wider["cases"][1]["error"] = "8 lanes: the process ended";
    write_text(file, wider.dump());
    const ChildResult rest =
        run_kilolux({"certify", "--case", "27", "--lanes", "2", "--resume", "--quiet", "-o", file});
    EXPECT_EQ(rest.code, 3) << "a failure that was not run again stays";
    EXPECT_TRUE(contains(rest.err, "M2 idle-lights")) << rest.err;
    json["device"]["name"] = "another";
    write_text(file, json.dump());
    const ChildResult other = run_kilolux(resumed);
    EXPECT_EQ(other.code, 2);
    EXPECT_TRUE(contains(other.err, "result.json was made by another device")) << other.err;
}

// A limit of the processor's time imitates a driver that ends the process: the case takes several
// times as long as it allows, the program itself less.
TEST_F(Certify, ACrashFailsItsCaseAndTheRestGoesOn) {
    const TemporaryFolder folder;
    const std::string file = (folder / "result.json").string();
    const ChildResult result =
        run_child({"/usr/bin/prlimit", "--cpu=2", program_file(), "certify", "--case", "32,M2",
                   "--lanes", "1", "--isolate", "-o", file});
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_TRUE(contains(result.err, "32 shadow-edges")) << result.err;
    const Json cases = Json::parse(text_of_file(file)).at("cases");
    ASSERT_EQ(cases.size(), 2u);
    EXPECT_TRUE(contains(cases.at(0).at("error"), "1 lanes: the process ended with signal"))
        << cases.at(0);
}

// The committed table equals the program's table of the committed certificates.
TEST_F(Certify, TheTableIsThatOfTheCertificates) {
    const TemporaryFolder folder;
    const fs::path devices = fs::path(source_root()) / "host/certify/devices";
    const ChildResult made =
        run_child({(devices / "make_table").string(), program_file(), folder.path().string()});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(text_of_file(devices / "README.md"), text_of_file(folder / "README.md"))
        << "run host/certify/devices/make_table";
}

// The admission test of a node.
TEST_F(Certify, QuickTriesOneWidthAndSaysWhatItLeavesOut) {
    const TemporaryFolder folder;
    const std::string file = (folder / "node.json").string();
    const ChildResult result = run_kilolux({"certify", "--quick", "--quiet", "-o", file});
    ASSERT_EQ(result.code, 0) << result.out << result.err;
    const Json json = Json::parse(text_of_file(file));
    EXPECT_TRUE(json.at("passed"));
    EXPECT_TRUE(json.at("equality").at("passed"));
    EXPECT_FALSE(json.contains("stages"));
    const int width = json.at("cases").at(0).at("lanes").at(0);
    std::string not_tried = "\nnot tried: ";
    for (const int other : {1, 2, 4, 8, 16}) {
        if (other != width) not_tried += fmt::format("{} lane{}, ", other, other == 1 ? "" : "s");
    }
    EXPECT_TRUE(result.out.ends_with(not_tried + "oclgrind, stages, tuning\n")) << result.out;
    EXPECT_EQ(json.at("cases").size(), hard_cases().size());
    for (const Json& row : json.at("cases")) EXPECT_EQ(row.at("lanes"), Json({width})) << row;
    // What the command line says counts.
    const ChildResult less = run_kilolux(
        {"certify", "--quick", "--case", "27", "--lanes", "2", "--with", "tuning", "-o", file});
    ASSERT_EQ(less.code, 0) << less.err;
    const Json asked = Json::parse(text_of_file(file));
    EXPECT_EQ(asked.at("cases").size(), 1u);
    EXPECT_EQ(asked.at("cases").at(0).at("lanes"), Json({2}));
    EXPECT_FALSE(asked.contains("equality"));
    EXPECT_TRUE(contains(less.out, "\nnot tried: 1 lane, 4 lanes, ")) << less.out;
}

// Kernels whose lights reach half as far must not pass.
TEST_F(Certify, AFailedCaseExitsWithThreeAndIsNamed) {
    const TemporaryFolder folder;
    fs::copy(fs::path(source_root()) / "kernels", folder / "kernels", fs::copy_options::recursive);
    fs::copy(fs::path(source_root()) / "raster", folder / "raster", fs::copy_options::recursive);
    const fs::path reach = folder / "kernels/lists/light_reach.h";
    std::string text = text_of_file(reach);
    const std::size_t at = text.find("<= CULL_LIMIT");
    ASSERT_NE(at, std::string::npos);
    write_text(reach, text.replace(at, 13, "<= 0.25f * CULL_LIMIT"));
    set("KILOLUX_SOURCE_DIR", folder.path().c_str());
    const std::string file = (folder / "result.json").string();
    const ChildResult result = run_kilolux(
        {"certify", "--quick", "--case", "3,30", "--lanes", "8", "--quiet", "-o", file});
    EXPECT_EQ(result.code, 3) << result.out << result.err;
    EXPECT_TRUE(
        result.err.ends_with("kilolux: certify: 1 of 2 hard cases failed: 3 beyond-the-grid; "
                             "equality failed\n"))
        << result.err;
    EXPECT_TRUE(contains(result.out, "missed lights: ")) << result.out;
    EXPECT_TRUE(contains(result.out, "FAILED at light ")) << result.out;
    const Json json = Json::parse(text_of_file(file));
    EXPECT_FALSE(json.at("passed"));
    EXPECT_EQ(json.at("failed"), Json({"3", "equality"}));
    EXPECT_GT(json.at("equality").at("pictures").at(0).at("different"), 0);
}

TEST_F(Certify, CommandLinesThatCannotBeObeyed) {
    const struct {
        std::vector<std::string> more;
        int code;
        const char* message;
    } cases[] = {
        {{"--case", "tiny-light"}, 2, "did you mean 'tiny-lights'?"},
        {{"--case", "M33"}, 2, "--case: 'M33' is none of 1, 2"},
        {{"--lanes", "3"}, 2, "--lanes: '3' is none of 1, 2, 4, 8, 16"},
        {{"--device", "no such device"}, 1, "no such device"},
        {{"-o", "/no/such/folder/a.json"}, 1, "there is no folder"},
        {{"--with", "stage"}, 2, "did you mean 'stages'?"},
        {{"--table", "a.json", "--isolate"}, 2, "--table: prints what was certified"},
        {{"--resume"}, 2, "--resume: goes on with the file of -o"},
        {{"--jobs", "0"}, 2, "--jobs: '0'"},
        {{"--table", "/no/such/a.json"}, 1, "/no/such/a.json: cannot read"},
        {{"--table", source_root() + "/README.md"}, 1, "README.md: no certificate: "},
    };
    for (const auto& c : cases) {
        std::vector<std::string> words = {"certify"};
        words.insert(words.end(), c.more.begin(), c.more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, c.code) << result.err;
        EXPECT_TRUE(contains(result.err, c.message)) << result.err;
        EXPECT_EQ(result.out, "");
    }
    EXPECT_EQ(run_kilolux({"report", "--hard-cases"}).code, 2);
}

TEST_F(Certify, AnInterruptedRunWritesNothing) {
    const TemporaryFolder folder;
    const std::string file = (folder / "result.json").string();
    const ChildResult result = run_kilolux({"certify", "-o", file}, [](pid_t child) {
        ::usleep(1500000);
        ::kill(child, SIGINT);
    });
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(result.err, "kilolux: interrupted\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(names_in(folder), std::set<std::string>{});
}

// Whether PoCL is writing a file of a build; LLVM gives it this name and removes it at a signal.
bool is_compiling(const TemporaryFolder& cache) {
    const auto names = names_in(cache);
    return std::ranges::any_of(names, [](const auto& n) { return n.ends_with(".cl.tmp"); });
}

// PoCL keeps programs in folders of two letters, by their hash.
std::ptrdiff_t built_programs(const TemporaryFolder& cache) {
    const auto names = names_in(cache);
    return std::ranges::count_if(names, [](const auto& n) { return n.size() == 2; });
}

TEST_F(Certify, ABuildThatIsInterruptedEndsWithItAndPrintsNothingElse) {
    using Clock = std::chrono::steady_clock;
    for (int i = 0; i < 6; ++i) {
        const TemporaryFolder cache;
        const EnvironmentVariable own("POCL_CACHE_DIR", cache.path().string());
        const ChildResult result =
            run_kilolux({i % 2 == 0 ? "certify" : "bench", "--quiet"}, [&](pid_t child) {
                const auto limit = Clock::now() + std::chrono::seconds(10);
                while (!is_compiling(cache) && Clock::now() < limit) {
                }
                ::kill(child, SIGINT);
            });
        EXPECT_EQ(result.code, 130) << result.err;
        EXPECT_EQ(result.err, "kilolux: interrupted\n");
        // The program under way, and at most the device's probe.
        EXPECT_LE(built_programs(cache), 2) << i;
    }
}

HardCaseRow row_of(std::string_view label, const Worst& worst, double limit) {
    HardCaseRow row{{label, "name", "what is tried", "what must hold", nullptr}, {8}, {}, {}};
    row.findings.at_most("missed lights", worst, limit);
    return row;
}

TEST(CertifyText, FailuresSayWhereAndWhich) {
    const std::vector<HardCaseRow> rows = {row_of("1", {3, 1000, "light 7, pixel 1, 2"}, 0),
                                           row_of("2", {0, 1000, ""}, 0)};
    const std::string text = to_markdown(hard_case_table(rows));
    EXPECT_TRUE(contains(text, "missed lights: 3 of 1000 FAILED at light 7, pixel 1, 2")) << text;
    EXPECT_TRUE(contains(text, "| NO ")) << text;
    EXPECT_THROW(require_all_passed({rows}), ComparisonFailed);
    require_all_passed({{rows.back()}});
}

TEST(CertifyText, ACaseThatThrowsFailsWithItsText) {
    HardCaseRow row = row_of("1", {0, 1, ""}, 0);
    row.error = "8 lanes: no OpenGL";
    EXPECT_FALSE(row.passed());
    EXPECT_EQ(certificate_json({}, {{row}})["cases"][0]["error"], "8 lanes: no OpenGL");
}

TEST(CertifyText, InfiniteNumbersAreNullInJson) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto json = certificate_json({}, {{row_of("1", {2.5, 1, ""}, kInfinity)}});
    EXPECT_EQ(json["cases"][0]["findings"][0]["limit"], nullptr);
    EXPECT_EQ(json["cases"][0]["findings"][0]["worst"], 2.5);
}

}  // namespace
}  // namespace kilolux
