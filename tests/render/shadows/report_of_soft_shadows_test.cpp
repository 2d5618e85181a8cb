// SPDX-License-Identifier: Apache-2.0
// Rows of a report about lights with a size: errors over rays, against references with soft
// shadows.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "host/measure/report/run.h"
#include "host/measure/report/tables.h"
#include "tests/render/shadows/soft_scenes.h"

namespace kilolux {
namespace {

TEST(ReportOfAreaLights, HasItsErrorsOverTheRays) {
    ShadowScenario scenario = board_below(panel(LightType::rectangle));
    scenario.scene.lights.push_back(panel(LightType::sphere));
    scenario.scene.lights.back().position = {-1.0, 3.5, 1.0};
    RenderSettings settings = soft_settings(32, 18, 4);
    ReportRun run(ReportView{scenario.scene, scenario.camera, 0.0}, settings);
    EXPECT_EQ(run.error_size(), (std::array{32, 18})) << "affordable";
    auto wanted = report_settings(scenario.scene, settings,
                                  describe(choose_device(settings.device)), {.quick = true});
    std::erase_if(wanted, [](const ReportSetting& s) {
        return s.axis != SettingAxis::shadows && s.axis != SettingAxis::none;
    });
    const std::vector<ReportRow> rows = run.measure(wanted, {0, 1});
    ASSERT_EQ(rows.size(), 7u) << "no shadows, and six numbers of rays";
    std::map<int, const ReportRow*> by_rays;
    for (const ReportRow& row : rows) {
        const RenderSettings& s = row.setting.settings;
        if (s.shadows == Shadows::off) {
            EXPECT_FALSE(row.estimate);
            EXPECT_LT(row.kernels.hdr.rmse, 1e-4) << "R1 has none, either";
            EXPECT_GT(row.surfaces.hdr.rmse, 0.05) << "R2 has them";
            continue;
        }
        by_rays[s.shadow_rays] = &row;
        ASSERT_TRUE(row.estimate && row.estimate->within) << row.setting.name;
        // Errors are estimated from pairs of a lobe's rays: of one or two rays few pixels have one.
        if (s.shadow_rays < 4) continue;
        EXPECT_GT(*row.estimate->within, 0.3) << row.setting.name;
        EXPECT_LE(*row.estimate->within, 1.0) << row.setting.name;
        EXPECT_NEAR(row.estimate->estimated / row.estimate->error, 1.0, 0.4) << row.setting.name;
    }
    EXPECT_LT(by_rays[16]->surfaces.hdr.rmse, 0.7 * by_rays[2]->surfaces.hdr.rmse);
    EXPECT_LT(by_rays[32]->kernels.flip.mean, by_rays[1]->kernels.flip.mean);
    const Table table = report_table(rows);
    for (const char* column : {"shadow rays", "in 95 % [%]", "R2 rmse", "estimated error"}) {
        EXPECT_EQ(std::ranges::count(table.columns, column), 1) << column;
    }
}

}  // namespace
}  // namespace kilolux
