// SPDX-License-Identifier: Apache-2.0
// The parts of a certificate beside the hard cases: host/certify/README.md lists its keys.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/gpu/device.h"

namespace kilolux {

/// The device's properties that decide code and bits, the host's processor, and the environment
/// variables that change the driver's code.
nlohmann::ordered_json capabilities_json(const cl::Device& device);

/// One part of a certificate; `step` is called between its pictures and may throw to stop.
struct CertificatePart {
    const char* name;  // its key
    nlohmann::ordered_json (*make)(const cl::Device& device, const std::function<void()>& step);
};

/// "equality": pictures by lists against pictures by all lights, bit for bit. "oclgrind": a frame's
/// kernels under oclgrind. "stages": a small frame by stage, beside the device's limits. "tuning":
/// the work sizes in force, and where they come from. Each has "passed"; a part that throws has
/// "error".
const std::vector<CertificatePart>& certificate_parts();

/// The part, or the error that it threw; Interrupted is passed on.
nlohmann::ordered_json made_part(const CertificatePart& part, const cl::Device& device,
                                 const std::function<void()>& step);

}  // namespace kilolux
