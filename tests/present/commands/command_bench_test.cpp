// SPDX-License-Identifier: Apache-2.0
// `kilolux bench` as a whole, on pictures small enough for any machine. No time is judged.
#include <gtest/gtest.h>
#include <signal.h>
#include <time.h>
#include <nlohmann/json.hpp>
#include <set>

#include "host/measure/bench/row.h"
#include "present/commands/bench/bench.h"
#include "present/commands/bench/bench_options.h"
#include "tests/support/child.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::vector<std::string> small_bench(std::vector<std::string> more) {
    std::vector<std::string> words = {"bench",     "grid", "--resolution", "64,36",
                                      "--warm-up", "1",    "--frames",     "2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

// The scene's file is missing, which only loading it would find.
TEST(Bench, RefusesEachImpossiblePointBeforeAnythingIsLoaded) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"--renderer", "deferred,forward", "--shadows", "exact"}, "shadows: the forward"},
        {{"--renderer", "deferred,deferred-all", "--tails", "tree"}, "tails tree: only"},
        {{"--renderer", "forward", "--show", "false-positives"}, "--show false-positives"},
        {{"--renderer", "forward", "--shadows", "exact", "--tune"}, "shadows: the forward"},
        {{"--renderer", "forward", "--shadows", "exact", "--job", "png"}, "shadows: the forward"}};
    for (const auto& [words, message] : cases) {
        std::vector<std::string> all = {"bench", "no_such_scene.gltf", "--lights", "9"};
        all.insert(all.end(), words.begin(), words.end());
        const ChildResult result = run_kilolux(all);
        EXPECT_EQ(result.code, 2) << message;
        EXPECT_TRUE(contains(result.err, message)) << result.err;
    }
}

TEST(Bench, QuickMeasuresLightsAndGrids) {
    const TemporaryFolder folder;
    const ChildResult result = run_kilolux(
        small_bench({"--quick", "--lights", "20:40:20", "-o", (folder / "out").string()}));
    ASSERT_EQ(result.code, 0) << result.err;
    const auto rows = bench_rows(parse_csv(text_of_file(folder / "out/bench.csv")));
    ASSERT_FALSE(rows.empty());
    std::set<std::string> stages;
    for (const BenchRow& row : rows) {
        stages.insert(row.stage);
        EXPECT_EQ(row.ms.count, 2u) << row.stage;
        EXPECT_LE(row.ms.min, row.ms.median) << row.stage;
        EXPECT_LE(row.ms.median, row.ms.max) << row.stage;
        EXPECT_EQ(row.error.different_pixels, 0u) << "no bit may depend on how lights are found";
        EXPECT_EQ(row.error.max_relative, 0.0);
        EXPECT_EQ(row.error.pixels, 64u * 36u);
        EXPECT_LE(row.useful_k, row.k) << row.stage;
        const bool all = row.point.renderer == RendererKind::deferred_all;
        if (all) {
            EXPECT_EQ(row.k, static_cast<double>(row.point.lights));
        }
    }
    for (const char* stage :
         {"resolve_surfaces", "cull_lights", "shade", "tonemap", "other", "frame"}) {
        EXPECT_TRUE(stages.count(stage)) << stage;
    }
    const Json document = Json::parse(text_of_file(folder / "out/bench.json"));
    EXPECT_EQ(document.at("rows").size(), rows.size());
    EXPECT_EQ(document.at("context").at("scene").at("name"), "grid");
    EXPECT_EQ(document.at("context").at("shading"), "pbr");
    EXPECT_EQ(document.at("context").at("frames").at("measured"), rows.front().ms.count);
    EXPECT_EQ(document.at("context").at("settings").at("light-seed"), 1);
    EXPECT_FALSE(document.at("context").at("device").at("driver").get<std::string>().empty());
    EXPECT_FALSE(document.at("context").at("program").at("commit").get<std::string>().empty());
    EXPECT_GT(document.at("context").at("tuning").at("lanes"), 0);
    EXPECT_TRUE(contains(document.at("command"), "kilolux bench grid")) << document.at("command");
    EXPECT_GT(document.at("limits").at("lane_instructions_per_s"), 0.0);
    for (const char* plot :
         {"time_against_lights", "speed_up_against_lights", "time_against_grid"}) {
        EXPECT_TRUE(fs::exists(folder / "out" / (std::string(plot) + ".png"))) << plot;
        EXPECT_TRUE(fs::exists(folder / "out" / (std::string(plot) + ".svg"))) << plot;
    }
    EXPECT_TRUE(contains(result.err, "more points, by a measured frame")) << result.err;
    EXPECT_TRUE(contains(result.err, ": 20 generated and ")) << result.err;
    EXPECT_TRUE(contains(result.err, "sweep   generated lights: 20, 40\n")) << result.err;
    EXPECT_TRUE(contains(result.err, "is 4x3x")) << "the grid is explained: " << result.err;
    for (const char* column : {"median [ms]", "limit [ms]", "ratio", "Geval/s", "GB/s", "k*/k",
                               "max rel. error", "bits differ"}) {
        EXPECT_TRUE(contains(result.out, column)) << column;
    }
}

