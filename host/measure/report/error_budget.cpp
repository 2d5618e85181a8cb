// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/error_budget.h"

#include <fmt/core.h>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/gpu/tuning/device_cache.h"

namespace kilolux {
namespace {

struct Against {
    const char* prefix;
    PictureErrors ReportRow::*errors;
};

constexpr Against kReferences[] = {
    {"", &ReportRow::surfaces}, {"r1-", &ReportRow::kernels}, {"r3-", &ReportRow::unbounded}};

std::string name_of(const Against& against, const ErrorMetric& metric) {
    return fmt::format("{}{}", against.prefix, metric.name);
}

constexpr int kVersion = 2;

// The kind of a cache entry is part of its file's name.
std::string kind_name(const BudgetKey& key) { return "choice-" + hash_text(key); }

// Cache values are numbers: 48 bits of the hash of a setting's name identify it.
double name_number(const std::string& name) { return static_cast<double>(hash64(name) >> 16); }

}  // namespace

std::vector<std::string> error_metric_names() {
    std::vector<std::string> names;
    for (const Against& against : kReferences) {
        for (const ErrorMetric& metric : error_metrics()) {
            if (metric.is_error) names.push_back(name_of(against, metric));
        }
    }
    return names;
}

double error_of(const ReportRow& row, const std::string& name) {
    for (const Against& against : kReferences) {
        for (const ErrorMetric& metric : error_metrics()) {
            if (metric.is_error && name == name_of(against, metric))
                return *metric.value(row.*against.errors);
        }
    }
    throw UsageError(fmt::format("unknown error metric '{}'", name));
}

bool is_candidate(const ReportSetting& setting, const ErrorBudget& budget) {
    if (setting.axis == SettingAxis::shadows) {
        return budget.chooses_shadows && setting.settings.shadows != Shadows::off;
    }
    return keeps_ranges(setting.axis) || budget.metric.starts_with("r3-");
}

BudgetChoice choose_within(std::span<const ReportRow> rows, const ErrorBudget& budget) {
    const ReportRow* fastest = nullptr;
    const ReportRow* best = nullptr;
    for (const ReportRow& row : rows) {
        if (!is_candidate(row.setting, budget)) continue;
        const double error = error_of(row, budget.metric);
        if (!best || error < error_of(*best, budget.metric)) best = &row;
        if (!(error <= budget.max_error)) continue;
        if (!fastest || row.speed.relative < fastest->speed.relative) fastest = &row;
    }
    if (!best) throw Error("max error: no setting to choose from");
    if (!fastest) {
        throw Error(
            fmt::format("max error: no setting is within {} {:.4g}; the best reachable is {:.4g} "
                        "at {}x{} pixels by '{}'",
                        budget.metric, budget.max_error, error_of(*best, budget.metric),
                        best->picture.width, best->picture.height, best->setting.name));
    }
    return {fastest->setting.name,
            fastest->setting.settings,
            error_of(*fastest, budget.metric),
            fastest->speed.relative,
            {fastest->picture.width, fastest->picture.height}};
}

std::optional<BudgetChoice> stored_choice(const DeviceInfo& device, const BudgetKey& key,
                                          const std::vector<ReportSetting>& candidates) {
    const std::string kind = kind_name(key);
    const auto values = read_device_cache(device, {kind, kVersion});
    if (!values) return std::nullopt;
    const auto value = [&](const char* name) {
        const auto found = values->find(name);
        return found == values->end() ? std::nan("") : found->second;
    };
    for (const ReportSetting& setting : candidates) {
        if (value("setting") != name_number(setting.name)) continue;
        const double width = value("error_width"), height = value("error_height");
        BudgetChoice choice{setting.name, setting.settings, value("error"), value("relative"), {}};
        if (!(choice.error >= 0.0 && choice.relative > 0.0 && width >= 1.0 && height >= 1.0)) {
            return std::nullopt;
        }
        choice.error_size = {static_cast<int>(width), static_cast<int>(height)};
        return choice;
    }
    return std::nullopt;
}

void store_choice(const DeviceInfo& device, const BudgetKey& key, const BudgetChoice& choice) {
    const std::string kind = kind_name(key);
    write_device_cache(device, {kind, kVersion},
                       {{"setting", name_number(choice.name)},
                        {"error", choice.error},
                        {"relative", choice.relative},
                        {"error_width", choice.error_size[0]},
                        {"error_height", choice.error_size[1]}});
}

}  // namespace kilolux
