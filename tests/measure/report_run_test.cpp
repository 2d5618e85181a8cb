// SPDX-License-Identifier: Apache-2.0
// A small report: the error that each reference isolates, and that the default is in the Pareto
// set. Errors are measured; times, which depend on the machine's load, are replaced by the bytes
// moved.
#include "host/measure/report/run.h"

#include <gtest/gtest.h>

#include <set>

#include "host/measure/report/error_sheets.h"
#include "host/measure/report/picture_errors.h"
#include "host/measure/report/tables.h"
#include "host/render/plan/scene_plan.h"
#include "host/scene/generated/scenes.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

// Bytes that a frame moves per pixel: its G-buffer, and each light that it evaluates. Lanes and
// math modes do not change it.
double work_of(const Scene& scene, const ReportRow& row) {
    const ScenePlan plan = make_scene_plan(scene, row.setting.settings, 0);
    return plan.gbuffer_bytes_per_pixel + sizeof(ShadeLight) * std::max(row.speed.k, 0.0);
}

// The settings that the tests check; each builds kernels.
bool is_looked_at(const ReportSetting& setting) {
    const std::set<std::string> names = {
        "default",      "gbuffer full",  "gbuffer half",      "gbuffer normal-xy",
        "lanes 1",      "grid 4,4,1",    "shading lambert",   "renderer deferred-all",
        "cut-off 1/16", "cut-off 1/256", "light-colors half", "renderer forward-plus"};
    return names.count(setting.name) > 0;
}

// One report for all checks of a test.
struct SmallReport {
    SmallReport() : scene(make_generated_scene("grid")), settings(small_settings(64, 36, 100)) {
        const ReportView view{scene, first_camera(scene), 0.0};
        const DeviceInfo device = describe(choose_device(settings.device));
        run.emplace(view, settings);
        auto looked_at = report_settings(scene, settings, device, {.quick = true});
        std::erase_if(looked_at, [](const ReportSetting& s) { return !is_looked_at(s); });
        rows = run->measure(looked_at, {0, 1});
    }
    const ReportRow& row(const std::string& name) const {
        for (const ReportRow& r : rows) {
            if (r.setting.name == name) return r;
        }
        throw std::runtime_error("no row '" + name + "'");
    }
    Scene scene;
    RenderSettings settings;
    std::optional<ReportRun> run;
    std::vector<ReportRow> rows;
};

SmallReport& report() {
    static SmallReport small;
    return small;
}

void expect_right_kernels() {
    for (const ReportRow& row : report().rows) {
        const bool forward = row.setting.name.find("forward") != std::string::npos;
        const bool approximate = row.setting.axis == SettingAxis::math;
        const double bound = approximate ? 1e-3 : (forward ? 1e-2 : 3e-5);
        EXPECT_LE(row.kernels.hdr.relative.max, bound) << row.setting.name;
        EXPECT_EQ(row.kernels.hdr.nan_pixels, 0u) << row.setting.name;
        EXPECT_EQ(row.kernels.hdr.infinite_pixels, 0u) << row.setting.name;
        EXPECT_EQ(row.kernels.hdr.negative_pixels, 0u) << row.setting.name;
        EXPECT_EQ(row.missed_lights.value_or(0), 0u) << row.setting.name;
        EXPECT_LE(row.kernels.codes.difference.max, 1.0 + 254.0 * forward) << row.setting.name;
    }
    EXPECT_TRUE(report().row("default").missed_lights.has_value());
    EXPECT_GE(report().row("default").kernels.hdr.psnr_db, 110.0);
}

void expect_equal_pictures() {
    const ReportRow& expected = report().row("default");
    for (const char* name : {"lanes 1", "grid 4,4,1", "renderer deferred-all"}) {
        EXPECT_EQ(report().row(name).picture.rgb, expected.picture.rgb) << name;
        EXPECT_EQ(report().row(name).surfaces.hdr.rmse, expected.surfaces.hdr.rmse) << name;
    }
}

void expect_isolated_causes() {
    const auto& r = report();
    const ReportRow& standard = r.row("default");
    // `full` quantises nothing: its error against what was drawn is that of the kernels.
    EXPECT_EQ(r.row("gbuffer full").rasterised.rmse, r.row("gbuffer full").kernels.hdr.rmse);
    EXPECT_GT(standard.rasterised.rmse, 100.0 * standard.kernels.hdr.rmse);
    EXPECT_GT(r.row("gbuffer half").rasterised.rmse, standard.rasterised.rmse);
    EXPECT_GT(r.row("gbuffer normal-xy").rasterised.rmse, standard.rasterised.rmse);
    // A simpler shading model has no error by R1, but one by the scene's model.
    const ReportRow& lambert = r.row("shading lambert");
    EXPECT_LT(lambert.kernels.hdr.rmse, 1e-4 * lambert.surfaces.hdr.rmse);
    EXPECT_GT(lambert.surfaces.hdr.rmse, standard.surfaces.hdr.rmse);
    // Ranges cause an error against R3 only, a smaller one for a finer cut-off.
    const ReportRow &coarse = r.row("cut-off 1/16"), &fine = r.row("cut-off 1/256");
    EXPECT_LT(fine.unbounded.hdr.rmse, coarse.unbounded.hdr.rmse);
    EXPECT_GT(coarse.unbounded.hdr.rmse, coarse.surfaces.hdr.rmse);
    EXPECT_GT(fine.speed.k, coarse.speed.k);
    EXPECT_NEAR(coarse.cut_off, 1.0 / 16, 1e-12);
}

