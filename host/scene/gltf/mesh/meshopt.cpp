// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/meshopt.h"

#include <meshoptimizer.h>

#include "host/scene/gltf/extensions.h"
#include "host/scene/gltf/mesh/meshopt_vertices.h"

namespace kilolux {
namespace {

// The values of the extension's object.
struct MeshoptView {
    std::span<const unsigned char> source;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::string mode;
    std::string filter;
};

// The name of the extension that compresses a view; empty for none.
std::string extension_of(const GltfDocument& document, std::size_t view) {
    for (const std::string_view name : kMeshoptExtensions) {
        if (document.model.bufferViews[view].extensions.contains(std::string(name))) {
            return std::string(name);
        }
    }
    return "";
}

MeshoptView read_extension(const GltfDocument& document, const tinygltf::Value& object,
                           const std::string& where) {
    const ByteSpan buffer =
        bytes_of_buffer(document, static_cast<std::size_t>(member_or(object, "buffer", 0)), where);
    const auto offset = static_cast<std::size_t>(member_or(object, "byteOffset", 0));
    const auto length = static_cast<std::size_t>(member_or(object, "byteLength", 0));
    if (offset > buffer.size() || length > buffer.size() - offset) {
        document.fail(where, "byteOffset {} and byteLength {} leave a buffer of {} bytes", offset,
                      length, buffer.size());
    }
    MeshoptView out;
    out.source = buffer.subspan(offset, length);
    out.count = static_cast<std::size_t>(member_or(object, "count", 0));
    out.stride = static_cast<std::size_t>(member_or(object, "byteStride", 0));
    out.mode = member_or<std::string>(object, "mode", "");
    out.filter = member_or<std::string>(object, "filter", "NONE");
    return out;
}

// Throws for strides and counts that the extension does not allow; the library would assert.
void check_shape(const GltfDocument& document, const MeshoptView& view, const std::string& where) {
    const auto require_stride = [&](bool fits, const std::string& expected) {
        if (!fits) document.fail(where, "byteStride is {}, must be {}", view.stride, expected);
    };
    if (view.mode == "ATTRIBUTES") {
        require_stride(view.stride % 4 == 0, "a multiple of 4");
    } else {
        require_stride(view.stride == 2 || view.stride == 4, "2 or 4 for mode " + view.mode);
        if (view.filter != "NONE") {
            document.fail(where, "filter {} goes only with mode ATTRIBUTES", view.filter);
        }
    }
    if (view.mode == "TRIANGLES" && view.count % 3 != 0) {
        document.fail(where, "count is {}, must be a multiple of 3", view.count);
    }
    if (view.filter == "OCTAHEDRAL" || view.filter == "COLOR") {
        require_stride(view.stride == 4 || view.stride == 8, "4 or 8 for filter " + view.filter);
    }
    if (view.filter == "QUATERNION") require_stride(view.stride == 8, "8 for filter QUATERNION");
}

int decode(const MeshoptView& view, Bytes& out) {
    const auto& [source, count, stride, mode, filter] = view;
    if (mode == "ATTRIBUTES" && is_vertex_format_1(source)) {
        return decode_vertex_format_1(source, stride, out) ? 0 : -1;
    }
    if (mode == "ATTRIBUTES") {
        return meshopt_decodeVertexBuffer(out.data(), count, stride, source.data(), source.size());
    }
    if (mode == "TRIANGLES") {
        return meshopt_decodeIndexBuffer(out.data(), count, stride, source.data(), source.size());
    }
    return meshopt_decodeIndexSequence(out.data(), count, stride, source.data(), source.size());
}

}  // namespace

bool is_meshopt_compressed(const GltfDocument& document, std::size_t view) {
    return !extension_of(document, view).empty();
}

Bytes decode_meshopt_view(const GltfDocument& document, std::size_t view) {
    const std::string name = extension_of(document, view);
    const std::string where = element_name("bufferViews", view) + "." + name;
    const MeshoptView compressed = read_extension(
        document, *find_extension(document.model.bufferViews[view].extensions, name), where);
    check_shape(document, compressed, where);
    document.budget->charge(compressed.count, compressed.stride, document.base.file + ": " + where);
    Bytes out(compressed.count * compressed.stride);
    if (const int error = decode(compressed, out); error != 0) {
        document.fail(where, "data are broken (the decoder returned {})", error);
    }
    if (compressed.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(out.data(), compressed.count, compressed.stride);
    } else if (compressed.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(out.data(), compressed.count, compressed.stride);
    } else if (compressed.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), compressed.count, compressed.stride);
    } else if (compressed.filter == "COLOR") {
        undo_color_filter(out, compressed.stride);
    }
    return out;
}

}  // namespace kilolux
