// SPDX-License-Identifier: Apache-2.0
// Rows of measurements: through CSV and back, in logs that are continued, and as plots.
#include "host/measure/bench/row.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "host/base/error.h"
#include "host/base/system/temporary_folder.h"
#include "host/measure/bench/plots.h"
#include "host/measure/bench/run.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

BenchRow row_of(std::uint64_t lights, const std::string& stage, double ms) {
    BenchRow row;
    row.point.lights = lights;
    row.stage = stage;
    const std::vector<double> times = {ms, 1.5 * ms, 3.0 * ms};
    row.ms = statistics(times);
    row.limit_ms = ms / 3.0;
    row.bound = "special functions";
    row.evaluations = 1e9 / 3.0;
    row.bytes = 12.5e6;
    row.k = 10.0 / 3.0;
    row.useful_k = 2.5;
    row.error = {1.0 / 7.0, 3, 2304};
    row.shafts = 12345.0;
    row.saved_rays = 1e7 / 3.0;
    return row;
}

void expect_same(const BenchRow& a, const BenchRow& b) {
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.stage, b.stage);
    EXPECT_EQ(a.ms.count, b.ms.count);
    // Numbers are written so that they are read back as the same double.
    EXPECT_EQ(a.ms.median, b.ms.median);
    EXPECT_EQ(a.ms.p5, b.ms.p5);
    EXPECT_EQ(a.ms.p95, b.ms.p95);
    EXPECT_EQ(a.ms.min, b.ms.min);
    EXPECT_EQ(a.ms.max, b.ms.max);
    EXPECT_EQ(a.ms.mean, b.ms.mean);
    EXPECT_EQ(a.limit_ms, b.limit_ms);
    EXPECT_EQ(a.bound, b.bound);
    EXPECT_EQ(a.evaluations, b.evaluations);
    EXPECT_EQ(a.bytes, b.bytes);
    EXPECT_EQ(a.k, b.k);
    EXPECT_EQ(a.useful_k, b.useful_k);
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.shafts, b.shafts);
    EXPECT_EQ(a.saved_rays, b.saved_rays);
}

// A CSV in a temporary folder.
class BenchLogFile : public testing::Test {
 protected:
    std::string text() const {
        std::ifstream in(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }

    const TemporaryFolder folder_;
    const fs::path file_ = folder_ / "bench.csv";
};

TEST(BenchRow, ComesBackFromCsv) {
    BenchRow odd = row_of(0, "frame", 1e-300);
    odd.bound.clear();
    odd.point = {RendererKind::forward_plus,
                 {1, 65536},
                 std::uint64_t{1} << 31,
                 {64, 36, 64},
                 16,
                 GBUFFER_OCT_2X4};
    odd.error.max_relative = std::numeric_limits<double>::infinity();
    const std::vector<BenchRow> rows = {row_of(500, "shade", 0.1), odd};
    const auto back = bench_rows(parse_csv(to_csv(bench_table(rows))));
    ASSERT_EQ(back.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) expect_same(back[i], rows[i]);
    EXPECT_TRUE(bench_rows(parse_csv(to_csv(bench_table({})))).empty());
}

TEST(BenchRow, RatesAndRatios) {
    const BenchRow row = row_of(500, "shade", 2.0);
    EXPECT_EQ(row.ms.count, 3u);
    EXPECT_DOUBLE_EQ(row.ms.median, 3.0);
    EXPECT_DOUBLE_EQ(row.ms.min, 2.0);
    EXPECT_DOUBLE_EQ(row.ms.max, 6.0);
    EXPECT_DOUBLE_EQ(row.ms.p5, 2.1);   // a tenth of the way from 2 to 3
    EXPECT_DOUBLE_EQ(row.ms.p95, 5.7);  // nine tenths of the way from 3 to 6
    EXPECT_DOUBLE_EQ(row.ratio(), 2.0 / 9.0);
    EXPECT_DOUBLE_EQ(row.giga_evaluations_per_s(), 1000.0 / 9.0);  // 1e9 / 3 in 3 ms
    EXPECT_DOUBLE_EQ(row.gigabytes_per_s(), 12.5e6 / 3e-3 * 1e-9);
    EXPECT_DOUBLE_EQ(row.useful_share(), 0.75);
    EXPECT_EQ(BenchRow{}.ratio(), 0.0);
    EXPECT_EQ(BenchRow{}.giga_evaluations_per_s(), 0.0);
}

TEST(BenchRow, RefusesOtherCsvWithTheLine) {
    const std::string csv = to_csv(bench_table({row_of(1, "frame", 1.0)}));
    const std::string header = csv.substr(0, csv.find('\n') + 1);
    const std::string line = csv.substr(header.size());
    const struct {
        std::string text;
        const char* message;
    } cases[] = {
        {"a,b\n1,2\n", "line 1: is not this version's header"},
        {header + "1,2\n", "line 2: has 2 fields, must have 32"},
        {csv + "x" + line.substr(0, line.size() / 2) + "\n", "line 3: has "},
        {header + "backward" + line.substr(line.find(",1920")), "'backward' is no renderer"},
        {header + "deferred,12a" + line.substr(line.find(",1080")),
         "line 2: width is '12a', must be a number"},
    };
    for (const auto& c : cases) {
        try {
            bench_rows(parse_csv(c.text));
            ADD_FAILURE() << c.text;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(c.message), std::string::npos) << error.what();
        }
    }
}