void expect_default_on_front() {
    std::vector<ReportRow> rows = report().rows;
    const double standard = work_of(report().scene, rows.front());
    for (ReportRow& row : rows) {
        row.speed.relative = work_of(report().scene, row) / standard;
        row.speed.noise = 0.0;
        row.surfaces_front = row.unbounded_front = false;
    }
    mark_fronts(rows);
    EXPECT_TRUE(rows.front().surfaces_front);
    EXPECT_TRUE(rows.front().unbounded_front);
    EXPECT_EQ(row_that_beats_default(rows), nullptr);
    for (const ReportRow& row : rows) {
        const bool as_exact = row.surfaces.hdr.rmse <= rows.front().surfaces.hdr.rmse;
        if (row.setting.axis == SettingAxis::math || row.setting.axis == SettingAxis::cut_off)
            continue;
        if (as_exact) {
            EXPECT_GE(row.speed.relative, 1.0) << row.setting.name;
        }
    }
}

// Three rows of one error: the default and two that are faster, as far as they are comparable.
TEST(RowThatBeatsDefault, IsTheFastestThatIsAsExact) {
    std::vector<ReportRow> rows(3);
    const double times[] = {1.0, 0.5, 0.8};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].setting.axis = i == 0 ? SettingAxis::none : SettingAxis::geometry;
        rows[i].speed.relative = times[i];
        rows[i].surfaces.hdr.rmse = 0.1;
    }
    EXPECT_EQ(row_that_beats_default(rows), &rows[1]);
    rows[1].surfaces.hdr.rmse = 0.2;
    EXPECT_EQ(row_that_beats_default(rows), &rows[2]) << "the other errs more";
    rows[2].speed.relative = 0.99;
    EXPECT_EQ(row_that_beats_default(rows), nullptr) << "within the resolution of times";
    rows[2].speed.noise = rows[1].speed.noise = 0.3;
    rows[2].speed.relative = 0.8;
    EXPECT_EQ(row_that_beats_default(rows), nullptr) << "within the noise";
    rows[2].setting.axis = SettingAxis::cut_off;
    rows[2].speed.noise = rows[1].speed.noise = 0.0;
    rows[2].speed.relative = 0.1;
    EXPECT_EQ(row_that_beats_default(rows), nullptr) << "it has other ranges";
    EXPECT_EQ(row_that_beats_default({}), nullptr);
}

// A slower, more exact row does not, however wide noise makes a step of times.
TEST(RowThatBeatsDefault, IsNoneThatIsSlowerOrAsFast) {
    std::vector<ReportRow> rows(2);
    rows[1].setting.axis = SettingAxis::geometry;
    rows[0].surfaces.hdr.rmse = 0.1;
    rows[1].surfaces.hdr.rmse = 0.01;
    for (const double time : {1.0, 1.02, 1.2, 3.0}) {
        for (const double noise : {0.0, 0.2, 2.0}) {
            rows[1].speed.relative = time;
            rows[1].speed.noise = noise;
            EXPECT_EQ(row_that_beats_default(rows), nullptr) << time << " " << noise;
        }
    }
    rows[1].speed.relative = 0.5;
    rows[1].speed.noise = 0.2;
    EXPECT_EQ(row_that_beats_default(rows), &rows[1]);
    rows.emplace_back(rows[1]).speed = {};
    rows[2].speed.noise = 2.0;
    EXPECT_EQ(row_that_beats_default(rows), &rows[1]) << "another row's noise is its own";
}

void expect_whole_tables() {
    const auto& rows = report().rows;
    const Table table = report_table(rows);
    EXPECT_EQ(table.rows.size(), rows.size());
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
    EXPECT_EQ(std::set<std::string>(table.columns.begin(), table.columns.end()).size(),
              table.columns.size());
    EXPECT_EQ(report_summary(rows).rows.size(), rows.size());
    for (const ReportRow& row : rows) {
        EXPECT_DOUBLE_EQ(row.speed.frame_ms, row.speed.relative * rows.front().speed.frame_ms)
            << row.setting.name;
    }
    std::map<std::string, std::size_t> points;
    for (const auto& [stem, plot] : report_plots(rows, "here")) {
        points[stem] = plot.series.size() - 1;
        EXPECT_EQ(plot.series.back().name, "Pareto front");
        EXPECT_EQ(plot.series.front().name, rows.front().setting.name) << "the key names settings";
        EXPECT_EQ(plot.subtitle, "here");
    }
    const std::map<std::string, std::size_t> expected = {{"time_against_error", rows.size() - 2},
                                                         {"time_against_unbounded_error", 3},
                                                         {"time_against_cut_off", 3}};
    EXPECT_EQ(points, expected) << "the default is in all, the two cut-offs are in the last two";
    EXPECT_NE(report_notes(rows).find("on pictures of 64x36 pixels"), std::string::npos);
}

