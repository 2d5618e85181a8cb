// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gltf_builder.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "host/base/error.h"
#include "host/images/images.h"

namespace kilolux {
namespace {

using nlohmann::json;

std::string base64(const Blob& bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63u];
        }
    }
    return out;
}

void append_u32(Blob& out, std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
        out.push_back(static_cast<unsigned char>(value >> shift & 255u));
    }
}

void append_chunk(Blob& out, const char* type, Blob bytes, unsigned char padding,
                  std::size_t excess = 0) {
    while (bytes.size() % 4 != excess) bytes.push_back(padding);
    append_u32(out, bytes.size());
    out.insert(out.end(), type, type + 4);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

bool all_finite(const float* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(values[i])) return false;
    }
    return true;
}

template <typename V>
std::string array_defect(const std::vector<V>& array, const Mesh& mesh, const char* name) {
    if (!array.empty() && array.size() != mesh.positions.size()) {
        return std::string(name) + " has another length than positions";
    }
    if (!all_finite(reinterpret_cast<const float*>(array.data()), array.size() * V::length())) {
        return std::string(name) + " is not finite";
    }
    return "";
}

bool is_unit(const glm::vec3& v) { return std::abs(glm::length(v) - 1.0f) < 1e-4f; }

std::string mesh_defect(const Mesh& mesh, std::size_t material_count) {
    const std::string defects[] = {array_defect(mesh.positions, mesh, "positions"),
                                   array_defect(mesh.normals, mesh, "normals"),
                                   array_defect(mesh.tangents, mesh, "tangents"),
                                   array_defect(mesh.colors, mesh, "colors"),
                                   array_defect(mesh.texcoords[0], mesh, "texcoords[0]"),
                                   array_defect(mesh.texcoords[1], mesh, "texcoords[1]")};
    for (const std::string& defect : defects) {
        if (!defect.empty()) return defect;
    }
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) return "indices are no triangles";
    if (mesh.normals.empty()) return "no normals";
    for (const std::uint32_t index : mesh.indices) {
        if (index >= mesh.positions.size()) return "index out of range";
    }
    for (const glm::vec3& normal : mesh.normals) {
        if (!is_unit(normal)) return "normal is not unit";
    }
    for (const glm::vec4& tangent : mesh.tangents) {
        if (!is_unit(glm::vec3(tangent)) || std::abs(tangent.w) != 1.0f)
            return "tangent is not unit";
    }
    if (mesh.material < -1 || mesh.material >= static_cast<int>(material_count)) {
        return "material out of range";
    }
    return "";
}

Blob encode_samples(const std::string& format, int width, int channels, SampleType type,
                    const Blob& bytes) {
    const std::size_t stride = static_cast<std::size_t>(channels) * size_of(type);
    const std::size_t row = static_cast<std::size_t>(width) * stride;
    ImageLayout layout{width, static_cast<int>(bytes.size() / row), {}};
    const char* const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < channels; ++c) {
        layout.channels.push_back({channels == 1 ? "Y" : names[c], type});
    }
    return encode_pixels("image", format, layout, bytes, stride);
}

}  // namespace

void write_file(const std::filesystem::path& file, const Blob& bytes) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
}

void write_file(const std::filesystem::path& file, const std::string& text) {
    write_file(file, Blob(text.begin(), text.end()));
}

int GltfBuilder::add(const char* array, const json& element) {
    root[array].push_back(element);
    return static_cast<int>(root[array].size()) - 1;
}

int GltfBuilder::add_view(const Blob& bytes, std::size_t stride) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    return add("bufferViews", view);
}

int GltfBuilder::add_accessor(const Blob& bytes, const Layout& layout) {
    json accessor = {{"bufferView", add_view(bytes, layout.stride)},
                     {"componentType", layout.component_type},
                     {"type", layout.type},
                     {"count", layout.count}};
    if (layout.normalized) accessor["normalized"] = true;
    return add("accessors", accessor);
}

int GltfBuilder::add_floats(const std::string& type, const std::vector<float>& values) {
    const std::size_t components = type == "SCALAR" ? 1
                                   : type == "MAT4" ? 16
                                                    : static_cast<std::size_t>(type[3] - '0');
    return add_accessor(bytes_of(values), {kFloat, type, values.size() / components, false, 0});
}

int GltfBuilder::add_indices(const std::vector<std::uint16_t>& values) {
    return add_accessor(bytes_of(values), {kUnsignedShort, "SCALAR", values.size(), false, 0});
}

int GltfBuilder::add_node(const json& node) {
    const int index = add("nodes", node);
    root["scene"] = 0;
    root["scenes"][0]["nodes"].push_back(index);
    return index;
}

