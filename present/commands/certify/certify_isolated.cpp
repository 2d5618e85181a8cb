// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify/certify_isolated.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <utility>

#include "host/base/system/child_process.h"
#include "host/base/system/interrupt.h"
#include "host/base/system/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The output of `kilolux certify` with these words; or how it ended, if it wrote nothing.
struct Outcome {
    Json certificate;
    std::string error;
};

Outcome run_program(const std::string& device, std::vector<std::string> more) {
    const TemporaryFolder scratch;
    const fs::path file = scratch / "result.json";
    std::vector<std::string> words = {"timeout", "--foreground", fmt::to_string(kIsolatedSeconds),
                                      fs::read_symlink("/proc/self/exe").string(), "certify"};
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"--quiet", "-o", file.string()});
    if (!device.empty()) words.insert(words.end(), {"--device", device});
    ChildProcess child(words);
    child.succeeded();
    check_interrupt();
    std::ifstream in(file);
    const Json found = Json::parse(in, nullptr, false);
    if (!found.is_discarded()) return {found, ""};
    constexpr int kTimedOut = 124;  // as timeout(1) says
    std::string error = child.ending() == fmt::format("exit code {}", kTimedOut)
                            ? fmt::format("the process took longer than {} s", kIsolatedSeconds)
                            : "the process ended with " + child.ending();
    const std::vector<std::string> messages = child.messages();
    if (!messages.empty()) error += ": " + messages.back();
    return {Json(), error};
}

// One process: a case at a lane width.
struct CaseRun {
    std::size_t row;  // in IsolatedRequest::cases
    int lanes;
    std::optional<HardCaseRow> found{};  // once it is done
};

HardCaseRow run_case(const IsolatedRequest& request, const CaseRun& run) {
    const HardCase& hard_case = request.cases[run.row];
    const Outcome outcome = run_program(request.device, {"--case", std::string(hard_case.label),
                                                         "--lanes", fmt::to_string(run.lanes)});
    if (outcome.error.empty()) return rows_of_json(outcome.certificate).at(0);
    const std::string error = fmt::format("{} lanes: {}", run.lanes, outcome.error);
    return {hard_case, {run.lanes}, {}, error};
}

Json part_of(const std::string& device, const std::string& name) {
    const Outcome outcome = run_program(device, {"--case", "none", "--with", name});
    if (!outcome.error.empty()) return {{"passed", false}, {"error", outcome.error}};
    return outcome.certificate.at(name);
}

// The row of a case among those found, without an error; null if there is none.
const HardCaseRow* found_row(const Certificate& found, const HardCase& hard_case) {
    const auto row = std::ranges::find_if(found.rows, [&](const HardCaseRow& r) {
        return r.hard_case.label == hard_case.label && r.error.empty();
    });
    return row == found.rows.end() ? nullptr : &*row;
}

std::vector<CaseRun> runs_left(const IsolatedRequest& request, const Certificate& found) {
    std::vector<CaseRun> runs;
    for (std::size_t i = 0; i < request.cases.size(); ++i) {
        const HardCaseRow* row = found_row(found, request.cases[i]);
        for (const int lanes : request.lanes) {
            const bool is_done = row != nullptr && std::ranges::count(row->lanes, lanes) > 0;
            if (!is_done) runs.push_back({i, lanes});
        }
    }
    return runs;
}

// What was found before and by the runs that are done.
std::vector<HardCaseRow> rows_of(const IsolatedRequest& request, const Certificate& found,
                                 const std::vector<CaseRun>& runs) {
    std::vector<HardCaseRow> rows;
    for (const HardCase& hard_case : request.cases) {
        const HardCaseRow* row = found_row(found, hard_case);
        rows.push_back(row != nullptr ? *row : HardCaseRow{hard_case, {}, {}, {}});
    }
    for (const CaseRun& run : runs) {
        if (!run.found) continue;
        HardCaseRow& row = rows[run.row];
        row.lanes.push_back(run.lanes);
        row.findings.merge(run.found->findings);
        if (!run.found->error.empty()) row.error = run.found->error;
    }
    for (HardCaseRow& row : rows) {
        std::ranges::sort(row.lanes, {}, [&](int lanes) {
            return std::ranges::find(request.lanes, lanes) - request.lanes.begin();
        });
    }
    return rows;
}

}  // namespace

Certificate certify_isolated(const IsolatedRequest& request, const Certificate& found,
                             const OnIsolated& on_done) {
    std::vector<CaseRun> runs = runs_left(request, found);
    std::size_t left = runs.size() + request.parts.size();
    Certificate out{rows_of(request, found, runs)};
    std::mutex mutex;
    const auto take = [&](std::size_t i) {
        HardCaseRow row = run_case(request, runs[i]);
        const std::scoped_lock lock(mutex);
        runs[i].found = std::move(row);
        out.rows = rows_of(request, found, runs);
        on_done(out, --left);
    };
    tbb::task_arena(request.processes).execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, runs.size(), 1),
            [&](const auto& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) take(i);
            },
            tbb::simple_partitioner{});
    });
    for (const CertificatePart& part : request.parts) {
        const bool is_done =
            found.parts.contains(part.name) && !found.parts.at(part.name).contains("error");
        out.parts[part.name] =
            is_done ? found.parts.at(part.name) : part_of(request.device, part.name);
        on_done(out, --left);
    }
    return out;
}

}  // namespace kilolux
