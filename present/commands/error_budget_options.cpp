// SPDX-License-Identifier: Apache-2.0
#include "present/commands/error_budget_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/measure/report/tail_budget.h"
#include "present/cli/conditions.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"

namespace kilolux {
namespace {

// Few frames suffice: each is compared with one of the default setting beside it.
constexpr BenchFrames kTrialFrames = {1, 6};

BudgetKey key_of(const SharedOptions& shared, const BudgetOptions& options,
                 const ErrorBudget& budget, const ReportView& view) {
    return fmt::format("{}\ntime {}\n{} {} {} {}",
                       conditions_json(shared, view.scene, view.camera).dump(), view.time,
                       budget.metric, budget.max_error, options.error_width.value_or(0),
                       budget.chooses_shadows);
}

void say(const BudgetChoice& choice, const ErrorBudget& budget, const char* when) {
    const auto [width, height] = choice.error_size;
    note(
        fmt::format("chose   {}: {} {:.3g}, measured at {}x{} pixels, is within {:g}; {:.3g} times "
                    "the default's frame time; {}",
                    choice.name, budget.metric, choice.error, width, height, budget.max_error,
                    choice.relative, when));
}

// report_settings() in its short form: without grids and lanes, which `bench --tune` chooses.
std::vector<ReportSetting> candidates_of(const SharedOptions& shared, const ReportView& view,
                                         const ErrorBudget& budget, const DeviceInfo& device) {
    RenderSettings asked = shared.settings;
    asked.want = {};  // views and AOVs have no error
    auto settings = report_settings(view.scene, asked, device, budget_candidates(budget));
    const std::vector<std::string>& aovs = shared.settings.want.aovs;
    const bool asks_error = std::ranges::find(aovs, "error-standard") != aovs.end();
    std::erase_if(settings, [&](const ReportSetting& setting) {
        const bool lacks_error = asks_error && setting.settings.shadows != Shadows::sampled;
        return !is_candidate(setting, budget) || lacks_error;
    });
    return settings;
}

BudgetChoice measure_choice(const SharedOptions& shared, const BudgetOptions& options,
                            const ErrorBudget& budget, const ReportView& view,
                            const std::vector<ReportSetting>& settings) {
    ReportRun run(view, shared.settings, error_limits(options));
    Progress progress("choosing", ReportRun::steps(settings.size()),
                      progress_kind_of_part(shared.shown_progress()));
    run.on_step(check_interrupt);
    run.on_progress([&progress] { progress.advance(); });
    // Settings over the budget are not timed.
    run.time_only(
        [&](const ReportRow& row) { return error_of(row, budget.metric) <= budget.max_error; });
    return choose_within(run.measure(settings, kTrialFrames), budget);
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names = error_metric_names();
    names.emplace_back(kBoundMetric);
    return names;
}

RenderSettings tails_within_budget(const SharedOptions& shared, const BudgetOptions& options,
                                   const ReportView& view) {
    const TailChoice choice =
        tails_within(view, shared.settings, *options.max_error, check_interrupt);
    const RenderSettings& s = choice.settings;
    note(s.tails == Tails::exact
             ? "chosen  --tails exact: no pixel lacks light"
             : fmt::format("chosen  --tails bounded --range-budget {}: no pixel of this view lacks "
                           "more than {:.4g}",
                           s.range_budget, choice.bound));
    return s;
}

}  // namespace

void visit_settings(BudgetOptions& options, const SettingVisitor& visit) {
    OptionBuilder(visit, "Error budget")
        .rest()
        .number({"--max-error", "E", "",
                 "Use the fastest setting whose error on this scene and device is at most E; of "
                 "sampled shadows it also chooses the rays, or exact ones (not where lights have "
                 "a size), unless --shadow-rays is given",
                 kPicture, "the metric's"},
                options.max_error, {0.0})
        .choice(
            {"--error-metric", "", "flip",
             "What E is: against the float64 picture asked for; r1-: the kernels' error alone; "
             "r3-: lights without a range; bound: the most that any pixel of this view may lack "
             "because such lights got one, in radiance: guaranteed, by --tails alone",
             kPicture},
            options.metric, metric_names())
        .count({"--error-width", "W", "auto",
                "Width of the pictures that errors are measured on; auto: at most 320 px, and "
                "so few that the float64 reference takes seconds",
                kPicture, "px"},
               options.error_width, kEdgeRange);
}

ErrorSizeLimits error_limits(const BudgetOptions& options) {
    if (!options.error_width) return {};
    return {.width = *options.error_width, .evaluations = std::numeric_limits<double>::infinity()};
}

RenderSettings settings_within_budget(const SharedOptions& shared, const BudgetOptions& options,
                                      const ReportView& view) {
    if (!options.max_error) return shared.settings;
    if (options.metric == kBoundMetric) return tails_within_budget(shared, options, view);
    const auto wanted = [&](const BudgetChoice& choice) {
        RenderSettings out = choice.settings;
        out.want = shared.settings.want;
        return out;
    };
    const ErrorBudget budget = budget_of(shared, options);
    const DeviceInfo device = describe(choose_device(shared.settings.device));
    const auto candidates = candidates_of(shared, view, budget, device);
    const BudgetKey key = key_of(shared, options, budget, view);
    if (const auto kept = stored_choice(device, key, candidates)) {
        say(*kept, budget, "kept from before");
        return wanted(*kept);
    }
    const BudgetChoice choice = measure_choice(shared, options, budget, view, candidates);
    store_choice(device, key, choice);
    say(choice, budget, "measured now, and kept");
    return wanted(choice);
}

ErrorBudget budget_of(const SharedOptions& shared, const BudgetOptions& options) {
    const bool sampled = shared.settings.shadows == Shadows::sampled;
    refuse_if(options.metric == kBoundMetric,
              "error metric bound: render and bench keep within it; report has rows of measured "
              "errors");
    return {options.max_error.value_or(0.0), options.metric,
            options.max_error && sampled && !shared.shadow_rays_given};
}

SettingChoice budget_candidates(const ErrorBudget& budget) {
    SettingChoice out{.quick = true};
    if (budget.chooses_shadows) out.shadow_rays = {1, 2, 4, 8, 16, 32, 64};
    return out;
}

void choose_from_rows(const SharedOptions& shared, const BudgetOptions& options,
                      const ReportView& view, std::span<const ReportRow> rows) {
    if (!options.max_error) return;
    const ErrorBudget budget = budget_of(shared, options);
    const BudgetChoice choice = choose_within(rows, budget);
    store_choice(describe(choose_device(shared.settings.device)),
                 key_of(shared, options, budget, view), choice);
    say(choice, budget, "kept");
}

}  // namespace kilolux
