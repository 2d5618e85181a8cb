// SPDX-License-Identifier: Apache-2.0
// Cache entries that somebody else could have written are ignored and replaced.
#include "host/gpu/tuning/device_cache.h"

#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/cache_sandbox.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr CacheKind kKind = {"test", 3};

DeviceInfo cached_device() {
    DeviceInfo info;
    info.name = "a device";
    info.driver = "1.0";
    return info;
}

const CacheValues& values() {
    static const CacheValues numbers = {{"first", 1.0 / 3.0}, {"second", -5e-300}, {"third", 7.0}};
    return numbers;
}

class DeviceCacheOwner : public CacheSandbox {
 protected:
    void SetUp() override {
        CacheSandbox::SetUp();
        write_device_cache(cached_device(), kKind, values());
        file_ = device_cache_file(cached_device(), kKind);
        ASSERT_EQ(read_device_cache(cached_device(), kKind), values());
    }
    void expect_unused_and_made_anew(const std::string& what) {
        EXPECT_FALSE(read_device_cache(cached_device(), kKind)) << what;
        write_device_cache(cached_device(), kKind, values());
        EXPECT_EQ(read_device_cache(cached_device(), kKind), values()) << what;
    }
    fs::path file_;
};

TEST_F(DeviceCacheOwner, OnlyTheUsersOwnFilesAreRead) {
    struct stat status = {};
    ASSERT_EQ(stat(file_.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u);
    ASSERT_EQ(stat(file_.parent_path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700u);
    ASSERT_EQ(chmod(file_.c_str(), 0622), 0);
    expect_unused_and_made_anew("others may write it");
    if (geteuid() == 0) {
        ASSERT_EQ(chown(file_.c_str(), 65534, 65534), 0);
        expect_unused_and_made_anew("another user's");
    }
    const fs::path elsewhere = folder() / "elsewhere";
    fs::rename(file_, elsewhere);
    fs::create_symlink(elsewhere, file_);
    expect_unused_and_made_anew("a link");
    EXPECT_FALSE(fs::is_symlink(file_));
    fs::remove(file_);
    ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
    expect_unused_and_made_anew("a pipe");
    fs::remove(file_);
    fs::create_directory(file_);
    EXPECT_FALSE(read_device_cache(cached_device(), kKind));
}

}  // namespace
}  // namespace kilolux
