// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/device_tables.h"

#include <span>

#include "host/base/formats/srgb.h"
#include "host/gpu/program.h"

namespace kilolux {
namespace {

template <typename T>
cl::Buffer uploaded_table(const Gpu& gpu, std::span<const T> values) {
    cl::Buffer out(gpu.context, CL_MEM_READ_ONLY, values.size_bytes());
    gpu.queue.enqueueWriteBuffer(out, CL_TRUE, 0, values.size_bytes(), values.data());
    return out;
}

}  // namespace

std::shared_ptr<const DeviceTables> device_tables(const Gpu& gpu) {
    return gpu.programs->tables([&] {
        const auto srgb = srgb_to_linear_table();
        const SrgbBuckets buckets = srgb_buckets();
        return DeviceTables{
            uploaded_table<float>(gpu, std::vector<float>(srgb.begin(), srgb.end())),
            uploaded_table<float>(gpu, buckets.boundary),
            uploaded_table<std::uint32_t>(gpu, buckets.code)};
    });
}

}  // namespace kilolux
