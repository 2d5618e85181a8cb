// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gltf_compressed.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <stdexcept>

namespace kilolux {
namespace {

using nlohmann::json;

const std::vector<float> kPositions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

}  // namespace

int add_meshopt_view(GltfBuilder& file, const Blob& encoded, const Meshopt& meshopt) {
    const int view = file.add_view(encoded);
    json& entry = file.root["bufferViews"][static_cast<std::size_t>(view)];
    json extension = entry;
    extension["mode"] = meshopt.mode;
    extension["filter"] = meshopt.filter;
    extension["count"] = meshopt.count;
    extension["byteStride"] = meshopt.stride;
    entry = {{"buffer", 1},
             {"byteLength", meshopt.count * meshopt.stride},
             {"extensions", {{"EXT_meshopt_compression", extension}}}};
    if (meshopt.mode == "ATTRIBUTES") entry["byteStride"] = meshopt.stride;
    return view;
}

void add_fallback_buffer(GltfBuilder& file) {
    const std::size_t size = file.bin.size();
    file.root["buffers"] = {{{"byteLength", size}},
                            {{"byteLength", 65536},
                             {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    file.root["extensionsUsed"] = {"EXT_meshopt_compression"};
    file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
}

Blob encode_vertices(const void* vertices, std::size_t count, std::size_t stride) {
    Blob out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices, count, stride));
    return out;
}

void add_meshopt_quad(GltfBuilder& file, const std::string& index_mode) {
    const int positions = add_meshopt_view(file, encode_vertices(kPositions.data(), 4, 12),
                                           {"ATTRIBUTES", "NONE", 4, 12});
    const std::vector<unsigned> quad = {0, 1, 2, 0, 2, 3};
    Blob encoded(1024);
    if (index_mode == "TRIANGLES") {
        encoded.resize(meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), quad.data(), 6));
    } else {
        encoded.resize(meshopt_encodeIndexSequence(encoded.data(), encoded.size(), quad.data(), 6));
    }
    const int indices = add_meshopt_view(file, encoded, {index_mode, "NONE", 6, 2});
    const int position = file.add(
        "accessors",
        {{"bufferView", positions}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 4}});
    const int index = file.add("accessors", {{"bufferView", indices},
                                             {"componentType", kUnsignedShort},
                                             {"type", "SCALAR"},
                                             {"count", 6}});
    const int mesh = file.add(
        "meshes",
        {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}});
    file.add_node({{"mesh", mesh}});
}

GltfBuilder meshopt_quad(const std::string& index_mode) {
    GltfBuilder file;
    add_meshopt_quad(file, index_mode);
    add_fallback_buffer(file);
    return file;
}

Blob hex_bytes(const std::string& digits) {
    Blob out;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
        out.push_back(static_cast<unsigned char>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    }
    return out;
}

// The streams are made by the encoder of meshoptimizer 1.3.
GltfBuilder khr_meshopt_quad() {
    GltfBuilder file = meshopt_quad("INDICES");
    const int positions = file.add_view(
        hex_bytes("a1eaeaaa007f007f00007f00000000000000000000000000000000000000000000120100"));
    const json view = file.root["bufferViews"][static_cast<std::size_t>(positions)];
    for (const char* key : {"byteOffset", "byteLength"}) {
        file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = view.at(key);
    }
    const int colors = add_meshopt_view(
        file,
        hex_bytes("a1ff0001825c5b7e0000feeee9ff00007dcdcc8000fe7d33b2fd00000000000000000000000000"
                  "0000000000000000008000"),
        {"ATTRIBUTES", "COLOR", 6, 4});
    file.primitive()["attributes"]["COLOR_0"] =
        file.add("accessors", {{"bufferView", colors},
                               {"componentType", kUnsignedByte},
                               {"normalized", true},
                               {"type", "VEC4"},
                               {"count", 4}});
    add_fallback_buffer(file);
    std::string text = file.root.dump();
    for (std::size_t at = 0; (at = text.find("EXT_meshopt", at)) != std::string::npos;) {
        text.replace(at, 3, "KHR");
    }
    file.root = json::parse(text);
    return file;
}

Blob draco_quad(int encoding_method) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int position =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    const std::array<std::uint8_t, 4> red = {255, 0, 0, 255};
    const std::array<std::uint32_t, 6> corners = {0, 1, 2, 0, 2, 3};
    for (std::uint32_t f = 0; f < 2; ++f) {
        const auto at = [&](std::uint32_t c) { return &kPositions[3 * corners[3 * f + c]]; };
        builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), at(0), at(1), at(2));
        builder.SetAttributeValuesForFace(color, draco::FaceIndex(f), red.data(), red.data(),
                                          red.data());
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(encoding_method);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) throw std::runtime_error("draco encoder");
    return Blob(buffer.data(), buffer.data() + buffer.size());
}

void add_draco_quad(GltfBuilder& file, const Blob& encoded) {
    const int view = file.add_view(encoded);
    const int position =
        file.add("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4}});
    const int color = file.add(
        "accessors",
        {{"componentType", kUnsignedByte}, {"normalized", true}, {"type", "VEC4"}, {"count", 4}});
    const int index = file.add(
        "accessors", {{"componentType", kUnsignedShort}, {"type", "SCALAR"}, {"count", 6}});
    const json compression = {{"bufferView", view},
                              {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
    const int mesh =
        file.add("meshes", {{"primitives",
                             {{{"attributes", {{"POSITION", position}, {"COLOR_0", color}}},
                               {"indices", index},
                               {"extensions", {{"KHR_draco_mesh_compression", compression}}}}}}});
    file.add_node({{"mesh", mesh}});
}

GltfBuilder draco_file(const Blob& encoded) {
    GltfBuilder file;
    add_draco_quad(file, encoded);
    file.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return file;
}

}  // namespace kilolux
