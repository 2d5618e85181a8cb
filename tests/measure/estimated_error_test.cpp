// SPDX-License-Identifier: Apache-2.0
// Estimated errors of pictures in the rows of a report.
#include "host/measure/report/estimated_error.h"

#include <gtest/gtest.h>

#include <set>

#include "host/measure/report/error_sheets.h"
#include "host/measure/report/run.h"
#include "host/measure/report/tables.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// Lights so weak that a budget's range ends within the scene.
Scene scene_without_ranges() {
    Scene scene = grid_with_every_light();
    for (SceneLight& light : scene.lights) {
        light.range = 0.0f;
        light.intensity *= 0.02f;
    }
    return scene;
}

TEST(ErrorEstimate, IsComparedAsMediansAndRootMeanSquares) {
    RgbImage picture = make_rgb_image(2, 1), reference = make_rgb_image(2, 1);
    picture.rgb = {1, 2, 3, 4, 5, 6};
    reference.rgb = {1, 2, 3, 4, 5, 3};
    picture.rgb[1] = 2.5;
    picture.rgb[2] = 3.25;
    const Layer bound{"error-bound", {"R", "G", "B"}, {0, 2, 1, 0, 0, 4}};
    const ErrorEstimate bounded =
        compare_estimate(EstimateKind::bound, bound, 4, picture, reference);
    EXPECT_DOUBLE_EQ(bounded.estimated, 2.0) << "of a bound no sample takes anything away";
    EXPECT_DOUBLE_EQ(bounded.error, 0.5) << "the middle one of 0.25, 0.5 and 3";
    picture.rgb = {1, 2, 3, 4, 5, 6};
    const Layer standard{"error-standard", {"error.standard"}, {0, 4}};
    const ErrorEstimate sampled =
        compare_estimate(EstimateKind::standard, standard, 4, picture, reference);
    EXPECT_DOUBLE_EQ(sampled.estimated, std::sqrt(4.0 / 2.0)) << "half of one sample's";
    EXPECT_NEAR(sampled.error, std::sqrt(0.0722 * 0.0722 * 9.0 / 2.0), 1e-15);
    EXPECT_THROW(compare_estimate(EstimateKind::bound, standard, 1, picture, reference),
                 std::exception);
}

TEST(ErrorEstimate, HoldsTheMeanInAShareOfTheNoisyPixels) {
    RgbImage picture = make_rgb_image(4, 1);
    picture.rgb = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    MeanPicture mean{{1.3, 1.3, 1.3, 1.3, 1.3, 1.3, 1.3, 1.3, 1.3, 1.3, 1.3, 1.3}, {0, 0, 0, 0.02}};
    const Layer standard{"error-standard", {"error.standard"}, {0.0f, 0.2f, 0.1f, 0.1f}};
    EXPECT_DOUBLE_EQ(share_within(standard, picture, mean), 2.0 / 3.0)
        << "the first has no noise, the last that of the mean, too";
    mean.variance.pop_back();
    EXPECT_THROW(share_within(standard, picture, mean), std::exception);
}

// Rows as of a report: errors that fall as the root of the rays.
TEST(ErrorEstimate, IsPlottedOverTheRays) {
    std::vector<ReportRow> rows(3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].setting.settings.shadows = Shadows::sampled;
        rows[i].setting.settings.shadow_rays = 4 << (2 * i);
        rows[i].surfaces.hdr.rmse = 0.5 + static_cast<double>(i);
        rows[i].estimate = {EstimateKind::standard, 0.25, 0.125, 0.9};
    }
    const auto over_rays = [&] {
        std::vector<Plot> found;
        for (const NamedPlot& plot : report_plots(rows, "here")) {
            if (plot.stem == "error_over_rays") found.push_back(plot.plot);
        }
        return found;
    };
    ASSERT_EQ(over_rays().size(), 1u);
    const Plot plot = over_rays().front();
    ASSERT_EQ(plot.series.size(), 4u);
    EXPECT_EQ(plot.series[0].points[1].x, 16.0);
    EXPECT_EQ(plot.series[0].points[1].y, 1.5);
    EXPECT_EQ(plot.series[1].points[1].y, 0.125);
    EXPECT_EQ(plot.series[2].points[1].y, 0.25);
    EXPECT_EQ(plot.series[3].points[2].y, 0.0625) << "a quarter with sixteen times the rays";
    rows.pop_back();
    EXPECT_TRUE(over_rays().empty()) << "two points are no curve";
}

