// SPDX-License-Identifier: Apache-2.0
#include "host/scene/export/export_scene.h"

#include <fmt/core.h>
#include <cctype>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "host/base/error.h"
#include "host/base/system/parallel.h"
#include "host/base/text.h"
#include "host/scene/export/buffer.h"
#include "host/scene/export/materials.h"
#include "host/scene/export/nodes.h"
#include "host/scene/export/parts.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<unsigned char>;

template <typename Vector>
std::span<const float> floats(const std::vector<Vector>& values) {
    return {&values.front().x, values.size() * static_cast<std::size_t>(Vector::length())};
}

Json mesh_json(const Mesh& mesh, ExportBuffer& buffer) {
    Json attributes{{"POSITION", buffer.add_vertices(floats(mesh.positions), 3, true)}};
    const auto add = [&](const char* name, const auto& values) {
        if (values.empty()) return;
        attributes[name] = buffer.add_vertices(floats(values), values.front().length());
    };
    add("NORMAL", mesh.normals);
    add("TANGENT", mesh.tangents);
    add("TEXCOORD_0", mesh.texcoords[0]);
    add("TEXCOORD_1", mesh.texcoords[1]);
    add("COLOR_0", mesh.colors);
    Json primitive{{"attributes", std::move(attributes)},
                   {"indices", buffer.add_indices(mesh.indices)}};
    if (mesh.material != kDefaultMaterial) primitive["material"] = mesh.material;
    Json out{{"primitives", Json::array({std::move(primitive)})}};
    if (!mesh.name.empty()) out["name"] = mesh.name;
    return out;
}

// A file's name as a relative URI; all but RFC 3986's unreserved characters are encoded.
std::string percent_encoded(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || std::string_view("-._~").find(c) != std::string_view::npos) {
            out += c;
        } else {
            out += fmt::format("%{:02X}", byte);
        }
    }
    return out;
}

// glTF allows no empty arrays.
void add_array(Json& root, const char* name, Json array) {
    if (!array.empty()) root[name] = std::move(array);
}

// The names of all extensions that a part of the file has.
void collect_extensions(const Json& part, std::set<std::string>& names) {
    if (!part.is_structured()) return;
    for (const auto& [key, member] : part.items()) {
        if (part.is_object() && key == "extensions") {
            for (const auto& extension : member.items()) names.insert(extension.key());
        }
        collect_extensions(member, names);
    }
}

void append_word(Bytes& out, std::uint64_t word) {
    for (int shift = 0; shift < 32; shift += 8) {
        out.push_back(static_cast<unsigned char>(word >> shift));
    }
}

// A chunk of a GLB (glTF 2.0, section 4.4), padded to whole words.
void append_chunk(Bytes& out, const char* type, std::span<const unsigned char> bytes,
                  unsigned char padding) {
    append_word(out, (bytes.size() + 3) / 4 * 4);
    out.insert(out.end(), type, type + 4);
    out.insert(out.end(), bytes.begin(), bytes.end());
    while (out.size() % 4 != 0) out.push_back(padding);
}

class Writer {
 public:
    Writer(const Scene& scene, const std::filesystem::path& file)
        : scene_(scene),
          stem_(file.stem().string()),
          binary_(lower(file.extension().string()) == ".glb") {}

    ExportedScene write(const std::filesystem::path& file) {
        const std::vector<int> mesh_of = add_meshes();
        ExportedMaterials materials = export_materials(scene_);
        add_array(root_, "materials", std::move(materials.materials));
        add_array(root_, "textures", std::move(materials.textures));
        add_array(root_, "samplers", std::move(materials.samplers));
        add_images();
        add_nodes(mesh_of);
        add_buffer();
        add_extensions();
        if (binary_) {
            out_.files.push_back({file.filename().string(), glb()});
        } else {
            const std::string text =
                root_.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
            out_.files.push_back({file.filename().string(), Bytes(text.begin(), text.end())});
        }
        return std::move(out_);
    }

 private:
    std::vector<int> add_meshes() {
        std::vector<int> mesh_of;
        Json meshes = Json::array();
        for (const Mesh& mesh : scene_.meshes) {
            const bool has_triangles = !mesh.positions.empty() && !mesh.indices.empty();
            mesh_of.push_back(has_triangles ? static_cast<int>(meshes.size()) : -1);
            if (has_triangles) meshes.push_back(mesh_json(mesh, buffer_));
        }
        add_array(root_, "meshes", std::move(meshes));
        return mesh_of;
    }

