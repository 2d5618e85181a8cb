// SPDX-License-Identifier: Apache-2.0
#include "tests/opencl/test_gpu.h"

#include <cstdlib>
#include <map>
#include <string>

#include "host/base/source.h"

namespace kilolux {
namespace {

Gpu first_gpu() {
    const char* choice = std::getenv("KILOLUX_TEST_DEVICE");
    return Gpu(choose_device(choice != nullptr ? choice : ""));
}

}  // namespace

Gpu test_gpu(int lane_width) {
    static const Gpu gpu = first_gpu();
    return Gpu(gpu.context, gpu.queue, lane_width);
}

cl::Program build_probe(const Gpu& gpu, std::span<const std::string_view> headers,
                        std::string_view text, const BuildOptions& options) {
    std::string source(kKernelPrologue);
    for (const std::string_view header : headers) source += splice_source(header, false).text;
    source += "#line 1 \"probe\"\n" + std::string(text);
    const std::string all_options =
        "-cl-std=CL1.2 -Werror -DVW=" + std::to_string(gpu.info.lane_width) + " " + options.text();
    static std::map<std::string, cl::Program> programs;
    const auto [place, is_new] = programs.try_emplace(all_options + source, gpu.context, source);
    if (!is_new) return place->second;
    try {
        place->second.build(gpu.device, all_options.c_str());
    } catch (const cl::Error&) {
        throw Error("probe: " + place->second.getBuildInfo<CL_PROGRAM_BUILD_LOG>(gpu.device));
    }
    return place->second;
}

}  // namespace kilolux
