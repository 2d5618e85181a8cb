// SPDX-License-Identifier: Apache-2.0
#include "present/python/metric_bindings.h"

#include <algorithm>

#include "host/base/error.h"
#include "host/measure/metrics/error_metrics.h"
#include "host/measure/metrics/flip.h"
#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/metrics/ssim.h"
#include "present/python/arrays.h"

namespace py = pybind11;

namespace kilolux {
namespace {

struct Pictures {
    RgbImage picture, reference;
};

Pictures pictures_of(const Array<double>& picture, const Array<double>& reference) {
    return {rgb_image_of(picture, "picture"), rgb_image_of(reference, "reference")};
}

py::dict compare(const Array<double>& picture, const Array<double>& reference, double peak) {
    const Pictures p = pictures_of(picture, reference);
    PictureErrors errors;
    {
        const py::gil_scoped_release other_threads_run;
        errors.hdr = compare_hdr(p.picture, p.reference, {.psnr_peak = peak});
    }
    py::dict out;
    for (const ErrorMetric& m : error_metrics()) {
        if (m.part != MetricPart::hdr) continue;
        std::string name(m.name);
        std::ranges::replace(name, '-', '_');
        out[name.c_str()] = *m.value(errors);
    }
    return out;
}

py::tuple flip(const Array<double>& picture, const Array<double>& reference, bool hdr) {
    const Pictures p = pictures_of(picture, reference);
    FlipResult result;
    {
        const py::gil_scoped_release other_threads_run;
        result = hdr ? flip_hdr(p.picture, p.reference) : flip_ldr(p.picture, p.reference);
    }
    const py::ssize_t height = result.height, width = result.width;
    return py::make_tuple(result.error.mean, array_of(std::move(result.errors), {height, width}));
}

DisplayView display_of(const Array<std::uint8_t>& codes) {
    if (codes.ndim() != 3 || codes.shape(2) != 4) {
        throw Error("ssim: pictures must have the shape (height, width, 4)");
    }
    return {static_cast<int>(codes.shape(1)),
            static_cast<int>(codes.shape(0)),
            {codes.data(), static_cast<std::size_t>(codes.size())}};
}

py::object ssim_of(const Array<std::uint8_t>& picture, const Array<std::uint8_t>& reference) {
    const std::optional<double> value = ssim(display_of(picture), display_of(reference));
    return value ? py::object(py::float_(*value)) : py::object(py::none());
}

}  // namespace

void add_metrics(py::module_& module) {
    module.def("compare", compare);
    module.def("flip", flip);
    module.def("ssim", ssim_of);
}

}  // namespace kilolux