TEST(Bench, SaysBeforeItMeasuresThatThereIsNoGnuplot) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "bin");
    fs::create_symlink("/usr/bin/ld", folder / "bin/ld");  // the program looks for it
    const EnvironmentVariable path("PATH", (folder / "bin").string());
    const ChildResult result =
        run_kilolux(small_bench({"--lights", "10,20", "-o", (folder / "out").string()}));
    EXPECT_EQ(result.code, 0) << result.err;
    const std::size_t said =
        result.err.find("no plots: gnuplot not found; install the package gnuplot-nox\n");
    EXPECT_LT(said, result.err.find("more points, by a measured frame")) << result.err;
    EXPECT_TRUE(fs::exists(folder / "out/bench.csv"));
    EXPECT_FALSE(fs::exists(folder / "out/time_against_lights.png"));
}

TEST(Bench, CountsTheRaysOfShadowsAndLimitsTheirStages) {
    const ChildResult result =
        run_kilolux(small_bench({"--lights", "20", "--shadows", "exact", "--json"}));
    ASSERT_EQ(result.code, 0) << result.err;
    std::set<std::string> limited;
    const Json document = Json::parse(result.out);
    for (const Json& row : document.at("rows")) {
        const std::string stage = row.at("stage");
        if (row.at("limit_ms") > 0.0) limited.insert(stage);
        EXPECT_EQ(row.at("shafts") > 0.0, stage == "cast_shadows") << stage;
        if (stage != "cast_shadows") continue;
        EXPECT_GT(row.at("evaluations"), row.at("shafts")) << "a walk serves many rays";
        EXPECT_GT(row.at("saved_rays"), 0.0);
    }
    for (const char* stage : {"shadow_origins", "cast_shadows", "shade"}) {
        EXPECT_TRUE(limited.count(stage)) << stage;
    }
}

TEST(Bench, StageTimesSumToTheFrame) {
    const ChildResult result =
        run_kilolux(small_bench({"--lights", "10", "--frames", "1", "--json"}));
    ASSERT_EQ(result.code, 0) << result.err;
    double sum = 0.0, frame = 0.0;
    const Json document = Json::parse(result.out);
    for (const Json& row : document.at("rows")) {
        (row.at("stage") == "frame" ? frame : sum) += row.at("median_ms").get<double>();
    }
    EXPECT_GT(frame, 0.0);
    EXPECT_NEAR(sum, frame, 1e-6 * frame);
}

