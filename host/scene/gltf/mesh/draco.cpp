// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/draco.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <optional>

#include "host/scene/gltf/extensions.h"

namespace kilolux {
namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// The counts in a bit stream's header.
struct DracoSize {
    std::uint32_t face_count = 0;
    std::uint32_t vertex_count = 0;
};

// Reads the counts ahead of the decoder, which would allocate for them before it meets the end of a
// broken stream (Draco bitstream specification 2.2, sections 3 and 4).
std::optional<DracoSize> peek_size(std::span<const unsigned char> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header{};
    if (!buffer.Decode(header.draco_string, 5) || !buffer.Decode(&header.version_major) ||
        !buffer.Decode(&header.version_minor) || !buffer.Decode(&header.encoder_type) ||
        !buffer.Decode(&header.encoder_method) || !buffer.Decode(&header.flags)) {
        return std::nullopt;
    }
    if (header.version_major != 2 || header.version_minor != 2) return std::nullopt;
    if (header.encoder_type != draco::TRIANGULAR_MESH) return std::nullopt;
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        draco::GeometryMetadata metadata;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
            return std::nullopt;
    }
    DracoSize size;
    bool read = true;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        std::uint8_t traversal = 0;
        read = buffer.Decode(&traversal) && draco::DecodeVarint(&size.vertex_count, &buffer) &&
               draco::DecodeVarint(&size.face_count, &buffer);
    } else {
        read = draco::DecodeVarint(&size.face_count, &buffer) &&
               draco::DecodeVarint(&size.vertex_count, &buffer);
    }
    return read ? std::optional(size) : std::nullopt;
}

std::unique_ptr<draco::Mesh> decode_mesh(const GltfDocument& document,
                                         std::span<const unsigned char> bytes,
                                         const std::string& where) {
    const std::optional<DracoSize> size = peek_size(bytes);
    if (!size) throw Error(where + ": is no triangle mesh of Draco bit stream 2.2");
    // An upper bound of the decoder's tables per face and per vertex.
    document.budget->charge(size->face_count, 128, where);
    document.budget->charge(size->vertex_count, 128, where);
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) throw Error(where + ": " + mesh.status().error_msg_string());
    return std::move(mesh).value();
}

// The attribute's values, one per point, in the accessor's own component type.
void read_values(const draco::PointAttribute& attribute, const ElementArray& array, Bytes& out) {
    visit_component_type(array.component_type, [&](auto zero) {
        using T = decltype(zero);
        const auto components = static_cast<std::int8_t>(array.components);
        for (std::size_t point = 0; point < array.count; ++point) {
            const auto value =
                attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(point)));
            T* target = reinterpret_cast<T*>(out.data() + point * array.stride);
            if (attribute.ConvertValue<T>(value, components, target)) continue;
            throw Error(fmt::format("{}: Draco value {} does not fit the accessor's componentType",
                                    array.where, point));
        }
    });
}

void replace_attribute(const GltfDocument& document, const draco::PointAttribute& attribute,
                       ElementArray& array, Bytes& storage) {
    if (array.components > 4) throw Error(array.where + ": a matrix cannot be a vertex attribute");
    array.stride = array.components * component_bytes(array.component_type);
    document.budget->charge(array.count, array.stride, array.where);
    storage.resize(array.count * array.stride);
    read_values(attribute, array, storage);
    array.bytes = storage;
    array.sparse_elements.clear();
}

void replace_attributes(const GltfDocument& document, const tinygltf::Value& extension,
                        const draco::Mesh& mesh, PrimitiveArrays& arrays) {
    const tinygltf::Value& ids = extension.Get("attributes");
    arrays.decoded.reserve(ids.Size());
    for (const std::string& name : ids.Keys()) {
        const auto entry = arrays.attributes.find(name);
        if (entry == arrays.attributes.end()) continue;
        const int id = member_or(ids, name, 0);
        const auto* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        if (attribute == nullptr) {
            throw Error(fmt::format("{}.{}: {} is attribute {}, which the data do not have",
                                    arrays.where, kDracoExtension, name, id));
        }
        entry->second.count = mesh.num_points();
        replace_attribute(document, *attribute, entry->second, arrays.decoded.emplace_back());
    }
    arrays.vertex_count = arrays.attributes.at("POSITION").count;
}

}  // namespace

bool is_draco_compressed(const tinygltf::Primitive& primitive) {
    return find_extension(primitive.extensions, kDracoExtension) != nullptr;
}

std::vector<std::uint32_t> decode_draco_primitive(const GltfDocument& document,
                                                  const tinygltf::Primitive& primitive,
                                                  PrimitiveArrays& arrays) {
    const tinygltf::Value& extension = *find_extension(primitive.extensions, kDracoExtension);
    const auto view = static_cast<std::size_t>(member_or(extension, "bufferView", 0));
    const auto mesh =
        decode_mesh(document, document.views[view], arrays.where + "." + kDracoExtension);
    replace_attributes(document, extension, *mesh, arrays);
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t{3} * mesh->num_faces());
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face) {
        for (const draco::PointIndex& point : mesh->face(face)) {
            if (point.value() >= arrays.vertex_count) {
                throw Error(fmt::format("{}.{}: vertex index {} is out of range", arrays.where,
                                        kDracoExtension, point.value()));
            }
            indices.push_back(point.value());
        }
    }
    return indices;
}

}  // namespace kilolux
