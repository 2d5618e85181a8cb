// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace kilolux {

/// The devices of --device by index: of "all", or of several indices with commas between. Any other
/// text is returned alone, for choose_device(). Pictures of devices that differ in name, platform
/// or driver may differ: unless `mixed`, "all" are those like the best one, with a note of the
/// others, and indices of such devices throw UsageError. An index may stand several times: that
/// device makes as many frames at once.
std::vector<std::string> devices_of(const std::string& choice, bool mixed);

}  // namespace kilolux
