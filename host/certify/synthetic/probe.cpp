// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/probe.h"

#include <map>
#include <mutex>
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
    using Key = std::pair<cl_context, std::string>;
    static std::mutex mutex;
    static std::map<Key, cl::Program> programs;  // holds its context: the key stays unique
    const std::scoped_lock lock(mutex);
    const auto [place, is_new] =
        programs.try_emplace(Key(gpu.context(), all_options + source), gpu.context, source);
    if (!is_new) return place->second;
    try {
        place->second.build(gpu.device, all_options.c_str());
    } catch (const cl::Error&) {
        throw Error("probe: " + place->second.getBuildInfo<CL_PROGRAM_BUILD_LOG>(gpu.device));
    }
    return place->second;
}

}  // namespace kilolux
