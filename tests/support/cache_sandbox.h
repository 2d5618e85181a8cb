// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <filesystem>

#include "host/base/system/temporary_folder.h"
#include "tests/support/environment_variable.h"

namespace kilolux {

/// A test with a cache folder of its own; it restores the environment afterwards.
class CacheSandbox : public testing::Test {
 protected:
    void SetUp() override { set("XDG_CACHE_HOME", folder_.path().c_str()); }
    void TearDown() override {
        while (!set_.empty()) set_.pop_back();  // the latest first
    }

    /// Sets or, with null, unsets an environment variable for this test.
    void set(const char* name, const char* value) {
        set_.emplace_back(name, value ? std::optional<std::string>(value) : std::nullopt);
    }

    const std::filesystem::path& folder() const { return folder_.path(); }

 private:
    TemporaryFolder folder_;
    std::deque<EnvironmentVariable> set_;
};

/// A test of how a tuning is chosen: none is measured here, and none is forced.
class TuningSandbox : public CacheSandbox {
 protected:
    void SetUp() override {
        CacheSandbox::SetUp();
        set("KILOLUX_SHIPPED_TUNING", nullptr);
    }
};

}  // namespace kilolux