// Files go to a temporary folder, which is removed.
TEST(Bench, MeasuresJobs) {
    const TemporaryFolder folder, temporary;
    const EnvironmentVariable variable("TMPDIR", temporary.path().string());
    const ChildResult result = run_kilolux(
        small_bench({"--lights", "10,20", "--job", "png,exr,y4m", "-o", folder.path().string()}));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(names_in(temporary).empty());
    const Json document = Json::parse(text_of_file(folder / "job.json"));
    ASSERT_EQ(document.at("rows").size(), 6u);
    for (const Json& row : document.at("rows")) {
        EXPECT_EQ(row.at("pictures"), 2);
        EXPECT_EQ(row.at("resolution"), "64x36");
        for (const char* rate : {"frames/s alone", "pictures/s", "pictures/s with start"})
            EXPECT_GT(row.at(rate).get<double>(), 0.0) << rate;
        EXPECT_LT(row.at("pictures/s with start"), row.at("pictures/s"));
    }
    const Json& y4m = document.at("rows")[2];
    EXPECT_EQ(y4m.at("job"), "y4m");
    EXPECT_NEAR(y4m.at("MiB/picture").get<double>() * 1048576.0, 3 * 64 * 36 + 6, 100)
        << "Y'CbCr 4:4:4 and headers";
    EXPECT_EQ(document.at("context").at("frames").at("motion"), "lights");
    const ChildResult table = run_kilolux({"bench", "--table", (folder / "job.csv").string()});
    for (const char* part : {"| y4m |", "| pictures/s with start |", "; 2 frames after 1."})
        EXPECT_TRUE(contains(table.out, part)) << part << " / " << table.out;
    for (const char* other : {"--quick", "--tune", "--resume"}) {
        EXPECT_EQ(run_kilolux(small_bench({"--job", "png", other})).code, 2) << other;
    }
    EXPECT_EQ(run_kilolux(small_bench({"--job", "bmp"})).code, 2);
}

TEST(Bench, ResumesPointsOfTheSameContext) {
    const TemporaryFolder folder;
    const auto bench = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"-o", folder.path().string(), "--resume"});
        return run_kilolux(small_bench(more));
    };
    const auto rows = [&] { return bench_rows(parse_csv(text_of_file(folder / "bench.csv"))); };
    ASSERT_EQ(bench({"--lights", "10"}).code, 0);
    const std::string first = text_of_file(folder / "bench.csv");
    const std::size_t first_rows = rows().size();
    const ChildResult more = bench({"--lights", "10,20"});
    ASSERT_EQ(more.code, 0) << more.err;
    EXPECT_TRUE(contains(more.err, "1 of 2 points were measured before")) << more.err;
    EXPECT_TRUE(text_of_file(folder / "bench.csv").starts_with(first));
    EXPECT_EQ(rows().size(), 2 * first_rows);
}

TEST(Bench, RefusesToResumeAnotherContext) {
    const TemporaryFolder folder;
    const auto bench = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--lights", "10", "-o", folder.path().string()});
        return run_kilolux(small_bench(more));
    };
    ASSERT_EQ(bench({}).code, 0);
    const std::string csv = text_of_file(folder / "bench.csv");
    const fs::path file = folder / "bench.context.json";
    const std::string context = text_of_file(file);
    const auto expect_refused = [&](std::vector<std::string> more, const char* message) {
        more.push_back("--resume");
        const ChildResult result = bench(more);
        EXPECT_EQ(result.code, 1) << message;
        EXPECT_TRUE(contains(result.err, message)) << message << " / " << result.err;
        EXPECT_EQ(text_of_file(folder / "bench.csv"), csv) << "nothing is lost";
    };
    expect_refused({"--light-seed", "2"}, "settings/light-seed was 1, is 2");
    const struct {
        const char* path;
        const char* message;
    } changes[] = {{"/context/program/commit", "program/commit was \"another\""},
                   {"/context/device/name", "device/name was \"another\""},
                   {"/context/tuning/lanes", "tuning/lanes was \"another\""}};
    for (const auto& change : changes) {
        Json document = Json::parse(context);
        document[Json::json_pointer(change.path)] = "another";
        write_text(file, document.dump());
        expect_refused({}, change.message);
    }
    // A run that ends before its first point leaves rows and conditions as they are.
    write_text(file, context);
    EXPECT_EQ(bench({"--light-seed", "2", "--max-memory", "1"}).code, 1);
    expect_refused({"--light-seed", "2"}, "settings/light-seed was 1, is 2");
    expect_refused({"--motion", "none"}, "frames/motion was \"camera\", is \"none\"");
    fs::remove(file);
    expect_refused({}, "missing or damaged; --resume needs it");
}

