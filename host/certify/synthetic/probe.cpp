// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/probe.h"

#include <string>

#include "host/base/source.h"

namespace kilolux {

cl::Program build_probe(const Gpu& gpu, std::span<const std::string_view> headers,
                        std::string_view text, const BuildOptions& options) {
    std::string source(kKernelPrologue);
    for (const std::string_view header : headers) source += splice_source(header, false).text;
    source += "#line 1 \"probe\"\n" + std::string(text);
    const std::string all_options =
        "-cl-std=CL1.2 -Werror -DVW=" + std::to_string(gpu.info.lane_width) + " " + options.text();
    return gpu.programs->find(all_options + source, [&] {
        cl::Program program(gpu.context, source);
        try {
            program.build(gpu.device, all_options.c_str());
        } catch (const cl::Error&) {
            throw Error("probe: " + program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(gpu.device));
        }
        return program;
    });
}

}  // namespace kilolux
