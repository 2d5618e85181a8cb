// SPDX-License-Identifier: Apache-2.0
// `kilolux bench` as a whole, on pictures small enough for any machine. No time is judged.
#include <gtest/gtest.h>

#include <signal.h>
#include <time.h>

#include <nlohmann/json.hpp>
#include <set>

#include "host/measure/bench/row.h"
#include "present/cli/names.h"
#include "present/commands/bench.h"
#include "tests/support/child.h"
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

TEST(Bench, QuickMeasuresLightsGridsAndGroups) {
    const TemporaryFolder folder;
    const ChildResult result =
        run_kilolux(small_bench({"--quick", "--lights", "20,40", "-o", (folder / "out").string()}));
    ASSERT_EQ(result.code, 0) << result.err;
    const auto rows = parse_bench_csv(text_of_file(folder / "out/bench.csv"));
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
    for (const char* stage : {"geometry", "cull_lights", "shade", "tonemap", "frame"}) {
        EXPECT_TRUE(stages.count(stage)) << stage;
    }
    const Json document = Json::parse(text_of_file(folder / "out/bench.json"));
    EXPECT_EQ(document.at("rows").size(), rows.size());
    EXPECT_EQ(document.at("context").at("scene").at("name"), "grid");
    EXPECT_EQ(document.at("context").at("settings").at("light_seed"), 1);
    EXPECT_FALSE(document.at("context").at("device").at("driver").get<std::string>().empty());
    EXPECT_FALSE(document.at("context").at("program").at("commit").get<std::string>().empty());
    EXPECT_GT(document.at("limits").at("lane_instructions_per_s"), 0.0);
    for (const char* plot : {"time_against_lights", "speed_up_against_lights", "time_against_grid",
                             "time_against_work_group"}) {
        EXPECT_TRUE(fs::exists(folder / "out" / (std::string(plot) + ".png"))) << plot;
        EXPECT_TRUE(fs::exists(folder / "out" / (std::string(plot) + ".svg"))) << plot;
    }
    for (const char* column : {"median [ms]", "limit [ms]", "ratio", "Geval/s", "GB/s", "k*/k",
                               "max rel. error", "bits differ"}) {
        EXPECT_TRUE(contains(result.out, column)) << column;
    }
}

TEST(Bench, ResumesPointsOfTheSameContextOnly) {
    const TemporaryFolder folder;
    const auto bench = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"-o", folder.path().string(), "--resume"});
        return run_kilolux(small_bench(more));
    };
    ASSERT_EQ(bench({"--lights", "10"}).code, 0);
    const std::string first = text_of_file(folder / "bench.csv");
    const ChildResult more = bench({"--lights", "10,20"});
    ASSERT_EQ(more.code, 0) << more.err;
    EXPECT_TRUE(contains(more.err, "1 of 2 points were measured before")) << more.err;
    const std::string second = text_of_file(folder / "bench.csv");
    EXPECT_TRUE(second.starts_with(first));
    EXPECT_EQ(parse_bench_csv(second).size(), 2 * parse_bench_csv(first).size());
    // Another seed is another context: measured again, and only that is told.
    const ChildResult other = bench({"--lights", "10", "--light-seed", "2", "--json"});
    ASSERT_EQ(other.code, 0) << other.err;
    EXPECT_FALSE(contains(other.err, "measured before")) << other.err;
    EXPECT_EQ(Json::parse(other.out).at("rows").size(), parse_bench_csv(first).size());
    EXPECT_EQ(parse_bench_csv(text_of_file(folder / "bench.csv")).size(),
              3 * parse_bench_csv(first).size());
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
    const auto rows = parse_bench_csv(text_of_file(csv));
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(rows.back().stage, kFrameStage);
}

TEST(Bench, CullingComparesWithBruteForce) {
    const TemporaryFolder folder;
    const ChildResult result = run_kilolux(
        small_bench({"--culling", "--lights", "0,1,100,70000", "-o", folder.path().string()}));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "the lists equal brute force's, entry by entry"))
        << result.err;
    const Json rows = Json::parse(text_of_file(folder / "culling.json")).at("rows");
    ASSERT_EQ(rows.size(), 4u);
    for (const Json& row : rows) {
        EXPECT_EQ(row.at("not in brute force"), 0) << row;
        EXPECT_EQ(row.at("pairs"), row.at("brute force pairs")) << row;
        EXPECT_GT(row.at("clusters"), 0) << row;
    }
    EXPECT_EQ(rows[0].at("pairs"), 0);
    EXPECT_EQ(rows[3].at("lights"), 70000);
    EXPECT_GT(rows[3].at("pairs"), 70000);
}

TEST(Bench, ShadeMeasuresModelsAndLanes) {
    const ChildResult result = run_kilolux(small_bench({"--shade", "--json", "--quiet"}));
    ASSERT_EQ(result.code, 0) << result.err;
    std::set<std::string> models;
    std::set<int> lanes;
    const Json document = Json::parse(result.out);
    for (const Json& row : document.at("rows")) {
        models.insert(row.at("model"));
        lanes.insert(row.at("lanes").get<int>());
        EXPECT_GT(row.at("limit [ms]"), 0.0) << row;
        EXPECT_GT(row.at("Geval/s"), 0.0) << row;
        if (row.at("lanes") == 1) {
            EXPECT_EQ(row.at("times one lane"), 1.0) << row;
        }
    }
    EXPECT_EQ(models, (std::set<std::string>{"lambert", "blinn-phong", "pbr"}));
    for (const int width : {1, 4, 8, 16}) EXPECT_TRUE(lanes.count(width)) << width;
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

TEST(BenchOptions, NamesRenderersAsTheSharedOptionsDo) {
    for (std::size_t i = 0; i < renderer_names().size(); ++i) {
        EXPECT_EQ(renderer_name(static_cast<RendererKind>(i)), renderer_names()[i]);
    }
}

}  // namespace
}  // namespace kilolux