TEST_F(BenchLogFile, GoesOnAfterTheLastWholePoint) {
    const std::vector<BenchRow> first = {row_of(1, "shade", 1), row_of(1, "frame", 2)};
    const std::vector<BenchRow> second = {row_of(2, "shade", 3), row_of(2, "frame", 4)};
    {
        BenchLog log(file_, false);
        log.append(first);
        log.append(second);
    }
    const std::string whole = text();
    EXPECT_EQ(whole, to_csv(bench_table({first[0], first[1], second[0], second[1]})));
    // Cut at any byte: a point is read whole or not at all, and the continued file is the same.
    const std::size_t header = whole.find('\n') + 1;
    const std::size_t after_first = to_csv(bench_table(first)).size();
    for (std::size_t length = 0; length <= whole.size();
         length += length + 97 < whole.size() ? 97 : 1) {
        write(whole.substr(0, length));
        BenchLog log(file_, true);
        const std::size_t points = length == whole.size() ? 2 : length >= after_first ? 1 : 0;
        ASSERT_EQ(log.rows().size(), 2 * points) << "cut at " << length;
        EXPECT_EQ(log.rows_of(first[0].point).size(), points > 0 ? 2u : 0u);
        if (points < 1) log.append(first);
        if (points < 2) log.append(second);
        ASSERT_EQ(text(), whole) << "cut at " << length << ", header ends at " << header;
    }
}

TEST_F(BenchLogFile, ReplacesWithoutResumeAndRefusesForeignFiles) {
    write("not a log\n");
    EXPECT_THROW(BenchLog(file_, true), Error);
    BenchLog log(file_, false);
    EXPECT_EQ(text(), "not a log\n") << "nothing is lost before there is something new";
    log.append({row_of(1, "frame", 1)});
    EXPECT_EQ(text(), to_csv(bench_table({row_of(1, "frame", 1)})));
    EXPECT_THROW(BenchLog(folder_ / "no" / "bench.csv", false).append({row_of(1, "frame", 1)}),
                 Error);
}

// Tables published before shadows were counted stay readable.
TEST(BenchRow, ReadsTablesWithoutTheColumnsOfShadows) {
    BenchRow row = row_of(1, "frame", 1.0);
    Table table = bench_table({row});
    for (int i = 0; i < 2; ++i) {
        table.columns.pop_back();
        table.rows[0].pop_back();
    }
    row.shafts = row.saved_rays = 0.0;
    const auto back = bench_rows(parse_csv(to_csv(table)));
    ASSERT_EQ(back.size(), 1u);
    expect_same(back[0], row);
    table.columns.pop_back();
    table.rows[0].pop_back();
    EXPECT_THROW(bench_rows(parse_csv(to_csv(table))), Error);
}

TEST(BenchSummary, ShowsRaysWhereSomeWereCast) {
    BenchRow row = row_of(1, "cast_shadows", 1.0);
    EXPECT_EQ(bench_summary({row}).columns.back(), "shafts");
    EXPECT_NE(bench_legend({row}).find("shafts"), std::string::npos);
    row.shafts = 0.0;
    EXPECT_EQ(bench_summary({row}).columns.back(), "bits differ");
    EXPECT_EQ(bench_legend({row}).find("shafts"), std::string::npos);
}

TEST(BenchSummary, ShowsWhatVaries) {
    const Table table = bench_summary({row_of(1, "frame", 1), row_of(2, "frame", 1)});
    EXPECT_EQ(table.columns[0], "lights");
    EXPECT_EQ(table.columns[1], "stage");
    EXPECT_EQ(std::get<std::string>(table.rows[1][0]), "2");
    EXPECT_EQ(bench_summary({row_of(1, "frame", 1)}).columns[0], "stage");
    EXPECT_NO_THROW(to_markdown(table));
}

