// SPDX-License-Identifier: Apache-2.0
#include "host/certify/synthetic/probe.h"

#include <string>

#include "host/base/source.h"

namespace kilolux {
namespace {

// A probe's three numbers in a row, `of` times for each element, are vector `k` of each lane's
// element; results go out as three planes of `count` elements.
constexpr std::string_view kVectors = R"(
#if defined(KILOLUX_DEVICE_LANES_H)
static inline FV3 probe_vector(global const float* in, uint of, uint k) {
    uint x[VW], y[VW], z[VW];
    for (uint i = 0; i < VW; ++i) {
        x[i] = 3u * (of * ((uint)get_global_id(0) * VW + i) + k);
        y[i] = x[i] + 1u;
        z[i] = x[i] + 2u;
    }
    return fv3(lane_gather(FV, in, x), lane_gather(FV, in, y), lane_gather(FV, in, z));
}
static inline void put_probe_vector(FV3 v, uint count, global float* out) {
    size_t first = get_global_id(0) * VW;
    lane_store(v.x, out + first);
    lane_store(v.y, out + count + first);
    lane_store(v.z, out + 2u * count + first);
}
#endif
)";

}  // namespace

KernelProgram build_probe(const Gpu& gpu, std::span<const std::string_view> headers,
                          std::string_view text, const BuildOptions& options) {
    std::string source;
    for (const std::string_view header : headers) source += splice_source(header, false).text;
    source += std::string(kVectors) + "#line 1 \"probe\"\n" + std::string(text);
    return build_text(gpu, "probe", source, options);
}

}  // namespace kilolux
