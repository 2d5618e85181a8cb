// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/probe.h"

#include <string>

#include "host/base/source.h"

namespace kilolux {

KernelProgram build_probe(const Gpu& gpu, std::span<const std::string_view> headers,
                          std::string_view text, const BuildOptions& options) {
    std::string source;
    for (const std::string_view header : headers) source += splice_source(header, false).text;
    source += "#line 1 \"probe\"\n" + std::string(text);
    return build_text(gpu, "probe", source, options);
}

}  // namespace kilolux