// A row of 10 or more frames between `fastest` and `slowest`.
BenchRow timed_row(double fastest, double slowest, double limit_ms) {
    BenchRow row = row_of(1, "shade", 1.0);
    std::vector<double> times;
    for (int i = 0; i < 20; ++i) times.push_back(fastest + (slowest - fastest) * i / 19.0);
    row.ms = statistics(times);
    row.limit_ms = limit_ms;
    return row;
}

TEST(BenchRow, BeatsItsLimitByMoreThanTheNoise) {
    EXPECT_TRUE(timed_row(60.0, 62.0, 256.0).beats_limit());
    EXPECT_FALSE(timed_row(60.0, 62.0, 59.0).beats_limit());
    EXPECT_FALSE(timed_row(60.0, 62.0, 62.5).beats_limit()) << "limits are measured to 5 %";
    EXPECT_FALSE(timed_row(60.0, 300.0, 256.0).beats_limit()) << "within the noise";
    BenchRow few = timed_row(60.0, 62.0, 256.0);
    few.ms.count = 9;
    EXPECT_FALSE(few.beats_limit()) << "noise unknown";
    const Table table = bench_summary({timed_row(60.0, 62.0, 256.0)});
    EXPECT_EQ(std::get<std::string>(table.rows[0][6]), "beaten: special functions");
}

TEST(BenchPlots, DrawTimesAndSpeedUp) {
    std::vector<BenchRow> rows;
    for (const std::uint64_t lights : {2000u, 500u}) {
        rows.push_back(row_of(lights, "frame", 10.0));
        rows.push_back(row_of(lights, "cull_lights", 1.0));
        rows.push_back(row_of(lights, "frame", static_cast<double>(lights)));
        rows.back().point.renderer = RendererKind::deferred_all;
    }
    rows.push_back(row_of(2000, "frame", 12.0));
    rows.back().point.grid = {4, 4, 1};
    const auto plots = bench_plots(rows, "atrium on a device");
    ASSERT_EQ(plots.size(), 3u);
    EXPECT_EQ(plots[0].stem, "time_against_lights");
    ASSERT_EQ(plots[0].plot.series.size(), 2u) << "the other grid is a point, not a curve";
    EXPECT_EQ(plots[0].plot.series[0].name, "frame, deferred");
    EXPECT_EQ(plots[0].plot.series[0].points[0].x, 500.0) << "left to right";
    EXPECT_TRUE(plots[0].plot.log_x && plots[0].plot.log_y);
    EXPECT_EQ(plots[0].plot.subtitle,
              "atrium on a device, resolution 1920x1080, grid 16x9x4, gbuffer packed");
    const PlotPoint& point = plots[0].plot.series[0].points[0];
    EXPECT_LT(point.low, point.y);
    EXPECT_GT(point.high, point.y);
    EXPECT_EQ(plots[1].stem, "time_against_grid");
    EXPECT_EQ(plots[1].plot.series[0].points[0].x, 16.0);
    EXPECT_EQ(plots[2].stem, "speed_up_against_lights");
    ASSERT_EQ(plots[2].plot.series.size(), 1u);
    EXPECT_DOUBLE_EQ(plots[2].plot.series[0].points[1].y, 200.0);
    EXPECT_TRUE(bench_plots({row_of(1, "frame", 1)}, "").empty());
    EXPECT_TRUE(bench_plots({}, "").empty());
}

TEST(BenchRun, ComparesSmallPicturesOfTheSameShape) {
    using Size = std::array<int, 2>;
    const auto error_resolution = [](Size size, std::uint64_t lights) {
        return error_size(size, lights, kBenchErrorSize);
    };
    EXPECT_EQ(error_resolution({1920, 1080}, 5000), (Size{480, 270}));
    EXPECT_EQ(error_resolution({64, 36}, 5000), (Size{64, 36}));
    EXPECT_EQ(error_resolution({1, 1}, 0), (Size{1, 1}));
    const Size million = error_resolution({1920, 1080}, 1000000);
    EXPECT_LE(million[0] * million[1], 2000);
    EXPECT_GE(million[0] * million[1], 1500);
    EXPECT_EQ(error_resolution({10, 10}, std::uint64_t{1} << 31), (Size{1, 1}));
}

}  // namespace
}  // namespace kilolux
