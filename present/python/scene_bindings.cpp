// SPDX-License-Identifier: Apache-2.0
#include "present/python/scene_bindings.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "host/base/error.h"
#include "host/scene/lights/light_kinds.h"
#include "present/python/arrays.h"

namespace py = pybind11;

namespace kilolux {
namespace {

using Lights = std::vector<SceneLight>;

// The matrix of 16 values, row by row as numpy has them.
glm::dmat4 matrix_of(const Array<double>& values) {
    if (values.size() != 16) throw Error("mesh: world_from_object must have the shape (4, 4)");
    glm::dmat4 out;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            out[column][row] = values.data()[4 * row + column];
        }
    }
    return out;
}

glm::vec3 colour_of(const py::tuple& rgb) {
    return {rgb[0].cast<float>(), rgb[1].cast<float>(), rgb[2].cast<float>()};
}

// Adds a texture for the image.
TextureUse add_texture(Scene& scene, Image image) {
    scene.images.push_back(std::move(image));
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, {}});
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

void add_material(Scene& scene, const py::dict& made) {
    Material material;
    material.name = made["name"].cast<std::string>();
    material.base_color = glm::vec4(colour_of(made["base_color"]), 1.0f);
    material.metallic = made["metallic"].cast<float>();
    material.roughness = made["roughness"].cast<float>();
    material.emissive = colour_of(made["emissive"]);
    material.double_sided = made["double_sided"].cast<bool>();
    material.unlit = made["unlit"].cast<bool>();
    const auto texture = [&](const char* key) {
        if (made[key].is_none()) return TextureUse();
        return add_texture(scene, image_of(material.name, made[key].cast<Array<std::uint8_t>>()));
    };
    material.base_color_texture = texture("base_color_image");
    material.metallic_roughness_texture = texture("metallic_roughness_image");
    material.emissive_texture = texture("emissive_image");
    scene.materials.push_back(std::move(material));
}

void add_mesh(Scene& scene, const MeshArrays& arrays, int material,
              const Array<double>& world_from_object) {
    Mesh mesh = mesh_of(arrays);
    const int known = static_cast<int>(scene.materials.size());
    if (material < 0 || material >= known) {
        throw Error(fmt::format("mesh '{}': material {} is none of the scene's {}", mesh.name,
                                material, known));
    }
    mesh.material = material;
    scene.instances.push_back(
        {static_cast<int>(scene.meshes.size()), matrix_of(world_from_object)});
    scene.meshes.push_back(std::move(mesh));
}

}  // namespace

void add_scenes(py::module_& module) {
    py::class_<Lights>(module, "Lights")
        .def(py::init<>())
        .def("extend",
             [](Lights& to, const Lights& more) { to.insert(to.end(), more.begin(), more.end()); });
    module.def("lights", lights_of);
    module.def("light_numbers", [] {
        std::vector<std::string> names;
        for (const LightNumber& number : kLightNumbers) names.emplace_back(number.name);
        return names;
    });
    py::class_<Scene>(module, "Scene")
        .def(py::init([](const std::string& name) {
            Scene scene;
            scene.name = name;
            return scene;
        }))
        .def("add_material", add_material)
        .def("add_mesh", [](Scene& scene, const std::string& name, const Array<float>& positions,
                            const Array<float>& normals, const Array<float>& texcoords,
                            const Array<float>& colors, const Array<std::int64_t>& indices,
                            int material, const Array<double>& world_from_object) {
            add_mesh(scene, {name, positions, normals, texcoords, colors, indices}, material,
                     world_from_object);
        });
}

}  // namespace kilolux
