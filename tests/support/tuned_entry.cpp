// SPDX-License-Identifier: Apache-2.0
// An entry of the label `tuning` whose tuning this device has without being told repeats the
// entries of the label `render`: it is skipped.
#include <gtest/gtest.h>

#include <cstdlib>

#include "host/gpu/tuning/tuning_store.h"
#include "tests/support/environment_variable.h"

namespace kilolux {
namespace {

class TunedEntry : public testing::Environment {
 public:
    void SetUp() override {
        if (std::getenv("KILOLUX_SHIPPED_TUNING") == nullptr) return;
        const DeviceInfo device = describe(choose_device(""));
        const StoredTuning asked = known_tuning(device);
        const EnvironmentVariable none("KILOLUX_SHIPPED_TUNING", std::nullopt);
        const StoredTuning own = known_tuning(device);
        if (asked == own) GTEST_SKIP() << "this device has that tuning anyway";
    }
};

[[maybe_unused]] const auto* const tuned_entry =
    testing::AddGlobalTestEnvironment(new TunedEntry);  // which Google Test deletes

}  // namespace
}  // namespace kilolux
