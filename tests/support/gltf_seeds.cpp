// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gltf_seeds.h"

#include "tests/support/gltf_compressed.h"
#include "tests/support/ies_text.h"

namespace kilolux {
namespace {

using nlohmann::json;

json transform(double offset, double rotation, double scale) {
    return {{"KHR_texture_transform",
             {{"offset", {offset, 1}}, {"rotation", rotation}, {"scale", {scale, 2}}}}};
}

// Node 0: a quad with a normal map, a skin, a morph target with a sparse part, an animated joint.
GltfBuilder deformed_quad() {
    GltfBuilder file = quad_with_normal_map();
    json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_0"] = file.add_accessor(Blob(16), {kUnsignedByte, "VEC4", 4, false, 0});
    attributes["WEIGHTS_0"] =
        file.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    attributes["COLOR_0"] = file.add_accessor(Blob(16, 200), {kUnsignedByte, "VEC4", 4, true, 0});
    attributes["TEXCOORD_1"] = file.add_floats("VEC2", {0, 2, 2, 2, 2, 0, 0, 0});
    const int delta = file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.primitive()["targets"] = {{{"POSITION", delta}}};
    file.root["accessors"][static_cast<std::size_t>(delta)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", file.add_view(Blob{2})}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", file.add_view(Blob(12))}}}};
    file.root["meshes"][0]["weights"] = {0.5};
    file.add("skins", {{"joints", {1}}});
    file.root["nodes"][0]["skin"] = 0;
    file.add_node({{"children", {2}}});
    file.add("nodes", {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1}}});
    const int input = file.add_floats("SCALAR", {0, 1, 2});
    const int output = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0});
    file.add(
        "animations",
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    return file;
}

// material 0 has every texture slot and factor; 1 is unlit and blended.
void add_materials(GltfBuilder& file) {
    const int jpeg = file.add_texture(encode_image("jpeg", 8, 3, Blob(192, 90)), "image/jpeg");
    const int webp = file.add_texture(webp_image(), "image/webp");
    json& texture = file.root["textures"][static_cast<std::size_t>(webp)];
    texture["extensions"]["EXT_texture_webp"]["source"] = texture["source"];
    texture.erase("source");
    texture["sampler"] =
        file.add("samplers", {{"wrapS", 33071}, {"magFilter", 9728}, {"minFilter", 9985}});
    json& all = file.root["materials"][0];
    all["name"] = "everything";
    all["pbrMetallicRoughness"] = {
        {"baseColorTexture", {{"index", webp}}},
        {"baseColorFactor", {0.5, 0.25, 1, 0.75}},
        {"metallicFactor", 0.5},
        {"roughnessFactor", 0.25},
        {"metallicRoughnessTexture", {{"index", jpeg}, {"texCoord", 1}}}};
    all["normalTexture"]["extensions"] = transform(0, 1, 2);
    all["occlusionTexture"] = {{"index", jpeg}, {"strength", 0.5}};
    all["emissiveTexture"] = {{"index", jpeg}};
    all["emissiveFactor"] = {1, 0.5, 0};
    all["alphaMode"] = "MASK";
    all["alphaCutoff"] = 0.25;
    all["doubleSided"] = true;
    all["extensions"] = {
        {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
        {"KHR_materials_ior", {{"ior", 1.25}}},
        {"KHR_materials_specular",
         {{"specularFactor", 0.5},
          {"specularColorFactor", {1, 0.5, 2}},
          {"specularTexture", {{"index", webp}, {"extensions", transform(0.5, 0, 1)}}},
          {"specularColorTexture", {{"index", jpeg}, {"texCoord", 1}}}}},
        {"KHR_materials_clearcoat",
         {{"clearcoatFactor", 0.75},
          {"clearcoatTexture", {{"index", webp}}},
          {"clearcoatRoughnessFactor", 0.125},
          {"clearcoatRoughnessTexture", {{"index", jpeg}, {"texCoord", 1}}},
          {"clearcoatNormalTexture", {{"index", webp}, {"scale", 0.5}}}}},
        {"KHR_materials_sheen",
         {{"sheenColorFactor", {0.5, 0.25, 1}},
          {"sheenColorTexture", {{"index", jpeg}, {"texCoord", 1}}},
          {"sheenRoughnessFactor", 0.375},
          {"sheenRoughnessTexture", {{"index", webp}}}}},
        {"KHR_materials_anisotropy",
         {{"anisotropyStrength", 0.75},
          {"anisotropyRotation", -4.5},
          {"anisotropyTexture", {{"index", jpeg}}}}},
        {"KHR_materials_transmission",
         {{"transmissionFactor", 0}, {"transmissionTexture", {{"index", webp}}}}},
        {"KHR_materials_volume",
         {{"thicknessFactor", 0.25},
          {"thicknessTexture", {{"index", jpeg}, {"texCoord", 1}}},
          {"attenuationDistance", 0.5},
          {"attenuationColor", {0.5, 0.25, 1}}}}};
    file.add("materials", {{"name", "lamp"},
                           {"alphaMode", "BLEND"},
                           {"extensions", {{"KHR_materials_unlit", json::object()}}}});
}

// A mesh of a strip and a fan of four quantized vertices, without normals, in two nodes.
void add_strip_and_fan(GltfBuilder& file) {
    const int positions = file.add_accessor(bytes_of<std::int16_t>({0, 0, 0, 0, 4, 0, 0, 0,  //
                                                                    0, 4, 0, 0, 4, 4, 0, 0}),
                                            {kShort, "VEC3", 4, false, 8});
    json strip = {{"attributes", {{"POSITION", positions}}}, {"mode", 5}, {"material", 1}};
    json fan = strip;
    fan["mode"] = 6;
    const int mesh = file.add("meshes", {{"name", "ribbon"}, {"primitives", {strip, fan}}});
    file.add_node({{"mesh", mesh}, {"scale", {0.25, 0.25, 0.25}}});
    file.add_node({{"mesh", mesh}, {"rotation", {0, 0, 1, 0}}, {"translation", {0, 0, -4}}});
}

void add_lights_and_cameras(GltfBuilder& file) {
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 30}},
        {{"type", "spot"}, {"color", {1, 0.5, 0}}, {"range", 3}, {"spot", {{"outerConeAngle", 1}}}},
        {{"type", "directional"}, {"intensity", 500}}};
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    file.add("cameras", {{"type", "orthographic"},
                         {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}});
    for (int i = 0; i < 3; ++i) {
        json node = {{"translation", {i, 2, 0}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}};
        if (i < 2) node["camera"] = i;
        file.add_node(node);
    }
}

