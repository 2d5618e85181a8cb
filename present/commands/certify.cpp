// SPDX-License-Identifier: Apache-2.0
#include "present/commands/certify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/base/atomic_write.h"
#include "host/base/interrupt.h"
#include "present/cli/device_list.h"
#include "present/cli/progress.h"
#include "present/cli/stats_json.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json row_json(const HardCaseRow& row) {
    Json out{{"case", row.hard_case.label},  {"name", row.hard_case.name},
             {"tried", row.hard_case.tried}, {"threshold", row.hard_case.threshold},
             {"lanes", row.lanes},           {"passed", row.passed}};
    if (!row.error.empty()) out["error"] = row.error;
    out["findings"] = Json::array();
    for (const Finding& f : row.findings) {
        out["findings"].push_back({{"what", f.what},
                                   {"worst", finite_or_null(f.worst)},
                                   {"limit", finite_or_null(f.limit)},
                                   {"checked", f.checked},
                                   {"where", f.where}});
    }
    return out;
}

bool all_passed(const std::vector<HardCaseRow>& rows) {
    return std::all_of(rows.begin(), rows.end(), [](const HardCaseRow& row) { return row.passed; });
}

std::vector<HardCaseRow> run_with_progress(const HardCaseOptions& options, const Gpu& gpu) {
    const std::size_t cases = options.only.empty() ? hard_cases().size() : options.only.size();
    Progress progress("hard cases", cases * options.lanes.size(), !options.quiet);
    return run_hard_cases(gpu, options.lanes, options.only, [&] {
        progress.advance();
        check_interrupt();
    });
}

}  // namespace

Json hard_cases_json(const DeviceInfo& device, const std::vector<HardCaseRow>& rows) {
    Json out{{"device", device_json(device)}, {"passed", all_passed(rows)}};
    out["cases"] = Json::array();
    for (const HardCaseRow& row : rows) out["cases"].push_back(row_json(row));
    return out;
}

bool report_hard_cases(const HardCaseOptions& options) {
    const Gpu gpu(choose_device(options.device));
    const std::vector<HardCaseRow> rows = run_with_progress(options, gpu);
    const Table table = hard_case_table(rows);
    const Json json = hard_cases_json(gpu.info, rows);
    if (!options.output.empty()) {
        std::filesystem::create_directories(options.output);
        write_whole_file(options.output / "hard_cases.csv", to_csv(table));
        write_whole_file(options.output / "hard_cases.md", to_markdown(table));
        write_json((options.output / "hard_cases.json").string(), json);
    }
    if (options.json) {
        write_json("-", json);
    } else {
        std::fputs(to_markdown(table).c_str(), stdout);
    }
    return all_passed(rows);
}

}  // namespace kilolux