// The error map of R1: the upper right panel, magnified 5 times, below title and panel's line.
void expect_error_maps() {
    auto& r = report();
    const ReportRow& row = r.rows.front();
    const auto references = r.run->references().all(r.run->at_error_size(row.setting.settings));
    const Canvas maps = error_map_sheet(row, references, "caption");
    const auto errors = pixel_errors(row.picture, references.kernels.picture.radiance,
                                     &references.kernels.picture.scale);
    const HeatScale scale{1e-8, 1.0, true, ""};
    for (int pixel = 0; pixel < 64 * 36; ++pixel) {
        const int x = 6 + 320 + 6 + 5 * (pixel % 64) + 2, y = 6 + 3 * 14 + 5 * (pixel / 64) + 2;
        const DisplayColor expected =
            heat_color(position_on(scale, errors[static_cast<std::size_t>(pixel)]));
        const auto i = static_cast<std::size_t>(4 * (y * maps.width + x));
        for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(maps.rgba[i + c], expected[c]) << pixel;
    }
}

// One test, since each test is its own process and would measure again.
TEST(ReportRun, MeasuresWhatEachSettingCostsAndErrs) {
    expect_right_kernels();
    expect_equal_pictures();
    expect_isolated_causes();
    expect_default_on_front();
    expect_whole_tables();
    expect_error_maps();
}

// The time of a setting too slow for whole frames is that of its small frame alone.
TEST(ReportRun, SlowSettingsAreTimedAgainAfterOthersWorkedBesideThem) {
    const Scene scene = make_generated_scene("grid");
    // So many lights that the larger frame takes longer, whatever works beside the small one.
    RenderSettings large = small_settings(1 << 16, 1 << 16, 8000);
    large.renderer = RendererKind::deferred_all;  // too slow on any CPU
    ReportRun run({scene, first_camera(scene), 0.0}, large, {.width = 48});
    const ReportSetting asked{SettingAxis::none, "default", "", large};
    ComparedRow compared = run.compare(asked, run.device());
    ASSERT_TRUE(compared.timing.scaled);
    constexpr double kDisturbed = 1e9;
    compared.timing.frames = {kDisturbed};
    run.estimate_again(compared);
    ASSERT_EQ(compared.timing.frames.size(), 1u);
    EXPECT_LT(compared.timing.frames.front(), kDisturbed);
    EXPECT_FALSE(compared.timing.stages.empty());
}

// Other drivers may draw other surfaces.
TEST(ReportReferences, AreMadeOnceForEachKindOfDevice) {
    const Scene scene = make_generated_scene("grid");
    ReportRun run({scene, first_camera(scene), 0.0}, small_settings(32, 18, 20));
    const RenderSettings settings = run.at_error_size(small_settings(32, 18, 20));
    const ReportDevice& device = run.device();
    Gpu unlike = *device.gpu;
    unlike.info.name += " II";
    const ReportDevice alike{std::make_shared<const Gpu>(*device.gpu), shared_scene(scene)};
    const ReportDevice other{std::make_shared<const Gpu>(unlike), shared_scene(scene)};
    const ComparedReference* first = &run.references().kernels(settings, device);
    EXPECT_EQ(&run.references().kernels(settings, alike), first);
    EXPECT_NE(&run.references().kernels(settings, other), first);
}

TEST(ReportRun, ALargerFrameTellsHowTimeGrowsWithPixels) {
    EXPECT_DOUBLE_EQ(extrapolated_ms({100.0, 5.0}, {400.0, 8.0}, 1000.0), 14.0);
    EXPECT_DOUBLE_EQ(extrapolated_ms({100.0, 7.0}, {400.0, 7.0}, 1000.0), 7.0);
    EXPECT_DOUBLE_EQ(extrapolated_ms({100.0, 9.0}, {400.0, 7.0}, 1000.0), 7.0);  // noise
}

TEST(ReportRun, DisplayCodesAreTheDevices) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 36, 100);
    for (const ToneCurve curve :
         {ToneCurve::none, ToneCurve::neutral, ToneCurve::aces, ToneCurve::agx}) {
        settings.tone_curve = curve;
        settings.exposure = 0.5f;
        const Frame frame = render_once(scene, settings);
        const auto codes = display_codes(rgb_image_of(frame.width, frame.height, frame.radiance),
                                         settings.exposure, curve);
        ASSERT_EQ(codes.size(), frame.display.size());
        int worst = 0;
        for (std::size_t i = 0; i < codes.size(); ++i) {
            worst = std::max(worst, std::abs(codes[i] - frame.display[i]));
        }
        EXPECT_LE(worst, curve == ToneCurve::none ? 0 : 1) << static_cast<int>(curve);
    }
}

}  // namespace
}  // namespace kilolux
