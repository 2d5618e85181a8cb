// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/error_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "host/base/error.h"
#include "host/gpu/tuning/device_cache.h"
#include "tests/support/cache_sandbox.h"

namespace kilolux {
namespace {

DeviceInfo budget_device(const std::string& name) {
    DeviceInfo device;
    device.name = name;
    device.driver = "1.2.3";
    return device;
}

ReportRow row(const std::string& name, double relative, double flip,
              SettingAxis axis = SettingAxis::gbuffer) {
    ReportRow out;
    out.setting = {axis, name, "--" + name, {}};
    out.speed.relative = relative;
    out.surfaces.flip.mean = flip;
    out.surfaces.hdr.rmse = 10.0 * flip;
    out.kernels.flip.mean = 0.0;
    out.picture.width = 64;
    out.picture.height = 36;
    out.unbounded.flip.mean = axis == SettingAxis::cut_off ? 0.1 : 0.9;
    return out;
}

std::vector<ReportRow> some_rows() {
    return {row("default", 1.0, 0.04, SettingAxis::none), row("gbuffer full", 1.5, 0.01),
            row("gbuffer half", 0.9, 0.05), row("shading lambert", 0.7, 0.2),
            row("cut-off 1/256", 0.5, 0.0, SettingAxis::cut_off)};
}

TEST(ErrorBudget, TakesTheFastestWithin) {
    const auto rows = some_rows();
    EXPECT_EQ(choose_within(rows, {1.0, "flip"}).name, "shading lambert");
    EXPECT_EQ(choose_within(rows, {0.1, "flip"}).name, "gbuffer half");
    EXPECT_EQ(choose_within(rows, {0.049, "flip"}).name, "default");
    EXPECT_EQ(choose_within(rows, {0.01, "flip"}).name, "gbuffer full")
        << "the budget itself is within";
    EXPECT_EQ(choose_within(rows, {0.1, "rmse"}).name, "gbuffer full");
    const BudgetChoice choice = choose_within(rows, {0.1, "flip"});
    EXPECT_EQ(choice.error, 0.05);
    EXPECT_EQ(choice.relative, 0.9);
    EXPECT_EQ(choice.error_size, (std::array{64, 36}));
}

TEST(ErrorBudget, OtherRangesAreAnotherPictureUnlessTheBudgetIsAboutThem) {
    const auto rows = some_rows();
    EXPECT_EQ(choose_within(rows, {0.0, "r1-flip"}).name, "shading lambert");
    EXPECT_EQ(choose_within(rows, {0.5, "r3-flip"}).name, "cut-off 1/256");
}

TEST(ErrorBudget, ShadowsAreChosenOnlyWhereTheBudgetSaysSoAndNeverNone) {
    auto rows = some_rows();
    for (const auto& [name, relative, shadows] :
         {std::tuple{"shadows off", 0.1, Shadows::off},
          std::tuple{"shadows sampled 8", 0.2, Shadows::sampled},
          std::tuple{"shadows exact", 0.3, Shadows::exact}}) {
        rows.push_back(row(name, relative, 0.3 - relative, SettingAxis::shadows));
        rows.back().setting.settings.shadows = shadows;
    }
    EXPECT_EQ(choose_within(rows, {1.0, "flip"}).name, "shading lambert");
    EXPECT_EQ(choose_within(rows, {1.0, "flip", true}).name, "shadows sampled 8");
    EXPECT_EQ(choose_within(rows, {0.05, "flip", true}).name, "shadows exact");
}

TEST(ErrorBudget, NamesTheBestReachable) {
    const auto rows = some_rows();
    try {
        choose_within(rows, {0.001, "flip"});
        FAIL() << "a choice within an impossible budget";
    } catch (const Error& error) {
        EXPECT_STREQ(
            error.what(),
            "max error: no setting is within flip 0.001; the best reachable is 0.01 at 64x36 "
            "pixels by 'gbuffer full'");
    }
    std::vector<ReportRow> broken = {row("default", 1.0, std::nan(""), SettingAxis::none)};
    EXPECT_THROW(choose_within(broken, {1.0, "flip"}), Error) << "NaN is within nothing";
    EXPECT_THROW(choose_within({}, {1.0, "flip"}), Error);
}

TEST(ErrorBudget, EveryMetricReadsItsOwnError) {
    ReportRow r;
    double value = 1.0;
    for (PictureErrors ReportRow::*errors :
         {&ReportRow::surfaces, &ReportRow::kernels, &ReportRow::unbounded}) {
        PictureErrors& e = r.*errors;
        for (double* error : {&e.hdr.rmse, &e.hdr.absolute.mean, &e.hdr.absolute.max,
                              &e.hdr.absolute.percentile_99_9, &e.hdr.relative.max,
                              &e.hdr.relative.percentile_99_9, &e.hdr.rel_mse}) {
            *error = value++;
        }
        e.hdr.different_pixels = static_cast<std::uint64_t>(value++);
        for (double* error : {&e.flip.mean, &e.flip.percentile_99_9, &e.flip_display.mean,
                              &e.codes.difference.max}) {
            *error = value++;
        }
        e.codes.different_pixels = static_cast<std::uint64_t>(value++);
    }
    value = 1.0;
    for (const std::string& name : error_metric_names())
        EXPECT_EQ(error_of(r, name), value++) << name;
    EXPECT_EQ(value, 40.0);
    EXPECT_THROW(error_of(r, "psnr"), UsageError);
}

class StoredChoice : public CacheSandbox {
 protected:
    DeviceInfo device_ = budget_device("cpu");
    std::vector<ReportSetting> candidates_ = [] {
        std::vector<ReportSetting> out;
        for (const ReportRow& r : some_rows()) out.push_back(r.setting);
        out[2].settings.gbuffer = GBUFFER_HALF;
        return out;
    }();
    BudgetChoice choice_{"gbuffer half", candidates_[2].settings, 0.05, 0.9, {64, 36}};
};

TEST_F(StoredChoice, ComesBackForItsKeyAndDeviceOnly) {
    EXPECT_FALSE(stored_choice(device_, "scene", candidates_)) << "nothing is stored yet";
    store_choice(device_, "scene", choice_);
    const auto found = stored_choice(device_, "scene", candidates_);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->name, "gbuffer half");
    EXPECT_EQ(found->settings.gbuffer, uint{GBUFFER_HALF});
    EXPECT_EQ(found->error, 0.05);
    EXPECT_EQ(found->relative, 0.9);
    EXPECT_EQ(found->error_size, (std::array{64, 36}));
    EXPECT_FALSE(stored_choice(device_, "scene 2", candidates_));
    EXPECT_FALSE(stored_choice(budget_device("gpu"), "scene", candidates_));
    candidates_.erase(candidates_.begin() + 2);
    EXPECT_FALSE(stored_choice(device_, "scene", candidates_)) << "no such setting any more";
}

TEST_F(StoredChoice, DamageMeansNone) {
    store_choice(device_, "scene", choice_);
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(cache_folder())) {
        ++files;
        std::ofstream(entry.path(), std::ios::app) << "more\n";
    }
    EXPECT_EQ(files, 1);
    EXPECT_FALSE(stored_choice(device_, "scene", candidates_));
}

}  // namespace
}  // namespace kilolux
