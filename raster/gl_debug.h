// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

/// The driver's messages through KHR_debug since the last check_gl_errors().
struct GlMessages {
    std::vector<std::string> errors;
};

/// Makes the current context record its errors. Keep the result until the context is gone: the
/// driver holds a pointer to it.
std::unique_ptr<GlMessages> record_gl_errors();

/// Throws Error with `where` and the driver's message if a GL call failed in the current context
/// since the last check. Contexts that do not record give the error's code only.
void check_gl_errors(std::string_view where);

}  // namespace kilolux
