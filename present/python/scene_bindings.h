// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace kilolux {

void add_scenes(pybind11::module_& module);

}  // namespace kilolux
