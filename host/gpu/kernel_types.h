// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "host/gpu/device.h"
#include "kernels/shared/types.h"

namespace kilolux {

/// The name of T without its namespace, which structs of kernels/shared have in kernels too.
template <typename T>
constexpr std::string_view name_of_type() {
    std::string_view text = __PRETTY_FUNCTION__;  // "... [with T = kilolux::Light; ...]"
    text.remove_prefix(text.find("T = ") + 4);
    text = text.substr(0, text.find_first_of(";]"));
    const std::size_t scope = text.rfind("::");
    return scope == std::string_view::npos ? text : text.substr(scope + 2);
}

/// The type name in kernels that matches T; empty: a buffer of T matches any element type.
template <typename T>
inline constexpr std::string_view kKernelType = name_of_type<T>();
template <>
inline constexpr std::string_view kKernelType<std::byte> = "";
template <>
inline constexpr std::string_view kKernelType<float> = "float";
template <>
inline constexpr std::string_view kKernelType<std::uint8_t> = "uchar";
template <>
inline constexpr std::string_view kKernelType<std::uint16_t> = "ushort";
template <>
inline constexpr std::string_view kKernelType<uint> = "uint";
template <>
inline constexpr std::string_view kKernelType<std::uint64_t> = "ulong";

/// A kernel's parameter as its source declares it.
struct KernelParameter {
    std::string name, type;  // "ShadeLight*"
};

/// The parameters of a kernel that was built with -cl-kernel-arg-info.
std::vector<KernelParameter> parameters_of(const cl::Kernel& kernel);

/// Whether the parameter is memory of elements (`is_memory`) or a value that kernels call `type`,
/// or vectors of it. Empty `name` or `type`: any.
bool accepts(const KernelParameter& parameter, std::string_view name, std::string_view type,
             bool is_memory);

}  // namespace kilolux
