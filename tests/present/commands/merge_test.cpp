// SPDX-License-Identifier: Apache-2.0
// Shards of `kilolux bench` and `kilolux report`, and `kilolux merge`. No time is judged.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/measure/bench/row.h"
#include "present/commands/bench/bench_context.h"
#include "tests/support/child.h"
#include "tests/support/environment_variable.h"
#include "tests/support/full.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Ordered = nlohmann::ordered_json;

constexpr auto kOver = fs::copy_options::recursive | fs::copy_options::overwrite_existing;

Ordered json_of(const fs::path& file) { return Ordered::parse(text_of_file(file)); }

class Merge : public testing::Test {
 protected:
    static void SetUpTestSuite() { suite_ = std::make_unique<Suite>(); }
    static void TearDownTestSuite() { suite_.reset(); }

    // Four points.
    static ChildResult bench(const fs::path& folder, std::vector<std::string> more = {}) {
        std::vector<std::string> words = {"bench",        "grid",
                                          "--resolution", "64,36",
                                          "--lights",     "9,20",
                                          "--renderer",   "deferred,deferred-all",
                                          "--warm-up",    "0",
                                          "--frames",     "1",
                                          "-o",           folder.string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_kilolux(words);
    }

    // A copy of what the cases share: measured by the first that asks for it.
    std::string copied(const std::string& name, std::vector<std::string> more = {},
                       const std::string& note = "") const {
        const fs::path made = suite_->results.path() / name;
        if (!fs::exists(made)) {
            const ChildResult result = bench(made, std::move(more));
            EXPECT_EQ(result.code, 0) << result.err;
            EXPECT_TRUE(contains(result.err, note)) << result.err;
        }
        fs::copy(made, results_ / name, kOver);
        return name;
    }

    // The folder of a shard, which learns its number as a task of GNU parallel does.
    std::string shard(int index, int count) const {
        const EnvironmentVariable task("PARALLEL_SEQ", fmt::to_string(index + 1));
        return copied(fmt::format("part.{}.{}", count, index),
                      {"--shard", fmt::format("auto/{}", count)},
                      fmt::format("shard {}/{} by PARALLEL_SEQ", index, count));
    }
    std::vector<std::string> shards(int count) const {
        std::vector<std::string> folders;
        for (int i = 0; i < count; ++i) folders.push_back(shard(i, count));
        return folders;
    }

    ChildResult merge(const std::string& folder, const std::vector<std::string>& results,
                      std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"merge", "-o", file(folder)});
        for (const std::string& result : results) more.push_back(file(result));
        return run_kilolux(more);
    }

    std::vector<BenchRow> rows(const std::string& folder) const {
        return bench_rows(parse_csv(text_of_file(results_ / folder / "bench.csv")));
    }

    std::string file(const std::string& name) const { return (results_ / name).string(); }

    void expect_refused(const std::vector<std::string>& results, const std::string& message,
                        const std::vector<std::string>& more = {}) const {
        const ChildResult result = merge("refused", results, more);
        EXPECT_EQ(result.code, 1) << message;
        EXPECT_TRUE(contains(result.err, message)) << message << " / " << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        EXPECT_FALSE(fs::exists(results_ / "refused/bench.csv")) << message;
    }

    // Copies a shard and changes a value of its document.
    std::string changed(const std::string& from, const char* path, const Ordered& value) const {
        std::string to = "changed";
        for (const char* c = path; *c != '\0'; ++c) to += *c == '/' ? '.' : *c;
        fs::copy(results_ / from, results_ / to, kOver);
        const fs::path document = results_ / to / "bench.context.json";
        Ordered json = json_of(document);
        json[Ordered::json_pointer(path)] = value;
        write_text(document, json.dump());
        return to;
    }

    const TemporaryFolder results_;

 private:
    struct Suite {
        TemporaryFolder results, cache;  // the cache has the device's limits
        EnvironmentVariable cache_home{"XDG_CACHE_HOME", cache.path().string()};
    };
    static inline std::unique_ptr<Suite> suite_;
};

// Of the device, which may change between runs.
Ordered without_memory(Ordered context) {
    context.at("device").erase("memory_bytes");
    return context;
}

