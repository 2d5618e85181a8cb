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
#include "present/commands/certify/certify_json.h"

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
    std::size_t place;  // in IsolatedRequest::cases
    int lanes;
};

HardCaseRow run_case(const IsolatedRequest& request, const CaseRun& run) {
    const HardCase& hard_case = request.cases[run.place];
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

// The row of a case; null if there is none.
HardCaseRow* row_of(Certificate& certificate, const HardCase& hard_case) {
    const auto row = std::ranges::find_if(certificate.rows, [&](const HardCaseRow& r) {
        return r.hard_case.label == hard_case.label;
    });
    return row == certificate.rows.end() ? nullptr : &*row;
}

// What was found before, and a row for each case. A case that could not run is begun anew where all
// of its lane widths are asked for.
Certificate begun(const IsolatedRequest& request, Certificate found) {
    std::erase_if(found.rows, [&](const HardCaseRow& row) {
        const auto& label = row.hard_case.label;
        const bool is_asked = std::ranges::count(request.cases, label, &HardCase::label) > 0;
        return !row.error.empty() && is_asked && std::ranges::all_of(row.lanes, [&](int lanes) {
            return std::ranges::count(request.lanes, lanes) > 0;
        });
    });
    for (const HardCase& hard_case : request.cases) {
        if (row_of(found, hard_case) == nullptr) found.rows.push_back({hard_case, {}, {}, {}});
    }
    std::ranges::sort(found.rows, {}, [](const HardCaseRow& row) {
        return std::ranges::find(hard_cases(), row.hard_case.label, &HardCase::label) -
               hard_cases().begin();
    });
    return found;
}

std::vector<CaseRun> runs_left(const IsolatedRequest& request, Certificate& found) {
    std::vector<CaseRun> runs;
    for (std::size_t i = 0; i < request.cases.size(); ++i) {
        const std::vector<int>& done = row_of(found, request.cases[i])->lanes;
        for (const int lanes : request.lanes) {
            if (std::ranges::count(done, lanes) == 0) runs.push_back({i, lanes});
        }
    }
    return runs;
}

void add(HardCaseRow& row, const HardCaseRow& found) {
    row.lanes.insert(row.lanes.end(), found.lanes.begin(), found.lanes.end());
    std::ranges::sort(row.lanes);
    row.findings.merge(found.findings);
    if (row.error.empty()) row.error = found.error;
}

// What was found before and by the runs that are done, in the order of the runs.
Certificate with_runs(Certificate found, const std::vector<std::optional<HardCaseRow>>& done) {
    for (const std::optional<HardCaseRow>& row : done) {
        if (row) add(*row_of(found, row->hard_case), *row);
    }
    return found;
}

}  // namespace

Certificate certify_isolated(const IsolatedRequest& request, const Certificate& found,
                             const OnIsolated& on_begin, const OnIsolated& on_done) {
    Certificate start = begun(request, found);
    const std::vector<CaseRun> runs = runs_left(request, start);
    std::vector<std::optional<HardCaseRow>> done(runs.size());
    std::size_t left = runs.size() + request.parts.size();
    on_begin(start, left);
    std::mutex mutex;
    const auto run = [&](std::size_t i) {
        HardCaseRow row = run_case(request, runs[i]);
        const std::scoped_lock lock(mutex);
        done[i] = std::move(row);
        on_done(with_runs(start, done), --left);
    };
    tbb::task_arena(request.processes).execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, runs.size(), 1),
            [&](const auto& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) run(i);
            },
            tbb::simple_partitioner{});
    });
    Certificate out = with_runs(std::move(start), done);
    for (const CertificatePart& part : request.parts) {
        const bool is_done =
            out.parts.contains(part.name) && !out.parts.at(part.name).contains("error");
        if (!is_done) out.parts[part.name] = part_of(request.device, part.name);
        on_done(out, --left);
    }
    return out;
}

}  // namespace kilolux
