// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/tuning/tuning_store.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "host/base/error.h"
#include "host/base/version.h"
#include "host/gpu/tuning/device_cache.h"
#include "tests/measure/test_device.h"
#include "tests/support/cache_sandbox.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr CacheKind kTuningKind = {"numbers", 1};
const CacheValues kValues = {{"big", 4.75e11}, {"exact", 0.1}, {"small", 2.2e-4}, {"whole", 16.0}};

void overwrite(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

using DeviceCache = CacheSandbox;
using TuningStore = TuningSandbox;

TEST_F(DeviceCache, FollowsTheEnvironment) {
    set("XDG_CACHE_HOME", "/somewhere");
    EXPECT_EQ(cache_folder(), fs::path("/somewhere/kilolux"));
    set("XDG_CACHE_HOME", "relative");
    set("HOME", "/home/me");
    EXPECT_EQ(cache_folder(), fs::path("/home/me/.cache/kilolux"));
    set("XDG_CACHE_HOME", nullptr);
    EXPECT_EQ(cache_folder(), fs::path("/home/me/.cache/kilolux"));
    set("HOME", nullptr);
    EXPECT_TRUE(cache_folder().empty());
    EXPECT_FALSE(read_device_cache(device_named("a"), kTuningKind));
    EXPECT_THROW(write_device_cache(device_named("a"), kTuningKind, kValues), Error);
}

TEST_F(DeviceCache, ReturnsTheSameNumbers) {
    const DeviceInfo device = device_named("a");
    EXPECT_FALSE(read_device_cache(device, kTuningKind));
    write_device_cache(device, kTuningKind, kValues);
    EXPECT_EQ(read_device_cache(device, kTuningKind), kValues);
    write_device_cache(device, kTuningKind, {});
    EXPECT_EQ(read_device_cache(device, kTuningKind), CacheValues());
}

TEST_F(DeviceCache, IsForItsOwnerOnlyAndLeavesNothingElse) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    write_device_cache(device, kTuningKind, kValues);
    struct stat status {};
    ASSERT_EQ(::stat(device_cache_file(device, kTuningKind).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0600u);
    ASSERT_EQ(::stat(cache_folder().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0700u);
    const auto files =
        std::distance(fs::directory_iterator(cache_folder()), fs::directory_iterator());
    EXPECT_EQ(files, 1);
}

TEST_F(DeviceCache, TellsDevicesDriversKindsAndVersionsApart) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    EXPECT_FALSE(read_device_cache(device_named("b"), kTuningKind));
    DeviceInfo updated = device;
    updated.driver = "1.2.4";
    EXPECT_FALSE(read_device_cache(updated, kTuningKind));
    EXPECT_FALSE(read_device_cache(device, {"other", 1}));
    EXPECT_FALSE(read_device_cache(device, {kTuningKind.name, 2}));
    // Another device's entry under this one's name, as a collision or a copied folder would leave
    // it.
    fs::copy_file(device_cache_file(device, kTuningKind),
                  device_cache_file(device_named("b"), kTuningKind));
    EXPECT_FALSE(read_device_cache(device_named("b"), kTuningKind));
}

TEST_F(DeviceCache, NamesTheProgramThatWroteIt) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    const std::string text = text_of_file(device_cache_file(device, kTuningKind));
    EXPECT_NE(text.find("\nprogram " + version() + "\n"), std::string::npos) << text;
}

TEST_F(DeviceCache, IgnoresEveryTruncation) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    const fs::path file = device_cache_file(device, kTuningKind);
    const std::string whole = text_of_file(file);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        overwrite(file, whole.substr(0, length));
        ASSERT_FALSE(read_device_cache(device, kTuningKind)) << "length " << length;
    }
    overwrite(file, whole);
    EXPECT_TRUE(read_device_cache(device, kTuningKind));
}

TEST_F(DeviceCache, IgnoresEveryFlippedBit) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    const fs::path file = device_cache_file(device, kTuningKind);
    const std::string whole = text_of_file(file);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string harmed = whole;
        harmed[i] = static_cast<char>(harmed[i] ^ (1 << (i % 7)));
        overwrite(file, harmed);
        ASSERT_FALSE(read_device_cache(device, kTuningKind)) << "byte " << i;
    }
}

