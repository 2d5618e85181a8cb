// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/device.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "host/base/error.h"
#include "host/gpu/tuning/tuning_store.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

std::string choice_error(std::string_view choice) {
    try {
        choose_device(choice);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Device, IsChosenByIndexAndByPartOfItsNameInAnyCase) {
    const auto devices = all_devices();
    ASSERT_FALSE(devices.empty());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        EXPECT_EQ(choose_device(std::to_string(i))(), devices[i]());
    }
    std::string name = describe(devices.front()).name.substr(0, 8);
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(choose_device(name)(), devices.front()());
}

TEST(Device, GpuIsPreferredElseTheFirst) {
    const auto devices = all_devices();
    cl::Device expected = devices.front();
    for (std::size_t i = devices.size(); i-- > 0;) {
        if ((devices[i].getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0) expected = devices[i];
    }
    EXPECT_EQ(choose_device("")(), expected());
}

TEST(Device, UnknownChoiceListsWhatThereIs) {
    for (const std::string choice : {"no-such-device", "999", "-1", "0x"}) {
        const std::string message = choice_error(choice);
        EXPECT_NE(message.find("no device '" + choice + "'; the devices are, by index: 0: " +
                               describe(all_devices().front()).name),
                  std::string::npos)
            << message;
    }
}

TEST(Device, AWholeNumberIsAnIndexAndNoPartOfAName) {
    const std::string name = describe(all_devices().front()).name;
    const std::size_t first = name.find_first_of("0123456789");
    if (first == std::string::npos) GTEST_SKIP() << name << " has no digit";
    const std::string digits =
        name.substr(first, name.find_first_not_of("0123456789", first) - first);
    if (std::stoul(digits) < all_devices().size()) GTEST_SKIP() << digits << " is an index";
    const std::string message = choice_error(digits);
    EXPECT_NE(message.find("no device '" + digits + "'; the devices are, by index: 0: "),
              std::string::npos)
        << message;
}

TEST(DeviceDeathTest, WithoutADriverSaysWhatToInstall) {
    testing::GTEST_FLAG(death_test_style) = "threadsafe";
    EXPECT_EXIT(
        {
            setenv("OCL_ICD_VENDORS", "/nonexistent", 1);
            const std::string message = choice_error("");
            std::fprintf(stderr, "%s\n", message.c_str());
            std::exit(message.find("no device found") != std::string::npos ? 0 : 1);
        },
        testing::ExitedWithCode(0), "pocl-opencl-icd");
}

TEST(Device, LaneWidthIsTheDevicesOwnUnlessGiven) {
    const Gpu gpu = test_gpu();
    const int own = gpu.info.lane_width;
    EXPECT_TRUE(own == 1 || own == 2 || own == 4 || own == 8 || own == 16) << own;
    EXPECT_EQ(Gpu(gpu.context, gpu.queue, 2).info.lane_width, 2);
    EXPECT_EQ(Gpu(gpu.context, gpu.queue).info.lane_width, own);
    EXPECT_EQ(Gpu(gpu.device).info.name, gpu.info.name);
}

// A user of the library gets the lane width that the program uses without a tuning.
TEST(Device, OnePlaceSaysTheLaneWidth) {
    const Gpu gpu(test_gpu().device);
    EXPECT_EQ(gpu.info.lane_width, built_in_tuning(describe(gpu.device)).lanes);
    if (gpu.info.is_cpu) {
        EXPECT_EQ(gpu.info.lane_width, std::min(2 * gpu.info.vector_width, 16));
    } else {
        EXPECT_EQ(gpu.info.lane_width, 2);
    }
}

TEST(Device, QueuesOutOfOrderOrWithoutProfilingAreRefused) {
    const Gpu gpu = test_gpu();
    const auto message_of = [&](cl_command_queue_properties properties) -> std::string {
        const cl::CommandQueue queue(gpu.context, gpu.device, properties);
        try {
            Gpu(gpu.context, queue);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message_of(CL_QUEUE_PROFILING_ENABLE), "no error");
    EXPECT_NE(message_of(0).find("the given queue has no profiling enabled"), std::string::npos);
    EXPECT_NE(message_of(CL_QUEUE_PROFILING_ENABLE | CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)
                  .find(gpu.info.name + ": the given queue runs out of order"),
              std::string::npos);
}

}  // namespace
}  // namespace kilolux