TEST(ErrorEstimate, IsThatOfTheWayWithLights) {
    const Scene unranged = scene_without_ranges();
    const Scene ranged = make_generated_scene("grid");
    RenderSettings settings = small_settings(32, 18, 0);
    const auto estimate = [&](const Scene& scene, Tails tails, Shadows shadows = Shadows::off) {
        settings.tails = tails;
        settings.shadows = shadows;
        return estimate_kind(scene, settings);
    };
    EXPECT_EQ(estimate(unranged, Tails::exact), std::nullopt);
    EXPECT_EQ(estimate(unranged, Tails::bounded), EstimateKind::bound);
    EXPECT_EQ(estimate(unranged, Tails::tree), EstimateKind::bound);
    EXPECT_EQ(estimate(unranged, Tails::stochastic), EstimateKind::standard);
    EXPECT_EQ(estimate(unranged, Tails::stochastic, Shadows::sampled), EstimateKind::standard);
    EXPECT_EQ(estimate(unranged, Tails::exact, Shadows::sampled), EstimateKind::standard);
    EXPECT_EQ(estimate(unranged, Tails::bounded, Shadows::sampled), std::nullopt)
        << "it is half of it";
    EXPECT_EQ(estimate(ranged, Tails::bounded), std::nullopt) << "nothing is lost";
    EXPECT_EQ(estimate(ranged, Tails::bounded, Shadows::sampled), EstimateKind::standard);
    settings.renderer = RendererKind::deferred_all;
    EXPECT_EQ(estimate(unranged, Tails::bounded), std::nullopt) << "only deferred has one";
}

// The settings of the axis of cut-offs, measured once.
struct CutOffs {
    CutOffs() : scene(scene_without_ranges()), settings(small_settings(48, 27, 0)) {
        settings.tails = Tails::bounded;
        settings.range_budget = 0.25f;
        run.emplace(ReportView{scene, first_camera(scene), 0.0}, settings);
        auto wanted = report_settings(scene, settings, describe(choose_device(settings.device)),
                                      {.quick = true});
        std::erase_if(wanted, [](const ReportSetting& s) { return !compares_cut_offs(s.axis); });
        rows = run->measure(wanted, {0, 1});
    }
    Scene scene;
    RenderSettings settings;
    std::optional<ReportRun> run;
    std::vector<ReportRow> rows;
};

// Root mean square of a row's standard error, from a picture of its own.
double standard_error(const CutOffs& of, const ReportRow& row) {
    RenderSettings settings = of.run->at_error_size(row.setting.settings);
    settings.want.aovs = {"error-standard"};
    const Frame frame = render_once(of.scene, settings);
    double sum = 0.0;
    for (const float value : frame.aovs.front().values) sum += double{value} * value;
    return std::sqrt(sum / (48 * 27) / settings.samples);
}

TEST(ErrorEstimate, StandsInAReportBesideTheError) {
    CutOffs measured;
    std::set<std::string> bounds, standards;
    for (const ReportRow& row : measured.rows) {
        if (!row.estimate) {
            EXPECT_EQ(row.setting.name, "tails exact");
            EXPECT_LT(row.tails.rmse, 1e-5) << "only what the kernels round";
            continue;
        }
        const double ratio = row.estimate->estimated / row.estimate->error;
        EXPECT_GT(row.tails.rmse, 1e-4) << row.setting.name;
        if (row.estimate->kind == EstimateKind::bound) {
            bounds.insert(row.setting.name);
            EXPECT_GE(ratio, 1.0) << row.setting.name;
            EXPECT_LE(row.estimate->error, row.tails.absolute.max) << row.setting.name;
        } else {
            standards.insert(row.setting.name);
            EXPECT_GT(row.estimate->error, 0.0) << row.setting.name;
            EXPECT_DOUBLE_EQ(row.estimate->estimated, standard_error(measured, row))
                << row.setting.name;
        }
    }
    EXPECT_EQ(bounds, (std::set<std::string>{"default", "cut-off 1/16", "cut-off 1/256"}));
    EXPECT_EQ(standards, std::set<std::string>{"tails stochastic 4"});
    EXPECT_EQ(measured.rows.front().cut_off, 0.25) << "of lights whose file gives no range";
    std::set<std::string> stems;
    for (const NamedPlot& plot : report_plots(measured.rows, "here")) stems.insert(plot.stem);
    EXPECT_TRUE(stems.contains("time_against_bound"));
    EXPECT_TRUE(stems.contains("time_against_standard_error"));
    EXPECT_TRUE(stems.contains("time_against_cut_off"));
    EXPECT_TRUE(stems.contains("time_against_tails_error"));
    const Table summary = report_summary(measured.rows);
    EXPECT_EQ(std::ranges::count(summary.columns, "estimated / error"), 1);
    EXPECT_EQ(cut_off_table(measured.rows).rows.size(), measured.rows.size());
    const ComparedReference& unbounded = measured.run->references().unbounded();
    const Canvas sheet = cut_off_sheet(measured.rows, unbounded, "here");
    const int panels = 7 * 27 + 14 + 6;  // magnified 7 times, with a line of text and a gap
    EXPECT_GE(sheet.height, static_cast<int>(measured.rows.size()) * panels);
    EXPECT_EQ(sheet.width, 2 * 7 * 48 + 3 * 6);
}

}  // namespace
}  // namespace kilolux
