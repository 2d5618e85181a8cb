// SPDX-License-Identifier: Apache-2.0
#include <CLI/Error.hpp>

#include "host/base/error.h"
#include "host/base/version.h"
#include "host/render/renderer.h"
#include "present/python/lighting_bindings.h"
#include "present/python/metric_bindings.h"
#include "present/python/renderer_bindings.h"
#include "present/python/scene_bindings.h"

namespace py = pybind11;

PYBIND11_MODULE(_native, module) {
    using namespace kilolux;
    static const py::exception<Error> error(module, "Error", PyExc_RuntimeError);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const CLI::Error& refusal) {
            PyErr_SetString(error.ptr(), refusal.what());
        } catch (const Error& failure) {
            PyErr_SetString(error.ptr(), failure.what());
        }
    });
    module.def("version", version);
    module.def("devices", [] {
        py::list out;
        for (const DeviceInfo& device : list_devices()) out.append(device.name);
        return out;
    });
    add_scenes(module);
    add_renderer(module);
    add_lighting(module);
    add_metrics(module);
}