TEST(Bench, PrintsTheTableOfItsCsv) {
    const TemporaryFolder folder;
    const ChildResult measured =
        run_kilolux(small_bench({"--lights", "10,20", "-o", folder.path().string()}));
    ASSERT_EQ(measured.code, 0) << measured.err;
    const std::string csv = (folder / "bench.csv").string();
    const ChildResult printed = run_kilolux({"bench", "--table", csv});
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_TRUE(contains(printed.out, measured.out)) << "the same table and legend";
    EXPECT_TRUE(contains(printed.out, "    kilolux bench grid --resolution 64,36 ")) << printed.out;
    for (const char* part : {"Device ", "commit ", "scene grid", "resolution 64x36", "Tuning: "})
        EXPECT_TRUE(contains(printed.out, part)) << part << " / " << printed.out;
    const ChildResult both = run_kilolux({"bench", "--table", csv + "," + csv, "--quiet"});
    ASSERT_EQ(both.code, 0) << both.err;
    EXPECT_EQ(both.out, printed.out + "\n" + printed.out);
    EXPECT_FALSE(contains(both.out, "Written by")) << "tables of users are not the project's";
    fs::remove(folder / "bench.context.json");
    EXPECT_EQ(run_kilolux({"bench", "--table", csv}).code, 1) << "no figure without its command";
    EXPECT_EQ(run_kilolux({"bench", "--table", "no.csv"}).code, 1);
    EXPECT_EQ(run_kilolux({"bench", "--table", csv, "--quick"}).code, 2);
}

// The committed tables equal the program's tables of the committed measurements.
TEST(BenchResults, TablesAreThoseOfTheirCsv) {
    const TemporaryFolder folder;
    const fs::path results = fs::path(source_root()) / "host/measure/results";
    const ChildResult made =
        run_child({(results / "make_tables").string(), program_file(), folder.path().string()});
    ASSERT_EQ(made.code, 0) << made.err;
    std::size_t tables = 0;
    for (const auto& entry : fs::directory_iterator(results)) {
        if (entry.path().extension() != ".md" || entry.path().filename() == "README.md") continue;
        EXPECT_EQ(text_of_file(entry.path()),
                  text_of_file(folder / entry.path().filename().string()))
            << entry.path() << ": run host/measure/results/make_tables";
        EXPECT_TRUE(contains(text_of_file(entry.path()), ", shading "))
            << entry.path() << " says how surfaces reflect light";
        ++tables;
    }
    EXPECT_EQ(tables, names_in(folder).size());
    EXPECT_GT(tables, 0u);
}

