// SPDX-License-Identifier: Apache-2.0
#include "present/cli/array_task.h"

#include <fmt/format.h>

#include <cstdlib>
#include <limits>
#include <vector>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/text.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

bool is_set(const char* variable) {
    const char* text = std::getenv(variable);
    return text != nullptr && *text != '\0';
}

const ArrayVariables& variables_of_task(const std::string& option) {
    const ArrayVariables* found = nullptr;
    std::vector<std::string> names;
    for (const ArrayVariables& row : kArrayVariables) {
        names.emplace_back(row.index);
        if (!is_set(row.index)) continue;
        // A task that starts others hands its variables down: all would take its shard.
        if (found != nullptr) {
            throw UsageError(fmt::format("{} auto: both {} and {} are set; name the shard as I/N",
                                         option, found->index, row.index));
        }
        found = &row;
    }
    if (found != nullptr) return *found;
    throw UsageError(fmt::format("{} auto: the environment has none of {}; name the shard as I/N",
                                 option, joined(names)));
}

// A whole number of the environment.
int number_in(const std::string& option, const char* variable) {
    const char* text = std::getenv(variable);
    if (!is_set(variable)) {
        throw UsageError(fmt::format("{} auto: the environment lacks {}", option, variable));
    }
    const auto number = count_of(text);
    if (number && *number <= std::numeric_limits<int>::max()) return static_cast<int>(*number);
    throw UsageError(
        fmt::format("{} auto: {} is '{}', no whole number from 0 on", option, variable, text));
}

// Of `count` tasks with indices from `first` on.
Shard checked_shard(const std::string& option, const ArrayVariables& row, std::int64_t place,
                    int count, int first) {
    if (place >= 0 && place < count) return {static_cast<int>(place), count, row.index};
    throw UsageError(fmt::format("{} auto: {} is {}, which is none of {} tasks from {} on", option,
                                 row.index, std::getenv(row.index), count, first));
}

}  // namespace

std::string shard_meaning(const std::string& parts) {
    std::vector<std::string> names;
    for (const ArrayVariables& row : kArrayVariables) names.emplace_back(row.scheduler);
    return fmt::format(
        "Every N-th {} from the I-th on, counted from 0. auto takes I and N from the variables of "
        "{}; auto/N takes only I",
        parts, joined(names));
}

void note_shard(const Shard& shard) {
    if (!shard.variable.empty())
        note(fmt::format("shard {} by {}", text_of(shard), shard.variable));
}

Shard shard_of_task(const std::string& option) {
    const ArrayVariables& row = variables_of_task(option);
    if (row.count == nullptr) {
        throw UsageError(
            fmt::format("{} auto: {} does not tell how many tasks there are; write auto/N", option,
                        row.scheduler));
    }
    const int count = number_in(option, row.count);
    const int first = row.first == nullptr ? row.base : number_in(option, row.first);
    const int step = row.step == nullptr ? 1 : number_in(option, row.step);
    const std::int64_t place = std::int64_t{number_in(option, row.index)} - first;
    if (step < 1 || place % step != 0) {
        throw UsageError(fmt::format("{} auto: {}'s array is no range of indices; write auto/N",
                                     option, row.scheduler));
    }
    return checked_shard(option, row, place / step, count, first);
}

Shard shard_of_task(const std::string& option, int count) {
    const ArrayVariables& row = variables_of_task(option);
    const std::int64_t place = std::int64_t{number_in(option, row.index)} - row.base;
    return checked_shard(option, row, place, count, row.base);
}

}  // namespace kilolux
