// SPDX-License-Identifier: Apache-2.0
#include "raster/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/base/error.h"
#include "host/base/formats/srgb.h"
#include "host/scene/rows/mip_levels.h"
#include "host/scene/rows/texture_table.h"
#include "host/scene/rows/vertex_rows.h"
#include "raster/gl_debug.h"
#include "raster/shaders/draw_rows.h"

namespace kilolux {
namespace {

// Never empty, since an empty buffer cannot be bound.
GlBuffer filled_buffer(std::span<const std::byte> bytes) {
    constexpr std::array<std::byte, sizeof(SurfaceMaterial)> kNothing{};
    if (bytes.empty()) bytes = kNothing;
    GlBuffer buffer = make_buffer();
    glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                         GL_DYNAMIC_STORAGE_BIT);
    return buffer;
}

template <typename Row>
std::span<const std::byte> bytes_of(const std::vector<Row>& rows) {
    return std::as_bytes(std::span(rows));
}

// The table that encode_srgb() of planes.frag reads: boundaries, then codes.
GlBuffer srgb_table() {
    const SrgbBuckets buckets = srgb_buckets();
    std::vector<uint> words;
    for (const float boundary : buckets.boundary) words.push_back(float_bits(boundary));
    words.insert(words.end(), buckets.code.begin(), buckets.code.end());
    return filled_buffer(bytes_of(words));
}

}  // namespace

GpuScene::Texels GpuScene::make_texels(const char* what, GLenum format, std::size_t texel_bytes,
                                       std::span<const std::byte> bytes) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    const std::size_t texels = bytes.size() / texel_bytes;
    if (texels > static_cast<std::size_t>(most)) {
        throw Error(fmt::format("{}: {} texels of a buffer texture; OpenGL has at most {} here",
                                what, texels, most));
    }
    Texels out{filled_buffer(bytes), make_texture(GL_TEXTURE_BUFFER)};
    glTextureBuffer(out.texture.name(), format, out.buffer.name());
    return out;
}

GpuScene::GpuScene(const Scene& scene, int anisotropy, GpuSceneUse use)
    : scene_(scene),
      anisotropy_(anisotropy),
      use_(use),
      srgb_(srgb_table()),
      vertex_array_(make_vertex_array()) {
    const TextureTable table(scene, features());
    rows_ = surface_rows(scene, features(), table);
    meshes_ = filled_buffer(bytes_of(rows_.meshes));
    materials_ = filled_buffer(bytes_of(rows_.materials));
    textures_ = filled_buffer(std::as_bytes(table.rows()));
    vertices_ = make_texels("vertices", GL_R32F, sizeof(float), bytes_of(rows_.vertices));
    indices_ = make_texels("triangles", GL_R32UI, sizeof(uint), bytes_of(rows_.indices));
    rows_.vertices = {};
    rows_.indices = {};
    upload_images(table);
    const GLuint array = vertex_array_.name();
    glEnableVertexArrayAttrib(array, 0);
    glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, 0, 0);
    glVertexArrayElementBuffer(array, indices_.buffer.name());
    check_gl_errors("upload of scene '" + scene.name + "'");
}

MeshFeatures GpuScene::features() const {
    return [this](const Mesh& mesh) -> std::optional<SurfaceFeatures> {
        if (use_ == GpuSceneUse::covered) return coverage_features(scene_, mesh);
        return mesh_features(scene_, mesh, ~0u, anisotropy_);
    };
}

void GpuScene::upload_images(const TextureTable& table) {
    std::vector<std::size_t> first_texels;
    for (const auto& [encoded, first] : table.images()) {
        const Image& image = scene_.images[static_cast<std::size_t>(encoded.first)];
        const auto levels = mip_levels(image, encoded.second);
        images_.push_back(
            make_texels(image.name.c_str(), GL_RG32UI, sizeof(std::uint64_t), bytes_of(levels)));
        first_texels.push_back(first);
    }
    for (const TextureRow& row : table.rows()) {
        const auto found = std::ranges::find(first_texels, std::size_t{row.first_texel});
        image_of_texture_.push_back(static_cast<std::size_t>(found - first_texels.begin()));
    }
}

void GpuScene::refresh() {
    // A new buffer, as of bind().
    if (rewrite_materials(rows_, scene_, features())) {
        materials_ = filled_buffer(bytes_of(rows_.materials));
    }
    rewrite_vertices(rows_, scene_, features(), [&](std::size_t first, std::span<const float> v) {
        glNamedBufferSubData(vertices_.buffer.name(), static_cast<GLintptr>(first * sizeof(float)),
                             static_cast<GLsizeiptr>(v.size_bytes()), v.data());
    });
    check_gl_errors("new vertices of scene '" + scene_.name + "'");
}

const Material& GpuScene::material_of_mesh(std::size_t mesh) const {
    return material_of(scene_, scene_.meshes[mesh]);
}

void GpuScene::bind(std::span<const Draw> draws) const {
    std::vector<InstanceRow> instances;
    for (const Draw& draw : draws) instances.push_back(draw.row);
    instances.emplace_back();
    // A new buffer: llvmpipe overwrites one of the same size while fragments still read it.
    instances_ = filled_buffer(bytes_of(instances));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, INSTANCES_BLOCK, instances_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, MESHES_BLOCK, meshes_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, MATERIALS_BLOCK, materials_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TEXTURES_BLOCK, textures_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SRGB_BLOCK, srgb_.name());
    glBindTextureUnit(VERTICES_UNIT, vertices_.texture.name());
    glBindTextureUnit(INDICES_UNIT, indices_.texture.name());
    glBindVertexArray(vertex_array_.name());
}

void GpuScene::bind_maps(std::size_t mesh, uint uses) const {
    const SurfaceMaterial& material = rows_.materials[rows_.meshes[mesh].material];
    for (uint use = 0; use < USE_COUNT; ++use) {
        const uint texture = material.textures[use];
        if ((uses & (1u << use)) == 0 || texture == SURFACE_ABSENT) continue;
        glBindTextureUnit(use, images_[image_of_texture_[texture]].texture.name());
    }
}

void GpuScene::draw(std::size_t mesh) const {
    const MeshRow& row = rows_.meshes[mesh];
    const std::size_t first_byte = std::size_t{row.first_index} * sizeof(uint);
    glVertexArrayVertexBuffer(vertex_array_.name(), 0, vertices_.buffer.name(),
                              static_cast<GLintptr>(std::size_t{row.first_float} * sizeof(float)),
                              static_cast<GLsizei>(row.vertex_floats * sizeof(float)));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(scene_.meshes[mesh].indices.size()),
                   GL_UNSIGNED_INT,
                   reinterpret_cast<void*>(first_byte));  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace kilolux
