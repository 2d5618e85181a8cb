// SPDX-License-Identifier: Apache-2.0
#include "present/python/lighting_bindings.h"

#include <pybind11/stl.h>

#include "host/base/error.h"
#include "present/python/arrays.h"
#include "present/python/gbuffer_lighting.h"

namespace py = pybind11;

namespace kilolux {
namespace {

std::vector<float> values_of(const Array<float>& array) {
    return {array.data(), array.data() + array.size()};
}

HostSurfaces surfaces_of(const py::dict& planes) {
    const auto plane = [&planes](const char* name) {
        return planes.contains(name) ? values_of(planes[name].cast<Array<float>>())
                                     : std::vector<float>();
    };
    const auto depth = planes["depth"].cast<Array<float>>();
    if (depth.ndim() != 2) throw Error("G-buffer: depth must have the shape (height, width)");
    return {static_cast<int>(depth.shape(1)),
            static_cast<int>(depth.shape(0)),
            values_of(depth),
            plane("normal"),
            plane("albedo"),
            plane("roughness"),
            plane("metallic"),
            plane("emissive")};
}

using Vector = std::array<double, 3>;
glm::dvec3 vector_of(const Vector& v) { return {v[0], v[1], v[2]}; }

py::dict light(GBufferLighting& self, const py::dict& planes,
               const std::tuple<Vector, Vector, Vector, double>& camera,
               const std::vector<SceneLight>& lights, float ambient) {
    const HostSurfaces surfaces = surfaces_of(planes);
    const auto& [position, focal_point, view_up, y_fov] = camera;
    const Camera eye =
        look_at(vector_of(position), vector_of(focal_point), vector_of(view_up), y_fov);
    GBufferLighting::Lit lit;
    {
        const py::gil_scoped_release other_threads_run;
        lit = self.light(surfaces, eye, lights, ambient);
    }
    const py::ssize_t height = surfaces.height, width = surfaces.width;
    py::dict out;
    out["radiance"] = array_of(std::move(lit.radiance), {height, width, 3});
    out["evaluated"] = array_of(std::move(lit.evaluated), {height, width});
    out["covering"] = array_of(std::move(lit.covering), {height, width});
    return out;
}

}  // namespace

void add_lighting(py::module_& module) {
    py::class_<GBufferLighting>(module, "GBufferLighting")
        .def(py::init<const std::string&, const std::string&>())
        .def("light", light);
}

}  // namespace kilolux
