// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "present/commands/certify/certificate.h"
#include "present/commands/certify/certify.h"

namespace kilolux {

/// The cases and parts that separate processes run.
struct IsolatedRequest {
    std::string device;  // as --device has it
    std::vector<HardCase> cases;
    std::vector<int> lanes;
    std::vector<CertificatePart> parts;
    int processes = 1;  // at once, at most oneTBB's threads; parts run alone, after all cases
};

/// The results so far, and how many processes are still to end.
using OnIsolated = std::function<void(const Certificate& found, std::size_t left)>;

/// Runs this program for every case at every lane width, and for every part, but for those that
/// `found` has without an error; what else `found` has stays. A process that a signal ends, or that
/// takes longer than kIsolatedSeconds, fails its case with that as the error. Calls `on_begin`
/// first, and `on_done` after each process, one call at a time, and passes their exceptions on. The
/// rows are in the order of hard_cases(), their lane widths ascend.
Certificate certify_isolated(const IsolatedRequest& request, const Certificate& found,
                             const OnIsolated& on_begin, const OnIsolated& on_done);

/// A GPU's compiler takes more than 300 s for the kernels of area lights with 16 lanes.
inline constexpr int kIsolatedSeconds = 1200;

}  // namespace kilolux
