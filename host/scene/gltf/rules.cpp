// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/rules.h"

#include <utility>

#include "host/scene/gltf/mesh/meshopt.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/material_table.h"

namespace kilolux {
namespace {

using Rules = std::vector<GltfRule>;

// 2^53, the largest integer range that a double holds exactly. Sizes below it that do not fit are
// refused later, with a better message.
constexpr double kMaxBytes = 9007199254740992.0;
constexpr double kMaxInt = 2147483647.0;
constexpr double kMaxCount = 4294967294.0;  // indices are 32 bits, and one value is for restarts

GltfRule object(std::string path) { return {.path = std::move(path), .kind = JsonKind::object}; }
GltfRule array(std::string path) { return {.path = std::move(path), .kind = JsonKind::array}; }
GltfRule text(std::string path) { return {.path = std::move(path), .kind = JsonKind::text}; }
GltfRule boolean(std::string path) { return {.path = std::move(path), .kind = JsonKind::boolean}; }
GltfRule number(std::string path) { return {.path = std::move(path), .kind = JsonKind::number}; }
GltfRule integer(std::string path, double min, double max) {
    return {.path = std::move(path), .kind = JsonKind::integer, .min = min, .max = max};
}
GltfRule index(std::string path, std::string target) {
    return {.path = std::move(path), .kind = JsonKind::index, .target = std::move(target)};
}
GltfRule numbers(std::string path, std::size_t length) {
    return {.path = std::move(path), .kind = JsonKind::numbers, .length = length};
}
GltfRule choice(std::string path, std::vector<std::string> allowed) {
    return {.path = std::move(path), .kind = JsonKind::choice, .allowed = std::move(allowed)};
}
GltfRule required(GltfRule rule) {
    rule.required = true;
    return rule;
}

GltfRule multiple_of(int factor, GltfRule rule) {
    rule.multiple_of = factor;
    return rule;
}
// A rule for objects that have that "type".
GltfRule where_type(std::string type, GltfRule rule) {
    rule.where_type = std::move(type);
    return rule;
}

Rules buffer_rules() {
    Rules rules = {
        required(integer("buffers[].byteLength", 0, kMaxBytes)),
        text("buffers[].uri"),
        required(index("bufferViews[].buffer", "/buffers")),
        integer("bufferViews[].byteOffset", 0, kMaxBytes),
        required(integer("bufferViews[].byteLength", 0, kMaxBytes)),
        multiple_of(4, integer("bufferViews[].byteStride", 0, 252)),
    };
    for (const std::string_view name : kMeshoptExtensions) {
        const std::string extension = ".extensions." + std::string(name) + ".";
        const std::string view = "bufferViews[]" + extension;
        const Rules more = {
            boolean("buffers[]" + extension + "fallback"),
            required(index(view + "buffer", "/buffers")),
            integer(view + "byteOffset", 0, kMaxInt),
            required(integer(view + "byteLength", 0, kMaxInt)),
            required(integer(view + "byteStride", 1, 256)),
            required(integer(view + "count", 0, kMaxInt)),
            required(choice(view + "mode", {"ATTRIBUTES", "TRIANGLES", "INDICES"})),
            choice(view + "filter", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"}),
        };
        rules.insert(rules.end(), more.begin(), more.end());
    }
    return rules;
}

Rules accessor_rules() {
    return {
        index("accessors[].bufferView", "/bufferViews"),
        integer("accessors[].byteOffset", 0, kMaxBytes),
        required(choice("accessors[].componentType",
                        {"5120", "5121", "5122", "5123", "5125", "5126", "5130"})),
        required(integer("accessors[].count", 0, kMaxCount)),
        required(
            choice("accessors[].type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})),
        boolean("accessors[].normalized"),
        required(integer("accessors[].sparse.count", 0, kMaxInt)),
        required(index("accessors[].sparse.indices.bufferView", "/bufferViews")),
        integer("accessors[].sparse.indices.byteOffset", 0, kMaxInt),
        required(choice("accessors[].sparse.indices.componentType", {"5121", "5123", "5125"})),
        required(index("accessors[].sparse.values.bufferView", "/bufferViews")),
        integer("accessors[].sparse.values.byteOffset", 0, kMaxInt),
        required(object("accessors[].sparse.indices")),
        required(object("accessors[].sparse.values")),
    };
}

Rules node_rules() {
    const std::string ies = "nodes[].extensions.EXT_lights_ies.";
    const std::string instancing = "nodes[].extensions.EXT_mesh_gpu_instancing";
    return {
        index("scene", "/scenes"),
        index("scenes[].nodes[]", "/nodes"),
        index("nodes[].children[]", "/nodes"),
        index("nodes[].mesh", "/meshes"),
        index("nodes[].skin", "/skins"),
        index("nodes[].camera", "/cameras"),
        numbers("nodes[].matrix", 16),
        numbers("nodes[].translation", 3),
        numbers("nodes[].rotation", 4),
        numbers("nodes[].scale", 3),
        numbers("nodes[].weights", 0),
        required(index(ies + "light", "/extensions/EXT_lights_ies/lights")),
        number(ies + "multiplier"),
        numbers(ies + "color", 3),
        boolean("nodes[].extensions.KHR_node_visibility.visible"),
        required(object(instancing + ".attributes")),
        index(instancing + ".attributes{}", "/accessors"),
        required(array("skins[].joints")),
        index("skins[].joints[]", "/nodes"),
        index("skins[].inverseBindMatrices", "/accessors"),
    };
}

Rules mesh_rules() {
    const std::string primitive = "meshes[].primitives[].";
    const std::string draco = primitive + "extensions.KHR_draco_mesh_compression.";
    return {
        object("meshes[]"),
        required(object(primitive + "attributes")),
        index(primitive + "attributes{}", "/accessors"),
        index(primitive + "indices", "/accessors"),
        index(primitive + "material", "/materials"),
        integer(primitive + "mode", 0, 6),
        index(primitive + "targets[]{}", "/accessors"),
        numbers("meshes[].weights", 0),
        required(index(draco + "bufferView", "/bufferViews")),
        required(object(draco + "attributes")),
        integer(draco + "attributes{}", 0, kMaxInt),
    };
}

void append_texture_use(Rules& rules, const std::string& slot) {
    const std::string transform = slot + ".extensions.KHR_texture_transform.";
    rules.push_back(required(index(slot + ".index", "/textures")));
    rules.push_back(integer(slot + ".texCoord", 0, kMaxInt));
    rules.push_back(numbers(transform + "offset", 2));
    rules.push_back(number(transform + "rotation"));
    rules.push_back(numbers(transform + "scale", 2));
    rules.push_back(integer(transform + "texCoord", 0, kMaxInt));
}

Rules material_rules() {
    const std::string material = "materials[].";
    const std::string extensions = material + "extensions.";
    const std::string glossiness = extensions + "KHR_materials_pbrSpecularGlossiness.";
    Rules rules = {
        object("materials[]"),
        object("materials[].pbrMetallicRoughness"),
        object("materials[].extensions"),
        object(extensions + "KHR_materials_unlit"),
        choice("materials[].alphaMode", {"OPAQUE", "MASK", "BLEND"}),
        boolean("materials[].doubleSided"),
        number(extensions + "KHR_materials_emissive_strength.emissiveStrength"),
        numbers(glossiness + "diffuseFactor", 4),
        numbers(glossiness + "specularFactor", 3),
        number(glossiness + "glossinessFactor"),
    };
    for (const MaterialFactor& factor : kMaterialFactors) {
        const std::string path = material + std::string(factor.path);
        const std::size_t length = factor_length(factor);
        rules.push_back(length == 1 ? number(path) : numbers(path, length));
    }
    for (const MaterialMap& map : kMaterialMaps) {
        append_texture_use(rules, material + std::string(map.path));
    }
    append_texture_use(rules, glossiness + "diffuseTexture");
    append_texture_use(rules, glossiness + "specularGlossinessTexture");
    return rules;
}

Rules variant_rules() {
    const std::string root = "extensions.KHR_materials_variants.variants";
    const std::string mapping =
        "meshes[].primitives[].extensions.KHR_materials_variants.mappings[].";
    return {
        required(text(root + "[].name")),
        required(index(mapping + "material", "/materials")),
        index(mapping + "variants[]", "/extensions/KHR_materials_variants/variants"),
    };
}

Rules texture_rules() {
    return {
        object("images[]"),
        text("images[].uri"),
        text("images[].mimeType"),
        index("images[].bufferView", "/bufferViews"),
        object("textures[]"),
        index("textures[].source", "/images"),
        index("textures[].sampler", "/samplers"),
        index("textures[].extensions.EXT_texture_webp.source", "/images"),
        object("samplers[]"),
        choice("samplers[].magFilter", {"9728", "9729"}),
        choice("samplers[].minFilter", {"9728", "9729", "9984", "9985", "9986", "9987"}),
        choice("samplers[].wrapS", {"33071", "33648", "10497"}),
        choice("samplers[].wrapT", {"33071", "33648", "10497"}),
    };
}

Rules light_rules(std::size_t e) {
    const std::string_view extension = kLightExtensions[e];
    const std::string place = "extensions." + std::string(extension);
    const std::string light = place + ".lights[].";
    std::vector<std::string> names;
    for (const LightKind& kind : kLightKinds) {
        if (kind.extension == extension && !kind.has_radius) names.emplace_back(kind.name_in_file);
    }
    Rules rules = {
        index("nodes[]." + place + ".light", "/extensions/" + std::string(extension) + "/lights"),
        required(choice(light + "type", names)),
        numbers(light + "color", 3),
        number(light + "intensity"),
    };
    const auto add_number = [&](std::string_view path) {
        if (!path.empty() && !is_extra(path)) rules.push_back(number(light + std::string(path)));
    };
    for (const LightNumber& of_light : kLightNumbers) add_number(of_light.paths[e]);
    for (const LightKind& kind : kLightKinds) {
        if (kind.extension == extension) add_number(kind.aspect_in_file);
    }
    return rules;
}

Rules camera_and_profile_rules() {
    const std::string profile = "extensions.EXT_lights_ies.lights[].";
    return {
        required(choice("cameras[].type", {"perspective", "orthographic"})),
        where_type("perspective", required(object("cameras[].perspective"))),
        where_type("orthographic", required(object("cameras[].orthographic"))),
        required(number("cameras[].perspective.yfov")),
        required(number("cameras[].perspective.znear")),
        number("cameras[].perspective.zfar"),
        number("cameras[].perspective.aspectRatio"),
        required(number("cameras[].orthographic.xmag")),
        required(number("cameras[].orthographic.ymag")),
        required(number("cameras[].orthographic.znear")),
        required(number("cameras[].orthographic.zfar")),
        text(profile + "uri"),
        text(profile + "name"),
        index(profile + "bufferView", "/bufferViews"),
        choice(profile + "mimeType", {"application/x-ies-lm-63"}),
    };
}

Rules animation_rules() {
    return {
        object("animations[]"),
        required(integer("animations[].channels[].sampler", 0, kMaxInt)),
        required(object("animations[].channels[].target")),
        index("animations[].channels[].target.node", "/nodes"),
        required(text("animations[].channels[].target.path")),
        required(text("animations[].channels[].target.extensions.KHR_animation_pointer.pointer")),
        required(index("animations[].samplers[].input", "/accessors")),
        required(index("animations[].samplers[].output", "/accessors")),
        choice("animations[].samplers[].interpolation", {"LINEAR", "STEP", "CUBICSPLINE"}),
    };
}

}  // namespace

std::vector<GltfRule> gltf_rules() {
    Rules rules = {
        required(object("asset")), required(text("asset.version")), text("asset.minVersion"),
        text("extensionsUsed[]"),  text("extensionsRequired[]"),
    };
    const auto add = [&rules](const Rules& part) {
        rules.insert(rules.end(), part.begin(), part.end());
    };
    for (const auto part :
         {buffer_rules, accessor_rules, node_rules, mesh_rules, material_rules, variant_rules,
          texture_rules, camera_and_profile_rules, animation_rules})
        add(part());
    for (std::size_t e = 0; e < kLightExtensions.size(); ++e) add(light_rules(e));
    return rules;
}

}  // namespace kilolux
