// SPDX-License-Identifier: Apache-2.0
#include "present/python/renderer_bindings.h"

#include <pybind11/stl.h>
#include <algorithm>

#include "present/python/arrays.h"
#include "present/python/served_session.h"
#include "present/python/thread_renderer.h"

namespace py = pybind11;

namespace kilolux {
namespace {

using Lights = ThreadRenderer::Lights;
using Words = std::vector<std::string>;

py::tuple tuple_of(const glm::dvec3& v) { return py::make_tuple(v.x, v.y, v.z); }

py::array_t<double> rows_of(const std::vector<glm::dvec3>& rows) {
    std::vector<double> values;
    for (const glm::dvec3& row : rows) values.insert(values.end(), {row.x, row.y, row.z});
    return array_of(std::move(values), {static_cast<py::ssize_t>(rows.size()), 3});
}

// From view space into the world.
struct ToWorld {
    const Camera& camera;
    glm::dvec3 direction(const glm::dvec3& v) const { return camera.world_from_view * v; }
    glm::dvec3 point(const glm::dvec3& p) const { return direction(p) + camera.position; }
};

// What a probe tells of a surface.
py::dict surface_dict(const SurfaceValues& surface, const ToWorld& to_world) {
    const auto three = [&surface](std::size_t plane) {
        return glm::dvec3(surface[plane], surface[plane + 1], surface[plane + 2]);
    };
    py::dict out;
    out["depth"] = surface[SURFACE_DEPTH];
    out["position"] = tuple_of(to_world.point(three(SURFACE_POSITION)));
    out["normal"] = tuple_of(to_world.direction(three(SURFACE_NORMAL)));
    out["albedo"] = tuple_of(three(SURFACE_ALBEDO));
    out["roughness"] = surface[SURFACE_ROUGHNESS];
    out["metallic"] = surface[SURFACE_METALLIC];
    return out;
}

py::dict layer_dict(const ProbedLayer& layer, const ToWorld& to_world) {
    py::dict out = surface_dict(layer.surface, to_world);
    out["material"] = layer.material;
    out["transmission"] = layer.surface[SURFACE_TRANSMISSION];
    return out;
}

py::dict probe_dict(const ThreadRenderer::Probed& probed) {
    const PixelProbe& probe = probed.probe;
    const ToWorld to_world{probed.camera};
    py::dict out = surface_dict(probe.surface, to_world);
    out["drawn"] = probe.has_surface();
    py::list layers;
    for (const ProbedLayer& layer : probe.layers) layers.append(layer_dict(layer, to_world));
    out["layers"] = layers;
    out["cluster"] = py::make_tuple(probe.tile_x, probe.tile_y, probe.slice);
    out["coarse_lights"] = probe.coarse_count;
    std::vector<glm::dvec3> positions, intensities;
    std::vector<double> ranges;
    for (const ProbedLight& lit : probe.lights) {
        const float4& p = lit.light.position_range;
        const float4& c = lit.light.color_scale;
        positions.push_back(glm::dvec3(p.x, p.y, p.z) + probed.camera.position);
        intensities.emplace_back(c.x, c.y, c.z);
        ranges.push_back(p.w);
    }
    py::dict lights;
    lights["position"] = rows_of(positions);
    lights["intensity"] = rows_of(intensities);
    const auto count = static_cast<py::ssize_t>(ranges.size());
    lights["range"] = array_of(std::move(ranges), {count});
    out["lights"] = lights;
    return out;
}

py::dict reference_dict(ReferencePicture picture) {
    const py::ssize_t height = picture.radiance.height, width = picture.radiance.width;
    py::dict out;
    out["radiance"] = array_of(std::move(picture.radiance.rgb), {height, width, 3});
    out["scale"] = array_of(std::move(picture.scale.rgb), {height, width, 3});
    out["lights_per_pixel"] = picture.lights_per_pixel;
    return out;
}

// The options, and their values after `words`.
py::list settings(const Words& words) {
    constexpr const char* kKinds[] = {"text",    "flag",   "number", "count",
                                      "numbers", "choice", "list",   "file"};
    RendererOptions options = parse_renderer_options(SharedOptions().scene, words);
    py::list out;
    for (const Setting& setting : settings_of(options)) {
        py::dict row;
        std::string name = setting.word();
        std::ranges::replace(name, '-', '_');
        row["name"] = name;
        row["kind"] = kKinds[static_cast<int>(setting.kind)];
        row["words"] = setting.words;
        row["form"] = setting.text.form;
        row["meaning"] = setting.text.described();
        row["value"] = setting.show();
        out.append(row);
    }
    return out;
}

}  // namespace

void add_renderer(py::module_& module) {
    module.def("settings", settings, py::arg("words") = Words());
    // NOLINTNEXTLINE(bugprone-unused-raii): it stays in the module.
    py::class_<Frame, std::shared_ptr<Frame>>(module, "Frame");
    py::class_<ThreadRenderer>(module, "Renderer")
        .def(py::init([](const std::string& scene, const Words& words, const Scene* made,
                         const Lights& lights) {
            return std::make_unique<ThreadRenderer>(
                parse_renderer_options(scene, words),
                made != nullptr ? std::optional<Scene>(*made) : std::nullopt, lights);
        }))
        .def("change",
             [](ThreadRenderer& self, const std::string& scene, const Words& words,
                std::optional<Lights> lights) {
                 self.change(parse_renderer_options(scene, words), std::move(lights));
             })
        .def("render",
             [](ThreadRenderer& self, std::optional<double> time, bool counts) {
                 const ThreadRenderer::Rendered rendered = self.render(time, counts);
                 return py::make_tuple(frame_arrays(rendered.frame), rendered.stats);
             })
        .def("probe",
             [](ThreadRenderer& self, int x, int y) { return probe_dict(self.probe(x, y)); })
        .def("reference", [](ThreadRenderer& self) { return reference_dict(self.reference()); });
    py::class_<ServedSession>(module, "ServedSession")
        .def(py::init([](const std::string& scene, const Words& words, const Scene* made,
                         const Lights& lights, const std::string& address) {
            RendererOptions options = parse_renderer_options(scene, words);
            options.shared.automatic_exposure = false;
            ServerOptions server;
            server.address = parse_serve_address("serve", address);
            std::optional<Scene> copy =
                made != nullptr ? std::optional<Scene>(*made) : std::nullopt;
            const py::gil_scoped_release other_threads_run;
            return std::make_unique<ServedSession>(std::move(options), std::move(copy), lights,
                                                   server);
        }))
        .def("address", &ServedSession::address)
        .def("close", [](ServedSession& self) {
            const py::gil_scoped_release other_threads_run;
            self.close();
        });
}

}  // namespace kilolux
