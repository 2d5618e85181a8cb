// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/row_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "host/base/atomic_write.h"
#include "host/base/error.h"

namespace kilolux {

BenchLog::BenchLog(std::filesystem::path file, bool resume) : file_(std::move(file)) {
    if (!resume || !std::filesystem::exists(file_)) return;
    std::ifstream in(file_, std::ios::binary);
    if (!in) throw Error(fmt::format("{}: cannot read", file_.string()));
    std::string text(std::istreambuf_iterator<char>(in), {});
    // A copy may have been cut off within a line or a point.
    text.erase(text.rfind('\n') + 1);
    try {
        rows_ = bench_rows(parse_csv(text));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file_.string(), error.what()));
    }
    while (!rows_.empty() && rows_.back().stage != kFrameStage) rows_.pop_back();
}

std::vector<BenchRow> BenchLog::rows_of(const SweepPoint& point) const {
    std::vector<BenchRow> rows;
    std::copy_if(rows_.begin(), rows_.end(), std::back_inserter(rows),
                 [&](const BenchRow& row) { return row.point == point; });
    return rows;
}

void BenchLog::append(const std::vector<BenchRow>& rows) {
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    write_atomically(file_, to_csv(bench_table(rows_)));
}

}  // namespace kilolux