// A hidden node above a mesh, a light and a camera.
void add_hidden_nodes(GltfBuilder& file) {
    file.add_node({{"mesh", 0},
                   {"camera", 0},
                   {"translation", {0, 3, 0}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    json& nodes = file.root["nodes"];
    file.root["scenes"][0]["nodes"].back() = nodes.size();
    file.add("nodes", {{"children", {nodes.size() - 1}},
                       {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
}

}  // namespace

const Blob& webp_image() {
    static const Blob bytes = {0x52, 0x49, 0x46, 0x46, 0x1e, 0,    0,    0,    0x57, 0x45,
                               0x42, 0x50, 0x56, 0x50, 0x38, 0x4c, 0x11, 0,    0,    0,
                               0x2f, 0x03, 0xc0, 0,    0x10, 0x07, 0x50, 0xb2, 0x22, 0x57,
                               0xa6, 0x40, 0x81, 0x88, 0xe8, 0x7f, 0,    0};
    return bytes;
}

GltfBuilder every_feature_file() {
    GltfBuilder file = deformed_quad();
    add_materials(file);
    add_strip_and_fan(file);
    add_lights_and_cameras(file);
    add_hidden_nodes(file);
    add_meshopt_quad(file, "TRIANGLES");
    add_draco_quad(file, draco_quad(kDracoEdgebreaker));
    add_fallback_buffer(file);
    file.root["extensionsRequired"] = {
        "KHR_lights_punctual",        "KHR_texture_transform",
        "KHR_mesh_quantization",      "KHR_materials_emissive_strength",
        "KHR_materials_unlit",        "KHR_materials_ior",
        "KHR_materials_specular",     "KHR_materials_clearcoat",
        "KHR_materials_sheen",        "KHR_materials_anisotropy",
        "KHR_materials_transmission", "KHR_materials_volume",
        "EXT_meshopt_compression",    "KHR_draco_mesh_compression",
        "EXT_texture_webp",           "KHR_node_visibility"};
    file.root["extensionsUsed"] = file.root["extensionsRequired"];
    return file;
}

// Quads of all modes of points and lines, lit and not.
void add_points_and_lines(GltfBuilder& file) {
    for (int mode = 0; mode < 4; ++mode) {
        json primitive = file.primitive();
        primitive["mode"] = mode;
        if (mode % 2 == 0) primitive["attributes"].erase("NORMAL");
        const int mesh = file.add("meshes", {{"primitives", {primitive}}});
        file.add_node({{"mesh", mesh}, {"translation", {mode, 2, 0}}});
    }
}

// A light with an IES file, in a node that is turned, and one with its own colour.
void add_profile_lights(GltfBuilder& file) {
    const std::string text = ies_text({.horizontal = {0, 45, 90}});
    const int view = file.add_view(Blob(text.begin(), text.end()));
    file.root["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"bufferView", view}, {"mimeType", "application/x-ies-lm-63"}, {"name", "lamp"}}};
    file.add_node({{"translation", {0, 3, 0}},
                   {"rotation", {-0.6, 0, 0, 0.8}},
                   {"extensions", {{"EXT_lights_ies", {{"light", 0}}}}}});
    file.add_node(
        {{"extensions",
          {{"EXT_lights_ies", {{"light", 0}, {"multiplier", 2}, {"color", {0.5, 1, 0.25}}}}}}});
}

// A clip that drives a colour of material 0 and the visibility of node 1.
void add_pointers(GltfBuilder& file) {
    const std::string visible = "/nodes/1/extensions/KHR_node_visibility/visible";
    file.root[json::json_pointer(visible)] = true;
    const int input = file.add_floats("SCALAR", {0, 1});
    const int colors = file.add_accessor(bytes_of<double>({0.5, 1, 1, 0.75, 0, 0, 0, 1}),
                                         {kDouble, "VEC4", 2, false, 0});
    const int shown = file.add_accessor({1, 0}, {kUnsignedByte, "SCALAR", 2, false, 0});
    json clip = {{"samplers",
                  {{{"input", input}, {"output", colors}},
                   {{"input", input}, {"output", shown}, {"interpolation", "STEP"}}}}};
    for (const std::string& pointer :
         {std::string("/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor"),
          visible}) {
        const json extension = {{"KHR_animation_pointer", {{"pointer", pointer}}}};
        clip["channels"].push_back({{"sampler", clip.value("channels", json::array()).size()},
                                    {"target", {{"path", "pointer"}, {"extensions", extension}}}});
    }
    file.add("animations", clip);
}

std::filesystem::path write_with_files(GltfBuilder file, const std::filesystem::path& folder) {
    std::filesystem::create_directory(folder / "my maps");
    json& images = file.root["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
        const json& view = file.root["bufferViews"][images[i]["bufferView"].get<std::size_t>()];
        const auto first = file.bin.begin() + view["byteOffset"].get<std::ptrdiff_t>();
        const std::string name = "my maps/image " + std::to_string(i);
        write_file(folder / name, Blob(first, first + view["byteLength"].get<std::ptrdiff_t>()));
        images[i] = {{"uri", i == 0 ? name : "my%20maps/image%20" + std::to_string(i)}};
    }
    write_file(folder / "all data.bin", file.bin);
    file.root["buffers"][0]["uri"] = "all%20data.bin";
    write_file(folder / "scene.gltf", file.root.dump());
    return folder / "scene.gltf";
}

GltfBuilder converted_features_file() {
    GltfBuilder file = quad_with_normal_map();
    add_points_and_lines(file);
    file.add_texture(encode_image("png", 4, 4, Blob(64, 90)), "image/png");
    file.add_texture(encode_image("png", 2, 4, Blob(16, 200)), "image/png");
    file.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
        {"diffuseFactor", {0.5, 1, 1, 0.75}},
        {"diffuseTexture", {{"index", 1}}},
        {"specularFactor", {1, 0.5, 0.25}},
        {"glossinessFactor", 0.5},
        {"specularGlossinessTexture", {{"index", 2}, {"extensions", transform(0.5, 0, 1)}}}};
    file.add("materials", {{"extensions",
                            {{"KHR_materials_pbrSpecularGlossiness", {{"glossinessFactor", 1}}},
                             {"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
    file.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {0, 1}}}};
    file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "a"}},
                                                                     {{"name", "b"}}};
    const int shifts = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0});
    const int turns = file.add_accessor(Blob(24, 64), {kShort, "VEC4", 3, true, 0});
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", shifts}, {"ROTATION", turns}};
    add_profile_lights(file);
    add_pointers(file);
    file.root["extensionsRequired"] = {"EXT_lights_ies",
                                       "KHR_materials_pbrSpecularGlossiness",
                                       "KHR_materials_variants",
                                       "EXT_mesh_gpu_instancing",
                                       "KHR_materials_transmission",
                                       "KHR_node_visibility",
                                       "KHR_animation_pointer",
                                       "KHR_accessor_float64"};
    file.root["extensionsUsed"] = file.root["extensionsRequired"];
    return file;
}

std::vector<GltfBuilder> gltf_seeds() {
    return {every_feature_file(),
            converted_features_file(),
            deformed_quad(),
            triangle_file(),
            meshopt_quad("TRIANGLES"),
            meshopt_quad("INDICES"),
            khr_meshopt_quad(),
            draco_file(draco_quad(kDracoEdgebreaker)),
            draco_file(draco_quad(kDracoSequential))};
}

}  // namespace kilolux
