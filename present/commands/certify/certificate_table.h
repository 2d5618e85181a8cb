// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gpu/device.h"

namespace kilolux {

/// A row for each certificate: code, driver, failures, time of a frame. Then the failures, each
/// with its worst value. Throws Error for a file that is no certificate.
std::string certificates_text(const std::vector<std::string>& files);

}  // namespace kilolux
