// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "host/base/error.h"
#include "host/measure/bench/plot_script.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

Plot sample_plot() {
    return {.title = "Speed & error: 'quoted' \"twice\" $HOME `id` a_b^c",
            .x_label = "frame [ms]",
            .y_label = "mean FLIP",
            .log_x = true,
            .log_y = true,
            .series = {{"packed", {{1, 0.1}, {2, 0.01}, {4, 0.05}, {3, 0.0}}},
                       {"full; system('false')",
                        {{5, 0.001}, {6, std::nan("")}, {INFINITY, 1}},
                        PlotStyle::points},
                       {"nothing", {{-1, 1}}},
                       {"Pareto front", {{1, 0.1}, {2, 0.01}, {5, 0.001}}, PlotStyle::steps}}};
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// An empty folder with a name that a shell or a script could trip over.
class PlotFolder : public testing::Test {
 protected:
    void SetUp() override {
        folder_ =
            fs::path(testing::TempDir()) / ("kilolux plot's $test " + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
    }
    fs::path folder_;
};

TEST(PlotScript, KeepsWhatAxesCanShow) {
    const Plot ready = drawable(sample_plot());
    ASSERT_EQ(ready.series.size(), 3u) << "two series and the front";
    EXPECT_EQ(ready.series[0].points.size(), 3u);
    EXPECT_EQ(ready.series[1].points.size(), 1u);
}

TEST(PlotScript, DataIsOneBlockASeries) {
    const Plot plot{.title = "",
                    .x_label = "",
                    .y_label = "",
                    .series = {{"a \"y\"\nz", {{1, 0.5}}}, {"b", {{2, 1e-9}}}}};
    EXPECT_EQ(plot_data(plot), "# \"a 'y' z\"\n1 0.5 0.5 0.5\n\n\n# \"b\"\n2 1e-09 1e-09 1e-09\n");
}

TEST(PlotScript, DrawsErrorBarsAndTheSubtitle) {
    Plot plot{.title = "t", .subtitle = "atrium on a device", .x_label = "x", .y_label = "y"};
    plot.series = {{"s", {{1.0, 2.0, 1.5, 3.0}, {2.0, 2.0}}}};
    const std::string script = plot_script(plot, "stem");
    EXPECT_NE(script.find("yerrorlines"), std::string::npos) << script;
    EXPECT_NE(script.find("atrium on a device"), std::string::npos) << script;
    plot.series[0].points[0].low = plot.series[0].points[0].high = 2.0;
    EXPECT_EQ(plot_script(plot, "stem").find("yerror"), std::string::npos) << "no spread, no bars";
    plot.series[0].points[0].x_high = 1.5;
    EXPECT_NE(plot_script(plot, "stem").find("1:2:5:6:3:4 with xyerrorlines"), std::string::npos);
    EXPECT_EQ(plot_data(plot), "# \"s\"\n1 2 2 2 1 1.5\n2 2 2 2 2 2\n");
}

TEST_F(PlotFolder, WritesFourFilesAndNothingElse) {
    write_plot(sample_plot(), folder_ / "it's a plot");
    const std::string png = bytes_of(folder_ / "it's a plot.png");
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_GT(png.size(), 4000u);
    const std::string svg = bytes_of(folder_ / "it's a plot.svg");
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    EXPECT_NE(svg.find("Pareto front"), std::string::npos);
    EXPECT_NE(svg.find("a_b^c"), std::string::npos) << "titles are text, not markup";
    EXPECT_NE(svg.find("full; system("), std::string::npos);
    EXPECT_FALSE(bytes_of(folder_ / "it's a plot.gnuplot").empty());
    EXPECT_FALSE(bytes_of(folder_ / "it's a plot.dat").empty());
    EXPECT_EQ(file_count(), 4u);
}

TEST_F(PlotFolder, LinearAxesAndOnePointWork) {
    const Plot plot{.title = "one", .x_label = "x", .y_label = "y", .series = {{"s", {{3, -2}}}}};
    write_plot(plot, folder_ / "one");
    EXPECT_FALSE(bytes_of(folder_ / "one.svg").empty());
}

TEST_F(PlotFolder, NoPointIsAnError) {
    Plot plot = sample_plot();
    plot.series = {{"empty", {}}, {"bad", {{0, 1}}}};
    EXPECT_THROW(write_plot(plot, folder_ / "p"), Error);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(PlotFolder, MissingFolderIsAnError) {
    EXPECT_THROW(write_plot(sample_plot(), folder_ / "no such" / "p"), Error);
}

TEST_F(PlotFolder, WithoutGnuplotThereAreNoPlots) {
    EXPECT_TRUE(can_plot());
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder_.c_str(), 1);
    const bool possible = can_plot();
    setenv("PATH", path.c_str(), 1);
    EXPECT_FALSE(possible);
}

// Every series is in the key; those of one colour differ in their points.
TEST(PlotScript, TheKeyTellsSeriesApart) {
    Plot plot{.title = "t", .x_label = "x", .y_label = "y"};
    plot.series = {{"a", {{1, 1}}, PlotStyle::points, 3},
                   {"b", {{2, 2}}, PlotStyle::points, 3},
                   {"c", {{3, 3}}, PlotStyle::points, 4},
                   {"front", {{1, 1}, {2, 2}}, PlotStyle::steps}};
    const std::string script = plot_script(plot, "stem");
    for (const char* part :
         {"lt 4 pt 7 ps 0.8 lw 1.5 title 'a'", "lt 4 pt 5 ps 0.8 lw 1.5 title 'b'",
          "lt 5 pt 7 ps 0.8 lw 1.5 title 'c'"}) {
        EXPECT_NE(script.find(part), std::string::npos) << part << " / " << script;
    }
    EXPECT_NE(script.find("plot DATA index 3 using 1:2 with steps"), std::string::npos) << script;
}

TEST_F(PlotFolder, FailingGnuplotIsAnErrorWithItsMessage) {
    const fs::path fake = folder_ / "bin";
    fs::create_directories(fake);
    std::ofstream(fake / "gnuplot")
        << "#!/bin/sh\necho 'line 3: Error: no such terminal' >&2\nexit 1\n";
    fs::permissions(fake / "gnuplot", fs::perms::owner_all);
    const std::string path = std::getenv("PATH");
    setenv("PATH", fake.c_str(), 1);
    std::string message;
    try {
        write_plot(sample_plot(), folder_ / "p");
    } catch (const Error& error) {
        message = error.what();
    }
    setenv("PATH", path.c_str(), 1);
    EXPECT_NE(message.find("no such terminal"), std::string::npos) << message;
    EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace kilolux
