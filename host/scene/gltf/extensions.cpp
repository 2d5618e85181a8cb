// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/extensions.h"

#include <algorithm>
#include <array>

#include "host/base/log.h"

namespace kilolux {
namespace {

constexpr std::array<std::string_view, 10> kSupported = {
    "KHR_lights_punctual",        "KHR_texture_transform",
    "KHR_mesh_quantization",      "KHR_materials_emissive_strength",
    "KHR_materials_unlit",        "KHR_materials_ior",
    "KHR_materials_specular",     "EXT_meshopt_compression",
    "KHR_draco_mesh_compression", "EXT_texture_webp",
};

bool is_supported(const std::string& name) {
    return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

}  // namespace

void check_extensions(const GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    for (const std::string& name : model.extensionsRequired) {
        if (is_supported(name)) continue;
        document.fail("extensionsRequired",
                      "the file needs '{}', which is not supported; convert it with gltfpack or "
                      "gltf-transform",
                      shown_uri(name));
    }
    for (const std::string& name : model.extensionsUsed) {
        if (is_supported(name)) continue;
        warn(document.base.file + ": extension '" + shown_uri(name) +
             "' is not supported and is left out");
    }
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

std::vector<double> numbers_member(const tinygltf::Value& object, const std::string& key) {
    std::vector<double> numbers;
    if (!object.Has(key)) return numbers;
    const tinygltf::Value& array = object.Get(key);
    for (std::size_t i = 0; i < array.ArrayLen(); ++i) {
        numbers.push_back(array.Get(static_cast<int>(i)).GetNumberAsDouble());
    }
    return numbers;
}

}  // namespace kilolux
