// SPDX-License-Identifier: Apache-2.0
// What a certificate holds beside the hard cases: host/certify/README.md lists its keys.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/gpu/device.h"

namespace kilolux {

/// The device with what of it decides code and bits, its host's processor, and the environment
/// variables that change what its driver makes.
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

/// The part, or what it threw; Interrupted comes out.
nlohmann::ordered_json made_part(const CertificatePart& part, const cl::Device& device,
                                 const std::function<void()>& step);

/// A row for each certificate: what runs, by which driver, what failed, what a frame takes.
/// Then the failures, each with its worst value. Throws Error for a file that is no certificate.
std::string certificates_text(const std::vector<std::string>& files);

}  // namespace kilolux