// What does not depend on the time of day.
std::string key_of(const BenchRow& r) {
    return fmt::format("{}: {} n {} k {} {} bytes {} evaluations {} errors {} {} {}",
                       point_text(r.point), r.stage, r.ms.count, r.k, r.useful_k, r.bytes,
                       r.evaluations, r.error.max_relative, r.error.different_pixels,
                       r.error.pixels);
}

TEST_F(Merge, ShardsHaveTheRowsOfOneRun) {
    std::vector<std::string> expected;
    for (const BenchRow& row : rows(copied("one"))) expected.push_back(key_of(row));
    const Ordered one = json_of(results_ / "one/bench.json");
    std::vector<std::pair<int, std::vector<std::string>>> splits = {{3, shards(3)}};
    splits[0].second.push_back(shard(4, 5));  // has none of the four points
    if (runs_full()) {
        for (const int count : {1, 2, 5}) splits.emplace_back(count, shards(count));
    }
    for (auto& [count, parts] : splits) {
        const std::string whole = fmt::format("whole.{}", count);
        std::ranges::reverse(parts);  // the order of the command line does not matter
        const ChildResult result = merge(whole, parts);
        ASSERT_EQ(result.code, 0) << result.err;
        std::vector<std::string> found;
        for (const BenchRow& row : rows(whole)) found.push_back(key_of(row));
        EXPECT_EQ(found, expected) << count;
        const Ordered document = json_of(results_ / whole / "bench.json");
        EXPECT_EQ(without_memory(document.at("context")), without_memory(one.at("context")));
        EXPECT_EQ(document.at("points"), one.at("points"));
        EXPECT_EQ(document.at("parts").size(), parts.size());
        EXPECT_EQ(document.at("rows").size(), one.at("rows").size());
        EXPECT_GT(document.at("limits").at("fma_flops"), 0.0);
        EXPECT_TRUE(fs::exists(results_ / whole / "time_against_lights.png"));
        // It reads as any other.
        const std::string csv = text_of_file(results_ / whole / "bench.csv");
        const ChildResult table = run_kilolux({"bench", "--table", file(whole + "/bench.csv")});
        EXPECT_EQ(table.code, 0) << table.err;
        EXPECT_TRUE(contains(table.out, result.out)) << table.out << " / " << result.out;
        EXPECT_TRUE(contains(table.out, fmt::format("--shard auto/{}", count))) << table.out;
        const ChildResult resumed = bench(results_ / whole, {"--resume"});
        EXPECT_TRUE(contains(resumed.err, "4 of 4 points were measured before")) << resumed.err;
        EXPECT_EQ(text_of_file(results_ / whole / "bench.csv"), csv);
    }
}

TEST_F(Merge, EachShardMeasuresItsPointsAlone) {
    const std::vector<std::string> parts = shards(3);
    std::vector<std::string> points;
    for (const std::string& part : parts) {
        std::string names;
        for (const BenchRow& row : rows(part)) {
            if (row.stage == kFrameStage.name)
                names += fmt::format("{} {};", renderer_name(row.point.renderer), row.point.lights);
        }
        points.push_back(names);
    }
    EXPECT_EQ(points, (std::vector<std::string>{"deferred 9;deferred-all 20;", "deferred 20;",
                                                "deferred-all 9;"}));
    const ChildResult other = bench(results_ / parts[0], {"--shard", "1/3", "--resume"});
    EXPECT_EQ(other.code, 1);
    EXPECT_TRUE(contains(other.err, "shard was \"0/3\", is \"1/3\"")) << other.err;
}

