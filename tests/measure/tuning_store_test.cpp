// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/tuning/tuning_store.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/base/error.h"
#include "host/base/version.h"
#include "host/gpu/tuning/device_cache.h"
#include "host/gpu/tuning/shipped_tunings.h"
#include "host/measure/bench/row.h"
#include "host/measure/bench/tune.h"
#include "tests/support/cache_sandbox.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr CacheKind kTuningKind = {"numbers", 1};
const CacheValues kValues = {{"big", 4.75e11}, {"exact", 0.1}, {"small", 2.2e-4}, {"whole", 16.0}};

DeviceInfo device_named(const std::string& name) {
    DeviceInfo device;
    device.name = name;
    device.version = "OpenCL 3.0";
    device.driver = "1.2.3";
    device.platform = "Test";
    device.is_cpu = true;
    device.lane_width = 8;
    device.compute_units = 2;
    device.max_work_group = 4096;
    return device;
}

StoredTuning some_tuning() {
    StoredTuning stored{4, {}};
    stored.tuning.shade_rows = 8;
    stored.tuning.cull_chunks = 24;
    stored.tuning.light_group = 64;
    return stored;
}

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

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
    const std::string text = text_of(device_cache_file(device, kTuningKind));
    EXPECT_NE(text.find("\nprogram " + version() + "\n"), std::string::npos) << text;
}

TEST_F(DeviceCache, IgnoresEveryTruncation) {
    const DeviceInfo device = device_named("a");
    write_device_cache(device, kTuningKind, kValues);
    const fs::path file = device_cache_file(device, kTuningKind);
    const std::string whole = text_of(file);
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
    const std::string whole = text_of(file);
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

class ShippedTunings : public TuningSandbox {};

const std::vector<ShippedTuning>& some_table() {
    static const std::vector<ShippedTuning> table = {
        {"Test", "b", "OpenCL 3.0", true, 2, {8, {.cull_chunks = 8, .geometry = 1}}},
        {"Test", "a", "OpenCL 3.0", true, 4, {4, {.cull_chunks = 24}}},
        {"Test GPU", "c", "OpenCL 1.2", false, 10, {2, {.cull_chunks = 40, .geometry = 1}}}};
    return table;
}

TEST_F(ShippedTunings, MatchesTheDeviceThenItsClass) {
    const auto match = [](const DeviceInfo& device) {
        return shipped_tuning(device, some_table());
    };
    const auto same = match(device_named("a"));
    ASSERT_TRUE(same);
    EXPECT_TRUE(same->same_device);
    EXPECT_EQ(same->tuning.lanes, 4);
    EXPECT_EQ(same->tuning.tuning.cull_chunks, 12) << "24 for 4 compute units, so 12 for 2";
    const auto of_class = match(device_named("x"));
    ASSERT_TRUE(of_class);
    EXPECT_FALSE(of_class->same_device);
    EXPECT_EQ(of_class->tuning.lanes, 8) << "the first of its class";
    DeviceInfo forced = device_named("a");
    forced.is_cpu = false;
    EXPECT_FALSE(match(forced)) << "a CPU taken for a GPU has no CPU's tuning";
    DeviceInfo device = device_named("x");
    device.version = "OpenCL 3.0 of other instructions";
    EXPECT_FALSE(match(device));
    device.is_cpu = false;
    EXPECT_FALSE(match(device)) << "a GPU is no CPU";
    device.platform = "Test GPU";
    ASSERT_TRUE(match(device)) << "a GPU's version names no instructions";
    EXPECT_EQ(match(device)->tuning.tuning.cull_chunks, 8);
    device.compute_units = 100000;
    EXPECT_EQ(match(device)->tuning.tuning.cull_chunks, 65536) << "the most that is valid";
    device.platform = "Another";
    EXPECT_FALSE(match(device));
}

TEST_F(ShippedTunings, AGpuTakesThatOfItsChip) {
    const std::vector<ShippedTuning> table = {
        {"CUDA", "NVIDIA L40", "3.0", false, 10, {2, {.cull_group = 32, .geometry = 1}}},
        {"CUDA", "NVIDIA H200", "3.0", false, 10, {2, {.cull_group = 64, .geometry = 1}}}};
    DeviceInfo device;
    device.platform = "CUDA";
    device.compute_units = 10;
    device.max_work_group = 1024;
    for (const char* name : {"NVIDIA H100 80GB HBM3", "NVIDIA GH200 480GB", "NVIDIA H200 NVL"}) {
        device.name = name;
        const auto match = shipped_tuning(device, table);
        ASSERT_TRUE(match) << name;
        EXPECT_FALSE(match->same_device) << name;
        EXPECT_EQ(match->tuning.tuning.cull_group, 64) << name;
        EXPECT_EQ(match->tuning.tuning.geometry, 1) << name;
    }
    device.name = "NVIDIA A100";
    EXPECT_EQ(shipped_tuning(device, table)->tuning.tuning.cull_group, 32) << "of its class";
    EXPECT_EQ(shipped_tuning(device, table)->tuning.tuning.geometry, 0);
    device.name = "NVIDIA H100 80GB HBM3";
    device.platform = "Another";
    EXPECT_FALSE(shipped_tuning(device, table));
}

TEST_F(ShippedTunings, MeasuringHereCountsMore) {
    ASSERT_FALSE(shipped_tunings().empty());
    for (const ShippedTuning& row : shipped_tunings()) {
        DeviceInfo device;
        device.name = row.device;
        device.platform = row.platform;
        device.version = row.version;
        device.is_cpu = row.is_cpu;
        device.compute_units = row.compute_units;
        device.max_work_group = 1024;
        const KnownTuning known = known_tuning(device);
        EXPECT_EQ(text_of(known.source), "shipped for this device");
        EXPECT_EQ(known.lanes, row.tuning.lanes);
        EXPECT_EQ(known.tuning.cull_chunks, row.tuning.tuning.cull_chunks);
        EXPECT_EQ(known.tuning.geometry, row.tuning.tuning.geometry);
        device.name = "of another kind";
        EXPECT_EQ(text_of(known_tuning(device).source), "shipped for its class");
        const int of_class = row.is_cpu ? row.tuning.tuning.geometry : 0;
        EXPECT_EQ(known_tuning(device).tuning.geometry, of_class) << "measured on no such GPU";
        store_tuning(device, some_tuning());
        EXPECT_EQ(text_of(known_tuning(device).source), "measured here");
        EXPECT_EQ(known_tuning(device).tuning, some_tuning().tuning);
    }
    const KnownTuning unknown = known_tuning(device_named("a"));
    EXPECT_EQ(text_of(unknown.source), "built in");
    EXPECT_EQ(unknown.tuning, built_in_tuning(device_named("a")).tuning);
}

// The same rows, read by another parser.
TEST_F(ShippedTunings, AreThoseOfTheCertificates) {
    const auto shipping = {TuningSource::measured, TuningSource::shipped_for_device};
    std::size_t shipped = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(source_root()) / "host/certify/devices")) {
        if (entry.path().extension() != ".json") continue;
        std::ifstream in(entry.path());
        const auto json = nlohmann::json::parse(in);
        const auto& tuning = json.at("tuning");
        const auto is_its_source = [&](TuningSource s) {
            return tuning.at("source") == text_of(s);
        };
        if (!tuning.contains("values") || std::ranges::none_of(shipping, is_its_source)) continue;
        ++shipped;
        const auto row = std::ranges::find(shipped_tunings(), json.at("device").at("name"),
                                           &ShippedTuning::device);
        ASSERT_NE(row, shipped_tunings().end()) << entry.path();
        EXPECT_EQ(row->compute_units, json.at("device").at("compute_units"));
        EXPECT_EQ(row->is_cpu, json.at("device").at("cpu"));
        EXPECT_EQ(row->tuning.lanes, tuning.at("values").at("lanes"));
        for (const TuningParameter& field : tuning_parameters())
            EXPECT_EQ(row->tuning.tuning.*field.value, tuning.at("values").at(field.name))
                << field.name;
    }
    EXPECT_EQ(shipped, shipped_tunings().size());
}

