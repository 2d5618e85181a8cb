// SPDX-License-Identifier: Apache-2.0
#include "present/cli/stats_json.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "host/base/log.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

using OrderedJson = nlohmann::ordered_json;

FrameRecord make_record(int frame) {
    FrameRecord record;
    record.frame = frame;
    record.time = 0.5 * frame;
    record.file = "f" + std::to_string(frame) + ".exr";
    record.stats.lights_given = 10;
    record.stats.lights_used = 7;
    record.stats.lights_rejected = 3;
    record.stats.grid[0] = 16;
    record.stats.grid[1] = 9;
    record.stats.grid[2] = 44;
    record.stats.coarse_pairs = 5'000'000'000;
    record.stats.active_clusters = 12;
    record.stats.refined_pairs = 34;
    record.stats.evaluations_per_pixel = 5.5;
    record.stats.useful_evaluations_per_pixel = 4.25;
    record.stats.stages = {{"cull_lights", 1.5, 0.25}, {"shade", 2.5, 0.0}};
    record.stats.frame_ms = 100.0 + frame;
    return record;
}

OrderedJson make_document(const FrameRecord& last) {
    DeviceInfo device;
    device.name = "a device";
    device.version = "OpenCL 3.0";
    device.lane_width = 8;
    ScenePlan plan;
    plan.features = {"pbr", "point-lights"};
    return stats_json(device, plan, last);
}

TEST(StatsJson, HasTheKeysToolsRelyOn) {
    const OrderedJson json = make_document(make_record(0));
    EXPECT_EQ(json.at("device").at("name"), "a device");
    EXPECT_EQ(json.at("device").at("version"), "OpenCL 3.0");
    EXPECT_EQ(json.at("device").at("lane_width"), 8);
    EXPECT_EQ(json.at("plan"), OrderedJson({"pbr", "point-lights"}));
    EXPECT_EQ(json.at("lights"),
              OrderedJson({{"given", 10}, {"used", 7}, {"rejected", 3}, {"dropped", 0}}));
    EXPECT_EQ(json.at("clusters").at("grid"), OrderedJson({16, 9, 44}));
    EXPECT_EQ(json.at("clusters").at("coarse_pairs"), 5'000'000'000);
    EXPECT_EQ(json.at("clusters").at("active"), 12);
    EXPECT_EQ(json.at("clusters").at("refined_pairs"), 34);
    EXPECT_EQ(json.at("evaluations").at("per_pixel"), 5.5);
    EXPECT_EQ(json.at("evaluations").at("useful_per_pixel"), 4.25);
    ASSERT_EQ(json.at("stages").size(), 3u);
    EXPECT_EQ(json.at("stages")[0],
              OrderedJson({{"name", "cull_lights"}, {"ms", 1.5}, {"limit_ms", 0.25}}));
    EXPECT_TRUE(json.at("stages")[1].at("limit_ms").is_null());
    EXPECT_EQ(json.at("stages")[2],
              OrderedJson({{"name", "other"}, {"ms", 96.0}, {"limit_ms", nullptr}}))
        << "stages sum to the frame";
    EXPECT_EQ(json.at("frame_ms"), 100.0);
    EXPECT_FALSE(json.contains("error"));
    EXPECT_FALSE(json.contains("frames"));
}

TEST(StatsJson, WhatWasNotCountedIsNull) {
    FrameRecord record = make_record(0);
    record.stats.useful_evaluations_per_pixel = -1.0;
    EXPECT_TRUE(make_document(record)["evaluations"]["useful_per_pixel"].is_null());
}

TEST(StatsJson, ErrorWhenAReferenceWasGiven) {
    FrameRecord record = make_record(0);
    record.comparison = Comparison{"rmse", 0.5, 0.1, {{"rmse", 0.5}, {"max", 2.0}}};
    const OrderedJson error = make_document(record).at("error");
    EXPECT_EQ(error.at("metric"), "rmse");
    EXPECT_EQ(error.at("value"), 0.5);
    EXPECT_EQ(error.at("threshold"), 0.1);
    EXPECT_EQ(error.at("passed"), false);
    EXPECT_EQ(error.at("errors").at("max"), 2.0);
}

TEST(StatsJson, SequencesHaveEveryFrameAndTheLastOnTop) {
    const TemporaryFolder folder;
    const std::string file = (folder / "s.json").string();
    FrameLog log;
    write_json(file, make_document(make_record(5)), &log);
    EXPECT_TRUE(OrderedJson::parse(text_of_file(file)).at("frames").empty());
    log.add(make_record(3));
    log.add(make_record(5));
    write_json(file, make_document(make_record(5)), &log);
    const OrderedJson json = OrderedJson::parse(text_of_file(file));
    EXPECT_EQ(json.at("frame_ms"), 105.0);
    ASSERT_EQ(json.at("frames").size(), 2u);
    EXPECT_EQ(json.at("frames")[0].at("frame"), 3);
    EXPECT_EQ(json.at("frames")[0].at("time"), 1.5);
    EXPECT_EQ(json.at("frames")[0].at("file"), "f3.exr");
    EXPECT_EQ(json.at("frames")[0].at("frame_ms"), 103.0);
}

TEST(StatsJson, FramesOnAFullDiskAreAnError) {
    const auto former = std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const rlimit full{10, limit.rlim_max};
    FrameLog log;
    setrlimit(RLIMIT_FSIZE, &full);
    const auto message = message_of<Error>([&] {
        log.add(make_record(1));
        log.read([](std::string_view) {});
    });
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, former);
    EXPECT_TRUE(contains(message, "cannot write")) << message;
}

TEST(StatsJson, WrittenWholeOrNotAtAll) {
    const TemporaryFolder folder;
    write_json((folder / "s.json").string(), make_document(make_record(0)));
    EXPECT_EQ(OrderedJson::parse(text_of_file(folder / "s.json")).at("frame_ms"), 100.0);
    const auto message = message_of<Error>(
        [&] { write_json((folder / "no/s.json").string(), OrderedJson::object()); });
    EXPECT_TRUE(contains(message, "no/s.json")) << message;
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"s.json"}));
}

// A result is longer than the buffer of standard output.
TEST(StatsJson, AResultStandsWholeBeforeWhatFollowsInTheSameFile) {
    const TemporaryFolder folder;
    const std::string table(6000, 'a');
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const int file = open((folder / "both").c_str(), O_WRONLY | O_CREAT, 0600);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        print_result(false, {}, table + "\n");
        std::fputs("of the system\n", stderr);
        std::fputs((table + "\n").c_str(), stdout);
        warn("of the program");
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(text_of_file(folder / "both"),
              table + "\nof the system\n" + table + "\nkilolux: warning: of the program\n");
}

}  // namespace
}  // namespace kilolux
