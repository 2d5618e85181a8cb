// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

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

/// Where a tuning comes from; of these, the first that there is.
enum class TuningSource { measured, shipped_for_device, shipped_for_class, built_in };

/// A tuning and where it comes from.
struct KnownTuning : StoredTuning {
    TuningSource source = TuningSource::built_in;
};

/// The best known tuning of a device: what was measured here, else what this program ships for the
/// device or its class, else the built-in table's.
KnownTuning known_tuning(const DeviceInfo& device);

/// "measured here", "shipped for this device", "shipped for its class", "built in".
std::string text_of(TuningSource source);

/// Keeps the winner in the user's cache folder. Throws Error when that cannot be written.
void store_tuning(const DeviceInfo& device, const StoredTuning& tuning);

}  // namespace kilolux
