// SPDX-License-Identifier: Apache-2.0
#include "present/python/arrays.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/gltf/mesh/normals.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/light_side.h"

namespace py = pybind11;

namespace kilolux {
namespace {

template <typename T>
py::array view_of(const std::vector<T>& values, std::vector<py::ssize_t> shape,
                  const py::handle& owner) {
    return py::array_t<T>(std::move(shape), values.data(), owner);
}

std::string shape_text(const py::array& array) {
    std::string out = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i) {
        out += fmt::format("{}{}", i == 0 ? "" : ", ", array.shape(i));
    }
    return out + ")";
}

// Throws unless `array` has `rows` rows of `columns`.
void require_rows(const py::array& array, py::ssize_t rows, py::ssize_t columns,
                  const std::string& what) {
    if (array.ndim() == 2 && array.shape(0) == rows && array.shape(1) == columns) return;
    throw Error(
        fmt::format("{}: shape {}, must be ({}, {})", what, shape_text(array), rows, columns));
}

void require_finite(const Array<float>& array, const std::string& what) {
    for (py::ssize_t i = 0; i < array.size(); ++i) {
        if (std::isfinite(array.data()[i])) continue;
        throw Error(fmt::format("{}: value {} is {}, must be finite", what, i, array.data()[i]));
    }
}

template <typename Vector>
std::vector<Vector> vectors_of(const Array<float>& array, py::ssize_t rows,
                               const std::string& what) {
    require_rows(array, rows, static_cast<py::ssize_t>(sizeof(Vector) / sizeof(float)), what);
    require_finite(array, what);
    std::vector<Vector> out(static_cast<std::size_t>(rows));
    if (rows > 0) std::memcpy(out.data(), array.data(), out.size() * sizeof(Vector));
    return out;
}

LightType type_of(const std::string& kind) {
    std::vector<std::string> names;
    for (const LightKind& row : kLightKinds) {
        if (row.name == kind) return row.type;
        names.emplace_back(row.name);
    }
    throw Error("lights: kind '" + kind + "' is none of " + joined(names));
}

glm::dvec3 row(const Array<double>& array, py::ssize_t i) {
    const double* p = array.data() + 3 * i;
    return {p[0], p[1], p[2]};
}

}  // namespace

py::dict frame_arrays(const std::shared_ptr<Frame>& frame) {
    const py::object owner = py::cast(frame);
    const py::ssize_t height = frame->height, width = frame->width;
    py::dict out, aovs;
    out["display"] = view_of(frame->display, {height, width, 4}, owner);
    out["radiance"] = view_of(frame->radiance, {height, width, 3}, owner);
    for (const Layer& layer : frame->aovs) {
        const auto channels = static_cast<py::ssize_t>(layer.channels.size());
        std::vector<py::ssize_t> shape = {height, width};
        if (channels > 1) shape.push_back(channels);
        aovs[py::str(layer.name)] =
            layer.is_id() ? view_of(layer.ids, shape, owner) : view_of(layer.values, shape, owner);
    }
    out["aovs"] = aovs;
    return out;
}

RgbImage rgb_image_of(const Array<double>& picture, const std::string& what) {
    const bool fits = picture.ndim() == 3 && picture.shape(2) == 3 && picture.size() > 0;
    if (!fits) {
        throw Error(what + ": shape " + shape_text(picture) + ", must be (height, width, 3)");
    }
    RgbImage out{static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)), {}};
    out.rgb.assign(picture.data(), picture.data() + picture.size());
    return out;
}

std::vector<SceneLight> lights_of(const std::string& kind,
                                  const std::map<std::string, Array<double>>& arrays) {
    const Array<double>&position = arrays.at("position"), &direction = arrays.at("direction"),
          &side = arrays.at("side"), &intensity = arrays.at("intensity");
    const py::ssize_t count = position.shape(0);
    std::vector<SceneLight> out(static_cast<std::size_t>(count));
    const LightType type = type_of(kind);
    for (py::ssize_t i = 0; i < count; ++i) {
        SceneLight& light = out[static_cast<std::size_t>(i)];
        light.type = type;
        light.position = row(position, i);
        light.intensity = glm::vec3(row(intensity, i));
        for (const LightNumber& number : kLightNumbers) {
            if (!(kind_of(type).*number.has)) continue;
            light.*number.member = static_cast<float>(arrays.at(number.name).data()[i]);
        }
        if (const std::string problem = size_problem(light); !problem.empty()) {
            throw Error(fmt::format("lights: light {}: {}", i, problem));
        }
        if (!kind_of(type).is_aimed) continue;
        light.direction = glm::normalize(row(direction, i));
        if (!std::isfinite(light.direction.x)) {
            throw Error(fmt::format("lights: direction of light {} is zero or not finite", i));
        }
        light.side = perpendicular_side(light.direction, glm::normalize(row(side, i)));
        light.two_sided = arrays.at("two_sided").data()[i] != 0.0;
        if (const std::string problem = cone_problem(light); !problem.empty()) {
            throw Error(fmt::format("lights: light {}: {}", i, problem));
        }
    }
    return out;
}

Mesh mesh_of(const MeshArrays& arrays) {
    const std::string what = "mesh '" + arrays.name + "': ";
    const py::ssize_t count = arrays.positions.ndim() > 0 ? arrays.positions.shape(0) : 0;
    Mesh mesh;
    mesh.name = arrays.name;
    mesh.positions = vectors_of<glm::vec3>(arrays.positions, count, what + "positions");
    mesh.normals = vectors_of<glm::vec3>(arrays.normals, count, what + "normals");
    if (arrays.texcoords.size() > 0) {
        mesh.texcoords[0] = vectors_of<glm::vec2>(arrays.texcoords, count, what + "texcoords");
    }
    if (arrays.colors.size() > 0) {
        mesh.colors = vectors_of<glm::vec4>(arrays.colors, count, what + "colors");
    }
    require_rows(arrays.indices, arrays.indices.size() / 3, 3, what + "indices");
    for (py::ssize_t i = 0; i < arrays.indices.size(); ++i) {
        const std::int64_t index = arrays.indices.data()[i];
        if (index < 0 || index >= count) {
            throw Error(
                fmt::format("{}index {} is {}, but there are {} positions", what, i, index, count));
        }
        mesh.indices.push_back(static_cast<std::uint32_t>(index));
    }
    if (mesh.indices.empty()) throw Error(what + "has no triangles");
    mend_normals(mesh);
    return mesh;
}

Image image_of(const std::string& name, const Array<std::uint8_t>& pixels) {
    if (pixels.ndim() != 3 || pixels.shape(2) != 4 || pixels.size() == 0) {
        throw Error("image of '" + name + "': shape " + shape_text(pixels) +
                    ", must be (height, width, 4)");
    }
    Image image{name, static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)), {}};
    image.rgba.assign(pixels.data(), pixels.data() + pixels.size());
    return image;
}

}  // namespace kilolux
