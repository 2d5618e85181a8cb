// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "host/base/temporary_folder.h"

namespace kilolux {

/// A test with a cache folder of its own; it restores the environment afterwards.
class CacheSandbox : public testing::Test {
 protected:
    void SetUp() override { set("XDG_CACHE_HOME", folder_.path().c_str()); }
    void TearDown() override {
        for (const auto& [name, value] : before_) {
            if (value) {
                ::setenv(name.c_str(), value->c_str(), 1);
            } else {
                ::unsetenv(name.c_str());
            }
        }
    }

    /// Sets or, with null, unsets an environment variable for this test.
    void set(const char* name, const char* value) {
        const char* old = std::getenv(name);
        before_.try_emplace(name, old ? std::optional<std::string>(old) : std::nullopt);
        if (value) {
            ::setenv(name, value, 1);
        } else {
            ::unsetenv(name);
        }
    }

    const std::filesystem::path& folder() const { return folder_.path(); }

 private:
    TemporaryFolder folder_;
    std::map<std::string, std::optional<std::string>> before_;
};

}  // namespace kilolux
