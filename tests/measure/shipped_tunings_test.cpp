// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/tuning/shipped_tunings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "host/base/error.h"
#include "host/measure/bench/row.h"
#include "host/measure/bench/tune.h"
#include "tests/measure/test_device.h"
#include "tests/support/cache_sandbox.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

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
        // A certificate older than a parameter lacks its value.
        for (const TuningParameter& field : tuning_parameters())
            EXPECT_EQ(row->tuning.tuning.*field.value,
                      tuning.at("values").value(field.name, Tuning{}.*field.value))
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