int GltfBuilder::add_texture(const Blob& encoded_image, const std::string& mime_type) {
    const int image =
        add("images", {{"bufferView", add_view(encoded_image)}, {"mimeType", mime_type}});
    return add("textures", {{"source", image}});
}

json& GltfBuilder::primitive(std::size_t mesh, std::size_t primitive) {
    return root["meshes"][mesh]["primitives"][primitive];
}

std::string GltfBuilder::gltf() const {
    json out = root;
    if (!bin.empty() && !out.contains("buffers")) {
        out["buffers"] = {{{"byteLength", bin.size()},
                           {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
    }
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

Blob GltfBuilder::glb(bool padded) const {
    json json_part = root;
    if (!bin.empty() && !json_part.contains("buffers")) {
        json_part["buffers"] = {{{"byteLength", bin.size()}}};
    }
    const std::string text = json_part.dump();
    Blob chunks;
    append_chunk(chunks, "JSON", Blob(text.begin(), text.end()), ' ', padded ? 0 : 1);
    if (!bin.empty()) append_chunk(chunks, "BIN\0", bin, 0);
    Blob out = {'g', 'l', 'T', 'F'};
    append_u32(out, 2);
    append_u32(out, 12 + chunks.size());
    out.insert(out.end(), chunks.begin(), chunks.end());
    return out;
}

GltfBuilder triangle_file() {
    GltfBuilder file;
    const int positions = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int normals = file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.add("meshes",
             {{"primitives", {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}}}}});
    file.add_node({{"mesh", 0}});
    return file;
}

GltfBuilder quad_with_normal_map() {
    GltfBuilder file;
    const int positions = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    const int normals = file.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int texcoords = file.add_floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
    const int indices = file.add_indices({0, 1, 2, 0, 2, 3});
    file.add("meshes",
             {{"primitives",
               {{{"attributes",
                  {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", texcoords}}},
                 {"indices", indices},
                 {"material", 0}}}}});
    const int texture = file.add_texture(encode_image("png", 1, 3, {128, 128, 255}), "image/png");
    file.add("materials", {{"normalTexture", {{"index", texture}}}});
    file.add_node({{"mesh", 0}});
    return file;
}

Scene load(const GltfBuilder& builder, const LoadOptions& options) {
    const TempFolder folder;
    write_file(folder.path() / "scene.gltf", builder.gltf());
    return load_scene(folder.path() / "scene.gltf", options);
}

std::string load_error(const std::filesystem::path& file, const LoadOptions& options) {
    try {
        load_scene(file, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::string load_error(const GltfBuilder& builder) {
    const TempFolder folder;
    write_file(folder.path() / "scene.gltf", builder.gltf());
    return load_error(folder.path() / "scene.gltf");
}

Blob encode_image(const std::string& format, int width, int channels, const Blob& pixels) {
    return encode_samples(format, width, channels, SampleType::uint8, pixels);
}

Blob encode_deep_image(const std::string& format, int width, int channels,
                       const std::vector<std::uint16_t>& pixels) {
    return encode_samples(format, width, channels, SampleType::uint16, bytes_of(pixels));
}

std::vector<glm::dvec3> world_positions(const Scene& scene, std::size_t instance) {
    const Instance& use = scene.instances.at(instance);
    std::vector<glm::dvec3> out;
    for (const glm::vec3& p : scene.meshes.at(static_cast<std::size_t>(use.mesh)).positions) {
        out.emplace_back(use.world_from_object * glm::dvec4(glm::dvec3(p), 1.0));
    }
    return out;
}

std::string scene_defect(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        const std::string defect = mesh_defect(mesh, scene.materials.size());
        if (!defect.empty()) return defect;
    }
    for (const Instance& instance : scene.instances) {
        if (instance.mesh < 0 || instance.mesh >= static_cast<int>(scene.meshes.size())) {
            return "instance's mesh out of range";
        }
    }
    for (const Texture& texture : scene.textures) {
        if (texture.image < 0 || texture.image >= static_cast<int>(scene.images.size())) {
            return "texture's image out of range";
        }
    }
    for (const Image& image : scene.images) {
        const auto pixels =
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
        if (image.width < 1 || image.height < 1 ||
            image.rgba.size() + image.rgba16.size() != 4 * pixels) {
            return "image of a wrong size";
        }
    }
    for (const SceneLight& light : scene.lights) {
        const auto profile = static_cast<std::size_t>(light.profile);
        if (light.profile < 0) continue;
        if (profile >= scene.aimed_profiles.size() ||
            scene.aimed_profiles[profile].web >= scene.webs.size()) {
            return "light's profile out of range";
        }
    }
    return "";
}

}  // namespace kilolux
