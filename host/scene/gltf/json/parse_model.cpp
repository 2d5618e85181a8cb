// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json/parse_model.h"

#include <cctype>
#include <limits>

#include "host/scene/gltf/json/json_memory.h"

namespace kilolux {
namespace {

using nlohmann::json;

// Nodes are converted in parts, so that tinygltf's own values of all of them never stand beside
// ours.
constexpr std::uint64_t kPartBytes = std::uint64_t{4} << 20;

// Changes the JSON where tinygltf refuses or loses parts of valid files. It requires a buffer view
// of each accessor of indices, so these are taken out: returns them by primitive, -1 for none.
std::vector<int> adapt_to_tinygltf(json& root) {
    const auto each = [&root](const char* array, const auto& change) {
        const json::json_pointer place(array);
        if (!root.contains(place)) return;
        for (json& element : root.at(place)) change(element);
    };
    // tinygltf drops empty objects, and the array's indices with them.
    each("/extensions/EXT_lights_ies/lights", [](json& light) { light.emplace("name", ""); });
    // It requires a node of each channel's target, which pointers have in its place.
    each("/animations", [](json& animation) {
        if (!animation.contains("channels")) return;
        for (json& channel : animation.at("channels")) channel.at("target").emplace("node", -1);
    });
    std::vector<int> indices;
    each("/meshes", [&indices](json& mesh) {
        if (!mesh.contains("primitives")) return;
        for (json& primitive : mesh.at("primitives")) {
            indices.push_back(primitive.value("indices", -1));
            primitive.erase("indices");
        }
    });
    return indices;
}

std::string one_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    return text;
}

void add_images(GltfDocument& document, std::vector<json>& images) {
    for (json& source : images) {
        tinygltf::Image image;
        if (source.contains("name") && source.at("name").is_string())
            image.name = source.at("name");
        if (source.contains("uri")) image.uri = std::move(source.at("uri").get_ref<std::string&>());
        image.mimeType = source.value("mimeType", "");
        image.bufferView = source.value("bufferView", -1);
        document.model.images.push_back(std::move(image));
    }
}

// Moves an array out of the file.
std::vector<json> take_array(json& root, const char* name) {
    std::vector<json> out;
    if (root.contains(name)) out = std::move(root.at(name).get_ref<json::array_t&>());
    root.erase(name);
    return out;
}

class ModelParser {
 public:
    ModelParser(GltfDocument& document, std::uint64_t charged)
        : document_(document), charged_(charged) {}

    // Reads all but buffers and images, which tinygltf would read without our checks, materials,
    // cameras and lights.
    void run(json root) {
        std::vector<json> images = take_array(root, "images");
        document_.materials = take_array(root, "materials");
        document_.cameras = take_array(root, "cameras");
        for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
            const json::json_pointer place("/extensions/" + std::string(kLightExtensions[e]));
            if (root.contains(place)) document_.lights[e] = take_array(root.at(place), "lights");
        }
        std::vector<json> nodes = take_array(root, "nodes");
        const std::vector<int> indices = adapt_to_tinygltf(root);
        const JsonCost cost = cost_of(root);
        document_.model = convert(std::move(root), cost);
        auto next = indices.begin();
        for (tinygltf::Mesh& mesh : document_.model.meshes) {
            for (tinygltf::Primitive& primitive : mesh.primitives) primitive.indices = *next++;
        }
        add_images(document_, images);
        add_nodes(std::move(nodes));
        std::uint64_t kept = 0;
        const auto keep = [&kept](const std::vector<json>& list) {
            for (const json& value : list) kept += cost_of(value).values;
        };
        keep(document_.materials);
        keep(document_.cameras);
        std::ranges::for_each(document_.lights, keep);
        release(charged_ - std::min(charged_, kept));
    }

 private:
    // Gives back what parsed values took.
    void release(std::uint64_t bytes) {
        bytes = std::min(bytes, charged_);
        charged_ -= bytes;
        document_.budget->release_memory(bytes);
    }

    // A part of the file, which goes.
    tinygltf::Model convert(json part, const JsonCost& cost) {
        const std::string where = document_.base.file + ": JSON";
        document_.budget->charge_memory(cost.model, where);
        // The text in room for twice as much, and its growth or a string that the reader holds.
        // tinygltf's values stand in place of ours.
        const MemoryCharge meanwhile =
            document_.budget->borrow_memory(3 * cost.text + 3 * cost.longest_string, where);
        const std::string text = part.dump();
        part = nullptr;
        if (text.size() > std::numeric_limits<unsigned>::max()) {
            document_.fail("JSON", "is larger than 4 GiB");
        }
        tinygltf::Model model;
        std::string error;
        std::string warning;
        tinygltf::TinyGLTF reader;
        if (!reader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                        static_cast<unsigned>(text.size()), "")) {
            document_.fail("JSON", "is refused by tinygltf: {}", one_line(error));
        }
        release(cost.values);
        return model;
    }

    void add_nodes(std::vector<json> nodes) {
        document_.budget->charge_memory(nodes.size() * sizeof(tinygltf::Node),
                                        document_.base.file + ": nodes");
        document_.model.nodes.reserve(nodes.size());
        for (std::size_t begin = 0, end = 0; begin < nodes.size(); begin = end) {
            JsonCost cost;
            json part = {{"asset", {{"version", "2.0"}}}, {"nodes", json::array()}};
            json& some = part.at("nodes");
            for (; end < nodes.size() && cost.values + cost.model < kPartBytes; ++end) {
                const JsonCost own = cost_of(nodes[end]);
                cost.add(own);
                cost.model -= sizeof(tinygltf::Node);
                some.push_back(std::move(nodes[end]));
            }
            tinygltf::Model made = convert(std::move(part), cost);
            for (tinygltf::Node& node : made.nodes) {
                document_.model.nodes.push_back(std::move(node));
            }
        }
    }

    GltfDocument& document_;
    std::uint64_t charged_;
};

}  // namespace

void parse_model(GltfDocument& document, json root, std::uint64_t charged) {
    ModelParser(document, charged).run(std::move(root));
}

}  // namespace kilolux
