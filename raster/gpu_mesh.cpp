// SPDX-License-Identifier: Apache-2.0
#include "raster/gpu_scene.h"

#include <glm/gtc/type_ptr.hpp>

namespace kilolux {
namespace {

// Vertices as rows of floats; attributes are added one after the other.
class VertexRows {
 public:
    template <typename Vector>
    void add(GLuint location, const std::vector<Vector>& values) {
        if (values.empty()) return;
        attributes_.push_back(
            {location, Vector::length(), row_floats_, glm::value_ptr(values.front())});
        row_floats_ += Vector::length();
    }

    std::vector<float> interleaved(std::size_t vertex_count) const {
        std::vector<float> rows(vertex_count * static_cast<std::size_t>(row_floats_));
        for (const Attribute& attribute : attributes_) {
            const auto floats = static_cast<std::size_t>(attribute.floats);
            float* to = rows.data() + attribute.first_float;
            for (std::size_t vertex = 0; vertex < vertex_count; ++vertex, to += row_floats_) {
                std::copy_n(attribute.values + vertex * floats, floats, to);
            }
        }
        return rows;
    }

    void describe(GLuint vertex_array, GLuint buffer) const {
        const auto float_bytes = static_cast<GLsizei>(sizeof(float));
        glVertexArrayVertexBuffer(vertex_array, 0, buffer, 0, row_floats_ * float_bytes);
        for (const Attribute& attribute : attributes_) {
            glEnableVertexArrayAttrib(vertex_array, attribute.location);
            glVertexArrayAttribBinding(vertex_array, attribute.location, 0);
            glVertexArrayAttribFormat(vertex_array, attribute.location, attribute.floats, GL_FLOAT,
                                      GL_FALSE,
                                      static_cast<GLuint>(attribute.first_float * float_bytes));
        }
    }

 private:
    struct Attribute {
        GLuint location;
        GLint floats;
        GLint first_float;  // within a row
        const float* values;
    };
    std::vector<Attribute> attributes_;
    GLint row_floats_ = 0;
};

bool uses_texcoord(uint features, int set) {
    for (int use = 0; use < USE_COUNT; ++use) {
        if ((features & (kFeatureTexture << use)) == 0) continue;
        if (((features & (kFeatureTexcoord1 << use)) != 0) == (set == 1)) return true;
    }
    return false;
}

// Locations are those of geometry.vert. A second set that the mesh lacks reads as (0, 0), OpenGL's
// value of a disabled attribute.
VertexRows rows_of(const Mesh& mesh, uint features) {
    VertexRows rows;
    rows.add(0, mesh.positions);
    if ((features & kFeatureNoSurface) == 0) rows.add(1, mesh.normals);
    if ((features & (kFeatureTexture << USE_NORMAL)) != 0) rows.add(2, mesh.tangents);
    if (uses_texcoord(features, 0)) rows.add(3, mesh.texcoords[0]);
    if (uses_texcoord(features, 1)) rows.add(4, mesh.texcoords[1]);
    if ((features & kFeatureVertexColor) != 0) rows.add(5, mesh.colors);
    return rows;
}

}  // namespace

GpuMesh upload_mesh(const Mesh& mesh, int material, uint features) {
    GpuMesh out;
    out.index_count = static_cast<GLsizei>(mesh.indices.size());
    out.material = material;
    out.features = features;
    out.revision = mesh.revision;
    if (mesh.positions.empty() || mesh.indices.empty()) return out;
    const VertexRows rows = rows_of(mesh, features);
    const std::vector<float> vertices = rows.interleaved(mesh.positions.size());
    out.vertices = make_buffer();
    out.indices = make_buffer();
    out.vertex_array = make_vertex_array();
    glNamedBufferStorage(out.vertices.name(),
                         static_cast<GLsizeiptr>(vertices.size() * sizeof(float)), vertices.data(),
                         0);
    glNamedBufferStorage(out.indices.name(),
                         static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
                         mesh.indices.data(), 0);
    rows.describe(out.vertex_array.name(), out.vertices.name());
    glVertexArrayElementBuffer(out.vertex_array.name(), out.indices.name());
    return out;
}

}  // namespace kilolux
