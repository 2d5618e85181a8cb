// SPDX-License-Identifier: Apache-2.0
#pragma once

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
};

/// Runs this program for every case at every lane width, and for every part. A process that a
/// signal ends, or that takes longer than kIsolatedSeconds, fails its case with that as the error.
/// Calls `step` after each and passes its exceptions on.
Certificate certify_isolated(const IsolatedRequest& request, const std::function<void()>& step);

inline constexpr int kIsolatedSeconds = 120;

}  // namespace kilolux
