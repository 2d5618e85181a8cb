// SPDX-License-Identifier: Apache-2.0
// Bundles of arguments against the parameters that kernels declare. Every test with test_gpu()
// checks all stages, since its kernels compare each argument with their declaration.
#include <gtest/gtest.h>

#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/surface_flow.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

// The error of a launch of `text`'s kernel "probe" with the words of shadows.
std::string error_of_launch(const Gpu& gpu, std::string_view text) {
    StageTimer timer;
    try {
        Kernel kernel(gpu, build_probe(gpu, {}, text), "stage", "probe");
        const ShadowWords words{new_buffer(gpu, std::vector<uint>(4)), 4,
                                new_buffer(gpu, std::vector<uint>(4))};
        kernel.enqueue(items(1, 1), timer, words, 2.0f);
        gpu.queue.finish();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Arguments, AreComparedByNameAndType) {
    const Gpu gpu = test_gpu();
    const auto error = [&](std::string_view text) { return error_of_launch(gpu, text); };
    const auto with = [](const std::string& first, const std::string& last) {
        return "kernel void probe(" + first + ", uint word_capacity, " + last + ") {}";
    };
    EXPECT_EQ(error(with("global uint* word_offsets", "global uint* words, float x")), "");
    EXPECT_EQ(
        error(with("global uint* words", "global uint* word_offsets, float x")),
        "stage: argument 0 is 'word_offsets' of type uint*; the kernel's parameter is 'words' "
        "of type uint*");
    EXPECT_NE(error(with("global float* word_offsets", "global uint* words, float x"))
                  .find("the kernel's parameter is 'word_offsets' of type float*"),
              std::string::npos);
    EXPECT_NE(error(with("global uint* word_offsets", "global uint* words, uint x"))
                  .find("argument 3 is '' of type float"),
              std::string::npos);
    Gpu unchecked = gpu;
    unchecked.checks_arguments = false;
    EXPECT_EQ(error_of_launch(unchecked, with("global uint* a", "global float* b, uint x")), "");
}

TEST(Arguments, TypesHaveTheNamesOfKernels) {
    EXPECT_EQ(kKernelType<ShadeLight>, "ShadeLight");
    EXPECT_EQ(kKernelType<float4>, "float4");
    EXPECT_EQ(kKernelType<uint>, "uint");
    EXPECT_EQ(kKernelType<BoxInterval>, "float2");
    EXPECT_TRUE(accepts({"x", "uchar4*"}, "", "uchar", true)) << "vectors of the element";
    EXPECT_FALSE(accepts({"x", "uchar*"}, "", "uint", true));
    EXPECT_FALSE(accepts({"x", "LightExtent*"}, "", "Light", true));
    EXPECT_FALSE(accepts({"x", "View"}, "", "View", true)) << "a value, not memory";
    EXPECT_TRUE(accepts({"x", "image2d_t"}, "", "", true));
}

TEST(Arguments, AKernelKnowsTheLanesItWasBuiltWith) {
    const Gpu gpu = test_gpu(4);
    const KernelProgram four = build_program(gpu, "tonemap");
    const KernelProgram one = build_program(gpu.with_lanes(1), "tonemap");
    EXPECT_EQ(Kernel(gpu, four, "stage", "tonemap").lanes(), 4u);
    const Kernel kernel(gpu, one, "stage", "tonemap");
    EXPECT_EQ(kernel.lanes(), 1u);
    EXPECT_EQ(kernel.vector_items(33, 8).global[0], 40u);
}

}  // namespace
}  // namespace kilolux