TEST_F(Merge, RefusesOtherConditionsUnlessTheyAreKept) {
    const std::vector<std::string> parts = shards(3);
    for (const auto& [path, name] : {std::pair{"/context/program/commit", "program/commit"},
                                     std::pair{"/context/device/name", "device/name"},
                                     std::pair{"/context/device/driver", "device/driver"}}) {
        const std::string other = changed(parts[1], path, "another");
        expect_refused({parts[0], parts[2], other},
                       file(other + "/bench.csv") + ": measured under other conditions than " +
                           file(parts[0] + "/bench.csv") + ": " + name + " was \"");
        const ChildResult kept = merge("kept", {parts[0], parts[2], other}, {"--keep-differences"});
        ASSERT_EQ(kept.code, 0) << kept.err;
        EXPECT_TRUE(contains(kept.err, ": 3 of 4 points are missing")) << kept.err;
        const TextTable table = parse_csv(text_of_file(results_ / "kept/bench.csv"));
        EXPECT_EQ(std::vector(table.columns.end() - 3, table.columns.end()),
                  (std::vector<std::string>{"commit", "device", "driver"}));
        EXPECT_EQ(std::ranges::count_if(
                      table.rows,
                      [](const auto& row) { return std::ranges::count(row, "another") == 1; }),
                  std::ranges::ssize(rows(parts[1])));
    }
    const std::string settings = changed(parts[1], "/context/settings/light-seed", 7);
    expect_refused({parts[0], settings}, "settings/light-seed was 1, is 7");
    expect_refused({parts[0], settings}, "settings/light-seed was 1, is 7", {"--keep-differences"});
    const std::string memory = changed(parts[1], "/context/device/memory_bytes", 1);
    EXPECT_EQ(merge("memory", {parts[0], parts[2], memory}).code, 0);
    const std::string unfinished = changed(parts[1], "/limits", nullptr);
    expect_refused({parts[0], unfinished}, "has no limits: the run did not end");
    const std::string sweep = changed(parts[1], "/points/3", "lights 5");
    expect_refused({parts[0], sweep}, "points/3 was \"");
}

TEST_F(Merge, RefusesMissingAndDoubledPointsByName) {
    const std::vector<std::string> parts = shards(3);
    const std::string point =
        "renderer deferred-all, resolution 64x36, lights 9, grid 16x9x4, "
        "lanes auto, gbuffer packed";
    expect_refused({parts[0], parts[1]}, "1 of 4 points are in no result: '" + point + "'");
    const std::string copy = changed(parts[2], "/shard", "0/9");
    expect_refused({parts[0], parts[1], parts[2], copy},
                   file(parts[2] + "/bench.csv") + " and " + file(copy + "/bench.csv") +
                       ": both have the point '" + point + "'");
    // A copied file may end within a field, or within a point.
    const std::string csv = text_of_file(results_ / copy / "bench.csv");
    for (const std::size_t end : {csv.size() - 2, csv.rfind('\n', csv.size() - 2) + 1}) {
        write_text(results_ / copy / "bench.csv", csv.substr(0, end));
        expect_refused({parts[0], parts[1], copy},
                       "1 of 4 points are in no result: '" + point + "'");
    }
    expect_refused({parts[0], "nothing"}, file("nothing") + ": ");
    fs::create_directory(results_ / "empty");
    expect_refused({parts[0], "empty"}, file("empty") + ": has neither bench.csv nor report.csv");
    const ChildResult same = merge(parts[0], parts);
    EXPECT_EQ(same.code, 2) << same.err;
    EXPECT_EQ(run_kilolux({"merge", file(parts[0])}).code, 2) << "no -o";
}

TEST_F(Merge, ShardsGoWithSweeps) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--tune"}, {"--job", "png"}, {"--table", "a.csv"}}) {
        std::vector<std::string> all = {"bench", "grid", "--shard", "0/2"};
        all.insert(all.end(), words.begin(), words.end());
        const ChildResult result = run_kilolux(all);
        EXPECT_EQ(result.code, 2) << words.front();
        EXPECT_TRUE(contains(result.err, "--shard: goes with sweeps")) << result.err;
    }
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--check-default"}, {"--max-error", "0.1"}}) {
        std::vector<std::string> all = {"report", "grid", "--shard", "0/2"};
        all.insert(all.end(), words.begin(), words.end());
        const ChildResult result = run_kilolux(all);
        EXPECT_EQ(result.code, 2) << words.front();
        EXPECT_TRUE(contains(result.err, "needs all settings")) << result.err;
    }
}

