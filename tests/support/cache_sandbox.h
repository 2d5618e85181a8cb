// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace kilolux {

/// A test with a cache folder of its own, and the environment as it was afterwards.
class CacheSandbox : public testing::Test {
 protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "kilolux-cache-XXXXXX";
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr) << pattern;
        folder_ = pattern;
        set("XDG_CACHE_HOME", pattern.c_str());
    }
    void TearDown() override {
        for (const auto& [name, value] : before_) {
            if (value) {
                ::setenv(name.c_str(), value->c_str(), 1);
            } else {
                ::unsetenv(name.c_str());
            }
        }
        std::filesystem::remove_all(folder_);
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

    const std::filesystem::path& folder() const { return folder_; }

 private:
    std::filesystem::path folder_;
    std::map<std::string, std::optional<std::string>> before_;
};

}  // namespace kilolux