// The device of a table of results, and its frames by what they differ in [ms].
struct MeasuredFrames {
    explicit MeasuredFrames(const std::string& table) {
        const fs::path folder = fs::path(source_root()) / "host/measure/results" / table;
        std::ifstream context(folder / "bench.context.json");
        device = nlohmann::json::parse(context).at("context").at("device").at("name");
        for (const BenchRow& row : bench_rows(parse_csv(text_of_file(folder / "bench.csv")))) {
            if (row.stage == kFrameStage.name)
                ms[{row.point.lights, row.point.resolution}] = row.ms.median;
        }
    }
    std::string device;
    std::map<std::pair<std::uint64_t, std::array<int, 2>>, double> ms;
};

// By the rule of bench --tune, on frames that OpenGL and OpenCL drew.
TEST_F(ShippedTunings, DrawTrianglesByWhatTablesSayIsFaster) {
    for (const char* table : {"sponza_cpu", "sponza_h200"}) {
        const MeasuredFrames ids(table), compute(std::string(table) + "_compute");
        ASSERT_EQ(compute.device, ids.device);
        ASSERT_FALSE(ids.ms.empty());
        const auto row = std::ranges::find(shipped_tunings(), ids.device, &ShippedTuning::device);
        ASSERT_NE(row, shipped_tunings().end()) << table;
        for (const auto& [frame, ids_ms] : ids.ms) {
            const bool is_faster = compute.ms.at(frame) < (1.0 - kTuningGain) * ids_ms;
            EXPECT_EQ(row->tuning.tuning.geometry, is_faster ? 1 : 0)
                << table << ", " << frame.first << " lights";
        }
    }
}

using ForcedTuning = TuningSandbox;

TEST_F(ForcedTuning, OfNoShippedDeviceIsNamed) {
    const EnvironmentVariable forced("KILOLUX_SHIPPED_TUNING", "no such device");
    EXPECT_EQ(message_of<Error>([] { known_tuning(DeviceInfo{}); }),
              "KILOLUX_SHIPPED_TUNING=no such device: no tuning is shipped for it");
}

// What tests of kernels take, and what frames take.
TEST_F(ForcedTuning, IsTheDefaultAndTheKnownOneOfADeviceOfItsKind) {
    DeviceInfo cpu;
    cpu.is_cpu = true;
    cpu.max_work_group = 4096;
    DeviceInfo gpu = cpu;
    gpu.is_cpu = false;
    const Tuning built_in = default_tuning(cpu);
    for (const ShippedTuning& row : shipped_tunings()) {
        const EnvironmentVariable forced("KILOLUX_SHIPPED_TUNING", std::string(row.device));
        const DeviceInfo& same = row.is_cpu ? cpu : gpu;
        EXPECT_EQ(default_tuning(same), row.tuning.tuning) << row.device;
        EXPECT_EQ(known_tuning(same).tuning, row.tuning.tuning) << row.device;
        if (!row.is_cpu) {
            EXPECT_EQ(default_tuning(cpu), built_in) << "of another kind";
        }
    }
}

}  // namespace
}  // namespace kilolux
