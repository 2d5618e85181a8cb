// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/kernel_types.h"

#include <algorithm>
#include <cctype>

namespace kilolux {
namespace {

// Some drivers count the terminating zero.
std::string without_end(std::string text) {
    while (!text.empty() && text.back() == '\0') text.pop_back();
    return text;
}

bool is_number(std::string_view text) {
    return std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::vector<KernelParameter> parameters_of(const cl::Kernel& kernel) {
    std::vector<KernelParameter> out;
    for (cl_uint i = 0; i < kernel.getInfo<CL_KERNEL_NUM_ARGS>(); ++i) {
        out.push_back({without_end(kernel.getArgInfo<CL_KERNEL_ARG_NAME>(i)),
                       without_end(kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(i))});
    }
    return out;
}

bool accepts(const KernelParameter& parameter, std::string_view name, std::string_view type,
             bool is_memory) {
    std::string_view element = parameter.type;
    const bool is_pointer = element.ends_with('*');
    if (is_pointer) element.remove_suffix(1);
    if (!name.empty() && parameter.name != name) return false;
    if (is_memory != (is_pointer || element.starts_with("image"))) return false;
    return element.starts_with(type) && (type.empty() || is_number(element.substr(type.size())));
}

}  // namespace kilolux
