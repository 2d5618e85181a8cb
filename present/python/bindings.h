// SPDX-License-Identifier: Apache-2.0
// The parts of the module kilolux._native; present/python/kilolux gives them their Python form.
#pragma once

#include <pybind11/pybind11.h>

namespace kilolux {

void add_scenes(pybind11::module_& module);
void add_renderer(pybind11::module_& module);
void add_lighting(pybind11::module_& module);
void add_metrics(pybind11::module_& module);

}  // namespace kilolux
