// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/surface_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/surfaces/texture_table.h"
#include "host/surfaces/vertex_rows.h"

namespace kilolux {
namespace {

constexpr std::string_view kOwner = "surfaces";

bool keeps_use(int use, const GBufferNeeds& needs) {
    switch (use) {
        case USE_METALLIC_ROUGHNESS:
            return needs.gloss;
        case USE_EMISSIVE:
            return needs.material;
        case USE_OCCLUSION:
            return needs.occlusion;
        case USE_SPECULAR:
        case USE_SPECULAR_COLOR:
            return needs.specular;
        default:
            return true;
    }
}

bool is_trilinear(const Sampler& sampler) {
    return sampler.magnify == Filter::linear && sampler.minify == Filter::linear &&
           sampler.mipmaps && sampler.between_mipmaps == Filter::linear;
}

bool same_lookup(const TextureUse& a, const TextureRow& row_a, const TextureUse& b,
                 const TextureRow& row_b) {
    return a.uv_set == b.uv_set && a.uv_from_texcoord == b.uv_from_texcoord &&
           row_a.width == row_b.width && row_a.height == row_b.height &&
           row_a.wrap_s == row_b.wrap_s && row_a.wrap_t == row_b.wrap_t &&
           row_a.filter == row_b.filter;
}

// The first use's lookup serves all that read from the same places.
void share_lookup(const Material& material, const TextureTable& textures, SurfaceMaterial& out) {
    out.lookup_use = SURFACE_ABSENT;
    for (uint use = 0; use < USE_COUNT; ++use) {
        if (out.textures[use] == SURFACE_ABSENT) continue;
        if (out.lookup_use == SURFACE_ABSENT) out.lookup_use = use;
        const uint first = out.lookup_use;
        if (same_lookup(texture_use(material, static_cast<int>(first)),
                        textures.rows()[out.textures[first]],
                        texture_use(material, static_cast<int>(use)),
                        textures.rows()[out.textures[use]])) {
            out.flags |= MATERIAL_SHARES_LOOKUP << use;
        }
    }
}

SurfaceMaterial surface_material(const Material& material, const TextureTable& textures) {
    SurfaceMaterial out{};
    out.row = material_row(material);
    if (material.double_sided) out.flags |= MATERIAL_DOUBLE_SIDED;
    if (material.unlit) out.flags |= MATERIAL_UNLIT;
    if (material.alpha_mode == AlphaMode::mask) out.flags |= MATERIAL_MASKED;
    for (int use = 0; use < USE_COUNT; ++use) {
        out.textures[use] = textures.number_of(material, use);
        if (texture_use(material, use).uv_set == 1) out.flags |= 1u << use;
    }
    share_lookup(material, textures, out);
    return out;
}

}  // namespace

SurfaceFeatures surface_features(const Scene& scene, const GBufferNeeds& needs, int anisotropy) {
    SurfaceFeatures out;
    out.anisotropy = anisotropy;
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = material_of(scene, mesh);
        if (material.alpha_mode == AlphaMode::blend) continue;
        out.masks |= material.alpha_mode == AlphaMode::mask;
        out.vertex_color |= !mesh.colors.empty();
        for (int use = 0; use < USE_COUNT; ++use) {
            const TextureUse& texture = texture_use(material, use);
            if (!texture.present() || !keeps_use(use, needs)) continue;
            if (use == USE_NORMAL && mesh.tangents.empty()) continue;
            out.texture_uses |= 1u << use;
            (texture.uv_set == 1 ? out.texcoord1 : out.texcoord0) = true;
            out.uv_transform |= texture.uv_from_texcoord != glm::mat3(1.0f);
            const Sampler& sampler =
                scene.textures[static_cast<std::size_t>(texture.texture)].sampler;
            out.nearest |= !is_trilinear(sampler);
            out.wraps |= sampler.wrap_s != Wrap::repeat || sampler.wrap_t != Wrap::repeat;
        }
    }
    return out;
}

std::uint64_t surface_scene_bytes(const Scene& scene, const SurfaceFeatures& features) {
    std::uint64_t bytes = TextureTable(scene, features).texels() * sizeof(std::uint64_t);
    for (const Mesh& mesh : scene.meshes) {
        bytes += vertex_floats(mesh, features) * mesh.positions.size() * sizeof(float) +
                 mesh.indices.size() * sizeof(uint) + sizeof(MeshRow);
    }
    return bytes + scene.materials.size() * sizeof(SurfaceMaterial) +
           scene.instances.size() * sizeof(InstanceRow);
}