TEST(Bench, ASignalLeavesWholePoints) {
    const TemporaryFolder folder;
    const fs::path csv = folder / "bench.csv";
    const ChildResult result = run_kilolux(
        small_bench({"--lights", "1:1000:1", "-o", folder.path().string()}), [&](pid_t child) {
            const timespec pause{0, 5'000'000};
            for (int i = 0; i < 24'000 && !fs::exists(csv); ++i) nanosleep(&pause, nullptr);
            kill(child, SIGINT);
        });
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_TRUE(result.err.ends_with("kilolux: interrupted\n")) << result.err;
    for (const char* noise : {"pocl", "clang", "LLVM", "No such file", "rror"})
        EXPECT_FALSE(contains(result.err, noise)) << noise << " / " << result.err;
    const auto rows = bench_rows(parse_csv(text_of_file(csv)));
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(rows.back().stage, kFrameStage.name);
}

TEST(Bench, RefusesWhatCannotBeObeyed) {
    const TemporaryFolder folder;
    write_text(folder / "file", "");
    const struct {
        std::vector<std::string> words;
        int code;
        const char* message;
    } cases[] = {
        {{"--lights", "5:1:1"}, 2, "--lights: '5:1:1' is no list"},
        {{"--grid", "3,3,3;3,3,65"}, 2, "--grid: slices per octave: '65' is not a whole number"},
        {{"--grid", "3,3"}, 2, "--grid: '3,3' is not X,Y,SLICES_PER_OCTAVE"},
        {{"--resolution", "64,36;"}, 2, "--resolution: '' is not W,H"},
        {{"--renderer", "deferred,backward"}, 2, "--renderer: 'backward' is none of"},
        {{"--lanes", "3"}, 2, "--lanes: '3' is none of"},
        {{"--frames", "0"}, 2, "--frames: '0' is not"},
        {{"--resume"}, 2, "--resume: needs the folder of -o"},
        {{"--quick", "--tune"}, 2, "exclude each other"},
        {{"-o", (folder / "file").string()}, 1, "cannot make this folder"},
    };
    for (const auto& c : cases) {
        const ChildResult result = run_kilolux(small_bench(c.words));
        EXPECT_EQ(result.code, c.code) << c.message << " / " << result.err;
        EXPECT_TRUE(contains(result.err, c.message)) << c.message << " / " << result.err;
        EXPECT_EQ(result.out, "");
    }
}

TEST(BenchOptions, ParsesListsOfTuples) {
    using Sizes = std::vector<std::array<int, 2>>;
    using Grids = std::vector<std::array<int, 3>>;
    EXPECT_EQ(parse_resolutions("--r", "1280,720;1920x1080;1280x720"),
              (Sizes{{1280, 720}, {1920, 1080}}));
    EXPECT_EQ(parse_grids("--g", "3x3x1;64,36,64"), (Grids{{3, 3, 1}, {64, 36, 64}}));
}

TEST(BenchContext, NamesTheFirstDifference) {
    const nlohmann::ordered_json was = {{"a", {{"b", 1}, {"c", "x"}}}};
    EXPECT_EQ(first_difference(was, was), "");
    nlohmann::ordered_json is = was;
    is["a"]["c"] = "y";
    EXPECT_EQ(first_difference(was, is), "a/c was \"x\", is \"y\"");
    is = was;
    is["d"] = 2;
    EXPECT_EQ(first_difference(was, is), "d was missing, is 2");
}

// Runs the script that every build runs.
std::string commit_cpp(const fs::path& root, const fs::path& output) {
    const ChildResult result = run_child({"/usr/bin/env", "cmake", "-DROOT=" + root.string(),
                                          "-DOUTPUT=" + output.string(), "-P",
                                          source_root() + "/present/cli/commit.cmake"});
    EXPECT_EQ(result.code, 0) << result.err;
    return text_of_file(output);
}

TEST(BuildCommit, IsReadAtEveryBuildAndWrittenOnChange) {
    const TemporaryFolder folder;
    const fs::path output = folder / "commit.cpp";
    EXPECT_TRUE(contains(commit_cpp(folder.path(), output), "\"unknown\""));
    const auto git = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"/usr/bin/env", "git", "-C", folder.path().string(), "-c",
                                     "user.name=t", "-c", "user.email=t@t"});
        ASSERT_EQ(run_child(words).code, 0);
    };
    git({"init", "-q"});
    git({"commit", "-q", "--allow-empty", "-m", "first"});
    const std::string first = commit_cpp(folder.path(), output);
    EXPECT_FALSE(contains(first, "unknown")) << first;
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(output, old);
    EXPECT_EQ(commit_cpp(folder.path(), output), first);
    EXPECT_EQ(fs::last_write_time(output), old) << "unchanged: nothing is compiled again";
    git({"commit", "-q", "--allow-empty", "-m", "second"});
    EXPECT_NE(commit_cpp(folder.path(), output), first);
}

}  // namespace
}  // namespace kilolux
