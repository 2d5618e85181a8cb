// SPDX-License-Identifier: Apache-2.0
#include "host/certify/findings.h"

#include <fmt/format.h>

#include <algorithm>

namespace kilolux {

void Findings::at_most(std::string_view what, const Worst& worst, double limit) {
    const auto found = std::ranges::find(findings_, what, &Finding::what);
    if (found == findings_.end()) {
        findings_.push_back({worst, std::string(what), limit});
        return;
    }
    found->checked += worst.checked;
    // Limits may differ from one use to the next.
    const auto share = [](double value, double of) { return value > 0.0 ? value / of : 0.0; };
    if (share(worst.value, limit) <= share(found->value, found->limit)) return;
    found->value = worst.value;
    found->where = worst.where;
    found->limit = limit;
}

void Findings::at_most(std::string_view what, double value, double limit, std::string_view where) {
    Worst worst;
    worst.add(value, [&] { return std::string(where); });
    at_most(what, worst, limit);
}

void Findings::none(std::string_view what, std::uint64_t count, std::uint64_t of,
                    std::string_view where) {
    at_most(what, Worst{static_cast<double>(count), of, std::string(where)}, 0.0);
}

void Findings::require(std::string_view what, bool holds, std::string_view where) {
    none(what, holds ? 0 : 1, 1, where);
}

void Findings::report(std::string_view what, double value) {
    at_most(what, value, std::numeric_limits<double>::infinity());
}

void Findings::at_least(std::string_view what, std::uint64_t count, std::uint64_t least) {
    if (count >= least) return;
    none(fmt::format("too few {}", what), least - count, least,
         fmt::format("{} of {}", count, least));
}

void Findings::merge(const Findings& other) {
    for (const Finding& f : other.findings_) at_most(f.what, f, f.limit);
}

bool Findings::passed() const {
    return !findings_.empty() && std::ranges::all_of(findings_, &Finding::passed);
}

}  // namespace kilolux