TEST_F(DeviceCache, IgnoresWhatIsNoEntry) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    const fs::path file = device_cache_file(device, kTuningKind);
    for (const std::string& text :
         {std::string("{}"), std::string(1 << 20, 'x'), std::string(100, '\0')}) {
        overwrite(file, text);
        EXPECT_FALSE(read_device_cache(device, kTuningKind)) << text.substr(0, 10);
    }
    fs::remove(file);
    fs::create_directory(file);
    EXPECT_FALSE(read_device_cache(device, kTuningKind));
    EXPECT_THROW(write_device_cache(device, kTuningKind, kValues), Error);
    const auto files =
        std::distance(fs::directory_iterator(cache_folder()), fs::directory_iterator());
    EXPECT_EQ(files, 1) << "a temporary file was left";
}

TEST_F(DeviceCache, SaysWhereItCannotWrite) {
    overwrite(folder() / "file", "");
    set("XDG_CACHE_HOME", (folder() / "file").c_str());
    try {
        write_device_cache(device_named("a"), kTuningKind, kValues);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find((folder() / "file").string()), std::string::npos)
            << error.what();
    }
}

TEST_F(TuningStore, ReturnsWhatWasStored) {
    const DeviceInfo device = device_named("a");
    EXPECT_FALSE(stored_tuning(device));
    store_tuning(device, some_tuning());
    EXPECT_EQ(stored_tuning(device), some_tuning());
    EXPECT_FALSE(stored_tuning(device_named("b")));
}

TEST_F(TuningStore, RefusesValuesThatNoKernelTakes) {
    const DeviceInfo device = device_named("a");
    const auto refused = [&](auto change) {
        StoredTuning stored = some_tuning();
        change(stored);
        store_tuning(device, stored);
        return !is_valid(stored, device) && !stored_tuning(device);
    };
    EXPECT_TRUE(refused([](StoredTuning& s) { s.lanes = 32; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.lanes = 3; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.shade_rows = 32; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.shade_rows = 0; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.shade_prefetch = 2; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.shade_stage = 3; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.cull_chunks = 0; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.cull_group = 3; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.refine_group = 8192; }))
        << "a group is at most 4096";
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.light_group = -1; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.refine_group = 512; }))
        << "its local memory";
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.tile_group = 512; })) << "its local memory";
    EXPECT_FALSE(
        refused([](StoredTuning& s) { s.tuning.refine_group = s.tuning.tile_group = 256; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.pbr_lanes = 32; }));
    EXPECT_TRUE(refused([](StoredTuning& s) { s.tuning.raster_group = 512; }));
    EXPECT_FALSE(refused([](StoredTuning&) {}));
}

TEST_F(TuningStore, RefusesAnEntryWithoutAValue) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, {"tuning", 3}, {{"lanes", 4.0}, {"shade_rows", 8.0}});
    EXPECT_FALSE(stored_tuning(device));
}

TEST_F(TuningStore, BuiltInTableIsValid) {
    DeviceInfo device = device_named("a");
    EXPECT_TRUE(is_valid(built_in_tuning(device), device));
    device.is_cpu = false;
    device.lane_width = 1;
    device.max_work_group = 1024;
    EXPECT_TRUE(is_valid(built_in_tuning(device), device));
}

TEST_F(TuningStore, BuiltInTableIsValidForSmallGroups) {
    for (const bool is_cpu : {false, true}) {
        for (const int lanes : {1, 2, 8, 16}) {
            for (const int group : {16, 48, 64, 128, 256, 1024}) {
                DeviceInfo device = device_named("a");
                device.is_cpu = is_cpu;
                device.lane_width = lanes;
                device.max_work_group = group;
                EXPECT_TRUE(is_valid(built_in_tuning(device), device))
                    << is_cpu << ", " << lanes << " lanes, groups of " << group;
            }
        }
    }
}

}  // namespace
}  // namespace kilolux
