// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <memory>

namespace kilolux {

struct Gpu;

/// Constant tables on a device.
struct DeviceTables {
    cl::Buffer srgb;             // float[256]: linear value of an sRGB code
    cl::Buffer bucket_boundary;  // float[SRGB_BUCKETS], see host/base/formats/srgb.h
    cl::Buffer bucket_code;      // uint[SRGB_BUCKETS]
};

/// The tables of a Gpu and its copies; the first call uploads them. Throws cl::Error.
std::shared_ptr<const DeviceTables> device_tables(const Gpu& gpu);

/// As a kernel's argument: DeviceTables::srgb.
struct SrgbTable {};
/// As two of a kernel's arguments: DeviceTables::bucket_boundary and bucket_code.
struct SrgbBucketTables {};

}  // namespace kilolux
