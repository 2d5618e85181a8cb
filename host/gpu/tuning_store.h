// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "host/gpu/device.h"
#include "host/gpu/features.h"

namespace kilolux {

/// A tuning with the lane width that it was measured with.
struct StoredTuning {
    int lanes = 1;  // VW: 1, 2, 4, 8, 16
    Tuning tuning;
    bool operator==(const StoredTuning&) const = default;
};

/// The values of a Tuning by name.
struct TuningParameter {
    const char* name;
    int Tuning::*value;
};
std::span<const TuningParameter> tuning_parameters();

/// Whether every value is one that the kernels accept on the device: powers of two where they must
/// be, groups that the device launches.
bool is_valid(const StoredTuning& tuning, const DeviceInfo& device);

/// The built-in table's row for the device, as describe() gives it.
StoredTuning built_in_tuning(const DeviceInfo& device);

/// What `kilolux bench --tune` found for this device and driver; none if it never ran, or if the
/// entry is damaged or no longer valid.
std::optional<StoredTuning> stored_tuning(const DeviceInfo& device);

/// Keeps the winner in the user's cache folder. Throws Error when that cannot be written.
void store_tuning(const DeviceInfo& device, const StoredTuning& tuning);

}  // namespace kilolux
