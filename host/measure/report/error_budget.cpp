// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/error_budget.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "host/base/error.h"
#include "host/gpu/device_cache.h"

namespace kilolux {
namespace {

struct Metric {
    const char* name;
    double (*value)(const PictureErrors& errors);
};

constexpr Metric kMetrics[] = {
    {"flip", [](const PictureErrors& e) { return e.flip.mean; }},
    {"ldr-flip", [](const PictureErrors& e) { return e.flip_display.mean; }},
    {"rmse", [](const PictureErrors& e) { return e.hdr.rmse; }},
    {"max", [](const PictureErrors& e) { return e.hdr.absolute.max; }},
    {"max-relative", [](const PictureErrors& e) { return e.hdr.relative.max; }},
    {"relmse", [](const PictureErrors& e) { return e.hdr.rel_mse; }},
    {"codes", [](const PictureErrors& e) { return e.codes.difference.max; }},
};

struct Against {
    const char* prefix;
    PictureErrors ReportRow::*errors;
};

constexpr Against kReferences[] = {
    {"", &ReportRow::surfaces}, {"r1-", &ReportRow::kernels}, {"r3-", &ReportRow::unbounded}};

std::string number(double value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                      std::chars_format::general, 4);
    return {buffer.data(), result.ptr};
}

// Kinds of cache entries are names of files: a hash of the key (FNV-1a) that the name holds.
std::string kind_name(const BudgetKey& key) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : key) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    std::array<char, 17> text{};
    const auto end = std::to_chars(text.data(), text.data() + 16, hash, 16);
    return "choice-" + std::string(text.data(), end.ptr);
}

// The settings that a choice changes, as numbers; 48 bits of the setting's name tell it again.
double name_number(const std::string& name) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return static_cast<double>(hash >> 16);
}

constexpr int kVersion = 1;

}  // namespace

std::vector<std::string> error_metric_names() {
    std::vector<std::string> names;
    for (const Against& against : kReferences) {
        for (const Metric& metric : kMetrics) {
            names.push_back(std::string(against.prefix) + metric.name);
        }
    }
    return names;
}

double error_of(const ReportRow& row, const std::string& metric) {
    for (const Against& against : kReferences) {
        for (const Metric& known : kMetrics) {
            if (metric == std::string(against.prefix) + known.name) {
                return known.value(row.*against.errors);
            }
        }
    }
    throw UsageError("'" + metric + "' is no error metric");
}

bool is_candidate(const ReportSetting& setting, const ErrorBudget& budget) {
    return setting.trade != Trade::cut_off || budget.metric.starts_with("r3-");
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
        throw Error("max error: no setting is within " + budget.metric + " " +
                    number(budget.max_error) + "; the best reachable is " +
                    number(error_of(*best, budget.metric)) + " by '" + best->setting.name + "'");
    }
    return {fastest->setting.name, fastest->setting.settings, error_of(*fastest, budget.metric),
            fastest->speed.relative};
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
        const BudgetChoice choice{setting.name, setting.settings, value("error"),
                                  value("relative")};
        if (choice.error >= 0.0 && choice.relative > 0.0) return choice;
    }
    return std::nullopt;
}

void store_choice(const DeviceInfo& device, const BudgetKey& key, const BudgetChoice& choice) {
    const std::string kind = kind_name(key);
    write_device_cache(device, {kind, kVersion},
                       {{"setting", name_number(choice.name)},
                        {"error", choice.error},
                        {"relative", choice.relative}});
}

}  // namespace kilolux