    // An element that refers to a file: in the buffer of a .glb, else beside the .gltf.
    Json added_file(const std::string& element, const std::string& file, const char* mime_type,
                    Bytes bytes) {
        Json out = Json::object();
        if (!element.empty()) out["name"] = element;
        if (binary_) {
            out["bufferView"] = buffer_.add_bytes(bytes);
            out["mimeType"] = mime_type;
        } else {
            out["uri"] = percent_encoded(file);
            out_.files.push_back({file, std::move(bytes)});
        }
        return out;
    }

    void add_images() {
        std::vector<Bytes> encoded(scene_.images.size());
        parallel_each(encoded.size(),
                      [&](std::size_t i) { encoded[i] = encode_png(scene_.images[i]); });
        Json images = Json::array();
        for (std::size_t i = 0; i < encoded.size(); ++i) {
            images.push_back(added_file(scene_.images[i].name, fmt::format("{}_{}.png", stem_, i),
                                        "image/png", std::move(encoded[i])));
        }
        add_array(root_, "images", std::move(images));
    }

    void add_nodes(const std::vector<int>& mesh_of) {
        ExportedNodes placed = export_nodes(scene_, mesh_of);
        out_.lights = placed.usable_lights;
        out_.unusable_lights = placed.unusable_lights;
        Json scene = Json::object();
        if (!scene_.name.empty()) scene["name"] = scene_.name;
        add_array(scene, "nodes", std::move(placed.roots));
        root_["scenes"] = Json::array({std::move(scene)});
        add_array(root_, "nodes", std::move(placed.nodes));
        add_array(root_, "cameras", std::move(placed.cameras));
        add_webs();
        if (!placed.lights.empty()) root_["extensions"].update(placed.lights);
    }

    void add_webs() {
        if (scene_.webs.empty()) return;
        for (std::size_t i = 0; i < scene_.webs.size(); ++i) {
            const PhotometricWeb& web = scene_.webs[i];
            root_["extensions"]["EXT_lights_ies"]["lights"].push_back(
                added_file(web.name, fmt::format("{}_{}.ies", stem_, i), "application/x-ies-lm-63",
                           Bytes(web.text.begin(), web.text.end())));
        }
    }

    void add_buffer() {
        if (buffer_.bytes().empty()) return;
        Json buffer{{"byteLength", buffer_.bytes().size()}};
        if (!binary_) {
            const std::string name = stem_ + ".bin";
            buffer["uri"] = percent_encoded(name);
            out_.files.push_back({name, buffer_.bytes()});
        }
        root_["buffers"] = Json::array({std::move(buffer)});
        root_["bufferViews"] = buffer_.views();
        add_array(root_, "accessors", buffer_.accessors());
    }

    void add_extensions() {
        std::set<std::string> names;
        collect_extensions(root_, names);
        if (!names.empty()) root_["extensionsUsed"] = names;
    }

    Bytes glb() const {
        const std::string text = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
        constexpr std::size_t kHeaders = 12 + 8 + 8 + 6;  // and the most that padding takes
        const std::size_t bytes = text.size() + buffer_.bytes().size() + kHeaders;
        if (bytes > std::numeric_limits<std::uint32_t>::max()) {
            throw Error(
                fmt::format("{}.glb: would be {} MiB, a .glb holds at most 4096; export to .gltf",
                            stem_, bytes >> 20));
        }
        Bytes out;
        out.reserve(bytes);
        for (const char c : {'g', 'l', 'T', 'F'}) out.push_back(static_cast<unsigned char>(c));
        append_word(out, 2);
        append_word(out, 0);
        append_chunk(out, "JSON",
                     {reinterpret_cast<const unsigned char*>(text.data()), text.size()}, ' ');
        if (!buffer_.bytes().empty()) append_chunk(out, "BIN\0", buffer_.bytes(), 0);
        Bytes size;
        append_word(size, out.size());
        std::copy(size.begin(), size.end(), out.begin() + 8);
        return out;
    }

    const Scene& scene_;
    std::string stem_;
    bool binary_;
    Json root_{{"asset", {{"version", "2.0"}, {"generator", "kilolux"}}}, {"scene", 0}};
    ExportBuffer buffer_;
    ExportedScene out_;
};

}  // namespace

ExportedScene export_scene(const Scene& scene, const std::filesystem::path& file) {
    return Writer(scene, file).write(file);
}

}  // namespace kilolux