// The suite's name makes its cases entries of their own.
class Report_Merge : public Merge {
 protected:
    ChildResult report(const std::string& folder, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"report", "grid", "--resolution", "64,36", "--lights", "40",
                                   "--quick", "--axes", "math,cut-off", "--warm-up", "0",
                                   "--frames", "1", "-o", file(folder)});
        return run_kilolux(more);
    }

    // Writes the part of a report that a shard of two would have measured.
    std::string part(const std::string& whole, int index) const {
        const std::string folder = fmt::format("{}.{}", whole, index);
        fs::copy(results_ / whole, results_ / folder, kOver);
        Ordered document = json_of(results_ / whole / "report.json");
        document["shard"] = fmt::format("{}/2", index);
        write_text(results_ / folder / "report.json", document.dump());
        const TextTable all = parse_csv(text_of_file(results_ / whole / "report.csv"));
        TextTable own{all.columns, {}};
        for (std::size_t row = 0; row < all.rows.size(); ++row) {
            if (row != 0 && static_cast<int>(row % 2) != index) continue;
            own.rows.push_back(all.rows[row]);
            own.rows.back()[3] = "";  // fronts are those of all rows
        }
        write_text(results_ / folder / "report.csv", to_csv(table_of(own)));
        return folder;
    }
};

TEST_F(Report_Merge, HasTheTablesOfOneRun) {
    ASSERT_EQ(report("one").code, 0);
    const std::string csv = text_of_file(results_ / "one/report.csv");
    ASSERT_TRUE(contains(csv, ",R2")) << "a front: " << csv;
    for (const std::vector<std::string>& parts :
         {std::vector<std::string>{"one"}, {part("one", 0), part("one", 1)}}) {
        const ChildResult merged = merge("whole", parts);
        ASSERT_EQ(merged.code, 0) << merged.err;
        for (const char* name : {"report.csv", "report.md", "cut_offs.csv"}) {
            EXPECT_EQ(text_of_file(results_ / "whole" / name),
                      text_of_file(results_ / "one" / name))
                << name;
        }
        EXPECT_EQ(merged.out, text_of_file(results_ / "one/report.md"));
        const Ordered one = json_of(results_ / "one/report.json");
        const Ordered whole = json_of(results_ / "whole/report.json");
        for (const char* key : {"context", "points", "rows"}) EXPECT_EQ(whole.at(key), one.at(key));
        for (const auto& map : fs::directory_iterator(results_ / "one/errors")) {
            EXPECT_TRUE(fs::exists(results_ / "whole/errors" / map.path().filename())) << map;
        }
        EXPECT_TRUE(fs::exists(results_ / "whole/time_against_error.png"));
    }
    fs::remove_all(results_ / "whole");
    const ChildResult missing = merge("whole", {part("one", 1)});
    EXPECT_EQ(missing.code, 1);
    EXPECT_TRUE(contains(missing.err, "are in no result: 'default'")) << missing.err;
}

// Of two shards the second measures every other setting, and the default, with which it compares.
TEST_F(Report_Merge, EachShardHasTheDefault) {
    const ChildResult result = report("part", {"--shard", "1/2"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Ordered document = json_of(results_ / "part/report.json");
    const Ordered& points = document.at("points");
    ASSERT_GT(points.size(), 3u);
    std::vector<Ordered> expected = {points[0]}, found;
    for (std::size_t i = 1; i < points.size(); i += 2) expected.push_back(points[i]);
    for (const Ordered& row : document.at("rows")) found.push_back(row.at("setting"));
    EXPECT_EQ(found, expected);
    EXPECT_EQ(document.at("shard"), "1/2");
    // The verdict is that of all rows: a setting of another shard may beat the default.
    const std::string whole = part("part", 0);
    const fs::path csv = results_ / whole / "report.csv";
    TextTable table = parse_csv(text_of_file(csv));
    TextTable all{table.columns, {}};
    for (const Ordered& point : points) {
        all.rows.push_back(table.rows.front());
        all.rows.back()[0] = point.get<std::string>();
        if (point == "math native") all.rows.back()[5] = "0.5";
    }
    write_text(csv, to_csv(table_of(all)));
    const ChildResult beaten = merge("verdict", {whole}, {"--check-default"});
    EXPECT_EQ(beaten.code, 3) << beaten.err;
    EXPECT_TRUE(contains(beaten.err, "another setting beats the default: math native takes 0.50"))
        << beaten.err;
    EXPECT_EQ(merge("verdict", {whole}).code, 0) << "a warning";
}

}  // namespace
}  // namespace kilolux