std::vector<uint> instance_blocks(std::span<const InstanceRow> rows, uint triangles) {
    std::vector<uint> blocks;
    uint instance = 0;
    for (std::uint64_t first = 0; first < triangles; first += INSTANCE_BLOCK) {
        while (instance + 1 < rows.size() && rows[instance + 1].first_triangle <= first) ++instance;
        blocks.push_back(instance);
    }
    blocks.push_back(rows.empty() ? 0 : static_cast<uint>(rows.size() - 1));
    return blocks;
}

SurfaceScene::SurfaceScene(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                           const SurfaceFeatures& features)
    : gpu_(gpu),
      scene_(scene),
      features_(features),
      instances_(gpu, kOwner),
      blocks_(gpu, kOwner),
      meshes_(gpu, kOwner),
      vertices_(gpu, kOwner),
      indices_(gpu, kOwner),
      materials_(gpu, kOwner),
      textures_(gpu, kOwner),
      texels_(gpu, kOwner) {
    upload_materials(tuning);
    upload_meshes();
}

SurfaceScene::~SurfaceScene() {
    if (drawn_.read()) clWaitForEvents(1, &drawn_.read());
}

void SurfaceScene::upload_materials(const Tuning& tuning) {
    const TextureTable table(scene_, features_);
    std::vector<SurfaceMaterial> materials;
    for (const Material& material : scene_.materials) {
        materials.push_back(surface_material(material, table));
    }
    materials.push_back(surface_material(Material{}, table));
    upload<SurfaceMaterial>(gpu_, materials_.reserve(materials.size()), materials);
    upload<TextureRow>(gpu_, textures_.reserve(table.rows().size()), table.rows());
    table.upload(gpu_, tuning, texels_.reserve(table.texels()));
}

void SurfaceScene::upload_meshes() {
    std::vector<float> vertices;
    std::vector<uint> indices;
    for (const Mesh& mesh : scene_.meshes) {
        MeshRow row = vertex_layout(mesh, features_);
        row.first_float = checked_count(vertices.size(), scene_);
        row.first_index = checked_count(indices.size(), scene_);
        row.material = static_cast<uint>(
            mesh.material < 0 ? scene_.materials.size() : static_cast<std::size_t>(mesh.material));
        if (material_of(scene_, mesh).alpha_mode != AlphaMode::blend) {
            append_vertices(mesh, row, vertices);
            indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
        }
        rows_.push_back(row);
        revisions_.push_back(mesh.revision);
    }
    checked_count(vertices.size(), scene_);
    checked_count(indices.size(), scene_);
    upload<MeshRow>(gpu_, meshes_.reserve(rows_.size()), rows_);
    upload<float>(gpu_, vertices_.reserve(vertices.size()), vertices);
    upload<uint>(gpu_, indices_.reserve(indices.size()), indices);
}

void SurfaceScene::refresh_vertices() {
    std::vector<float> vertices;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Mesh& mesh = scene_.meshes[i];
        if (revisions_[i] == mesh.revision) continue;
        revisions_[i] = mesh.revision;
        if (material_of(scene_, mesh).alpha_mode == AlphaMode::blend) continue;
        vertices.clear();
        append_vertices(mesh, rows_[i], vertices);
        gpu_.queue.enqueueWriteBuffer(vertices_.get(), CL_TRUE,
                                      std::size_t{rows_[i].first_float} * sizeof(float),
                                      vertices.size() * sizeof(float), vertices.data());
    }
}

SurfaceBuffers SurfaceScene::at(std::span<const Draw> draws) {
    refresh_vertices();
    if (drawn_.read()) drawn_.read.wait();
    drawn_.rows.clear();
    for (const Draw& draw : draws) drawn_.rows.push_back(draw.row);
    drawn_.blocks = instance_blocks(drawn_.rows, drawn_triangles(draws, scene_));
    drawn_.rows.emplace_back().first_triangle = std::numeric_limits<uint>::max();
    drawn_.read = start_upload(gpu_, instances_.reserve(drawn_.rows.size()), drawn_.rows);
    drawn_.read = start_upload(gpu_, blocks_.reserve(drawn_.blocks.size()), drawn_.blocks);
    return {instances_.get(), blocks_.get(),    meshes_.get(),   vertices_.get(),
            indices_.get(),   materials_.get(), textures_.get(), texels_.get()};
}

}  // namespace kilolux
