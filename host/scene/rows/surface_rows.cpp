// SPDX-License-Identifier: Apache-2.0
#include "host/scene/rows/surface_rows.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/scene/material_table.h"
#include "host/scene/rows/material_row.h"
#include "host/scene/rows/texture_table.h"
#include "host/scene/rows/vertex_rows.h"

namespace kilolux {
namespace {

bool is_trilinear(const Sampler& sampler) {
    return sampler.magnify == Filter::linear && sampler.minify == Filter::linear &&
           sampler.mipmaps && sampler.between_mipmaps == Filter::linear;
}

bool same_lookup(const TextureUse& a, const TextureRow& row_a, const TextureUse& b,
                 const TextureRow& row_b) {
    return a.uv_set == b.uv_set && a.uv_from_texcoord == b.uv_from_texcoord &&
           row_a.width == row_b.width && row_a.height == row_b.height &&
           row_a.wrap_s == row_b.wrap_s && row_a.wrap_t == row_b.wrap_t &&
           row_a.filters == row_b.filters;
}

// The first use's lookup serves all uses that read from the same places.
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
            out.lookup_shared |= 1u << use;
        }
    }
}

SurfaceMaterial surface_material(const Material& material, const TextureTable& textures) {
    SurfaceMaterial out{};
    out.row = material_row(material);
    if (material.double_sided) out.flags |= MATERIAL_DOUBLE_SIDED;
    if (material.unlit) out.flags |= MATERIAL_UNLIT;
    if (material.alpha_mode == AlphaMode::mask) out.flags |= MATERIAL_MASKED;
    if (material.alpha_mode == AlphaMode::blend) out.flags |= MATERIAL_BLENDED;
    for (int use = 0; use < USE_COUNT; ++use) {
        out.textures[use] = textures.number_of(material, use);
        if (texture_use(material, use).uv_set == 1) out.flags |= 1u << use;
    }
    share_lookup(material, textures, out);
    return out;
}

std::vector<SurfaceMaterial> surface_materials(const Scene& scene, const TextureTable& textures) {
    std::vector<SurfaceMaterial> out;
    for (const Material& material : scene.materials) {
        out.push_back(surface_material(material, textures));
    }
    out.push_back(surface_material(Material{}, textures));
    return out;
}

void add_use(SurfaceFeatures& out, const Scene& scene, const TextureUse& texture, int use) {
    const Sampler& sampler = scene.textures[static_cast<std::size_t>(texture.texture)].sampler;
    out.texture_uses |= 1u << use;
    out.tangents |= (TANGENT_USES & (1u << use)) != 0;
    (texture.uv_set == 1 ? out.texcoord1 : out.texcoord0) = true;
    out.uv_transform |= texture.uv_from_texcoord != glm::mat3(1.0f);
    out.nearest |= !is_trilinear(sampler);
    out.wraps |= sampler.wrap_s != Wrap::repeat || sampler.wrap_t != Wrap::repeat;
}

void add_mesh(SurfaceFeatures& out, const Scene& scene, const Mesh& mesh, uint uses) {
    out.masks |= material_of(scene, mesh).alpha_mode == AlphaMode::mask;
    out.vertex_color |= !mesh.colors.empty();
    const bool stretches = std::ranges::any_of(looks_of(scene, mesh), [](const Material* material) {
        return material->anisotropy_strength > 0.0f;
    });
    out.tangents |= stretches && (uses & (1u << USE_ANISOTROPY)) != 0 && !mesh.tangents.empty();
    for (int use = 0; use < USE_COUNT; ++use) {
        if (!reads_use(scene, mesh, use) || (uses & (1u << use)) == 0) continue;
        for (const Material* material : looks_of(scene, mesh)) {
            add_use(out, scene, texture_use(*material, use), use);
        }
    }
}

}  // namespace

bool reads_use(const Scene& scene, const Mesh& mesh, int use) {
    if ((TANGENT_USES & (1u << use)) != 0 && mesh.tangents.empty()) return false;
    return texture_use(material_of(scene, mesh), use).present();
}

uint kept_uses(const SceneFeatures& needs) {
    uint uses = 0;
    for (const MaterialMap& map : kMaterialMaps) {
        if (map.needed == nullptr || needs.*map.needed) uses |= 1u << map.use;
    }
    return uses;
}

SurfaceFeatures mesh_features(const Scene& scene, const Mesh& mesh, uint uses, int anisotropy) {
    SurfaceFeatures out;
    out.anisotropy = anisotropy;
    add_mesh(out, scene, mesh, uses);
    return out;
}

SurfaceFeatures coverage_features(const Scene& scene, const Mesh& mesh) {
    SurfaceFeatures out;
    if (material_of(scene, mesh).alpha_mode == AlphaMode::mask) {
        out = mesh_features(scene, mesh, 1u << USE_BASE_COLOR, 1);
    }
    out.coverage = true;
    return out;
}

SurfaceFeatures surface_features(const Scene& scene, const SceneFeatures& needs, int anisotropy) {
    SurfaceFeatures out;
    out.anisotropy = anisotropy;
    for (const Mesh& mesh : scene.meshes) {
        add_mesh(out, scene, mesh, kept_uses(needs));
    }
    return out;
}

SurfaceRows surface_rows(const Scene& scene, const MeshFeatures& features,
                         const TextureTable& textures) {
    SurfaceRows out;
    out.materials = surface_materials(scene, textures);
    out.materials_revision = scene.revisions.materials;
    for (const Mesh& mesh : scene.meshes) {
        const auto read = features(mesh);
        MeshRow row = vertex_layout(mesh, read.value_or(SurfaceFeatures{}));
        row.first_float = checked_count(out.vertices.size(), scene);
        row.first_index = checked_count(out.indices.size(), scene);
        row.material = static_cast<uint>(material_row(scene, mesh));
        if (read) {
            append_vertices(mesh, row, out.vertices);
            out.indices.insert(out.indices.end(), mesh.indices.begin(), mesh.indices.end());
        }
        out.meshes.push_back(row);
        out.revisions.push_back(mesh.revision);
        out.vertex_counts.push_back(mesh.positions.size());
    }
    checked_count(out.vertices.size(), scene);
    checked_count(out.indices.size(), scene);
    return out;
}

bool rewrite_materials(SurfaceRows& rows, const Scene& scene, const MeshFeatures& features) {
    if (std::exchange(rows.materials_revision, scene.revisions.materials) ==
        scene.revisions.materials) {
        return false;
    }
    rows.materials = surface_materials(scene, TextureTable(scene, features));
    return true;
}

void rewrite_vertices(SurfaceRows& rows, const Scene& scene, const MeshFeatures& features,
                      const std::function<void(std::size_t, std::span<const float>)>& write) {
    std::vector<float> vertices;
    for (std::size_t i = 0; i < rows.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        if (rows.revisions[i] == mesh.revision) continue;
        rows.revisions[i] = mesh.revision;
        if (!features(mesh)) continue;
        if (mesh.positions.size() != rows.vertex_counts[i]) {
            throw Error(
                fmt::format("scene '{}': mesh {} has {} vertices now, {} when it was set up",
                            scene.name, i, mesh.positions.size(), rows.vertex_counts[i]));
        }
        vertices.clear();
        append_vertices(mesh, rows.meshes[i], vertices);
        write(rows.meshes[i].first_float, vertices);
    }
}

}  // namespace kilolux
