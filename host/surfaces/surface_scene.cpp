// SPDX-License-Identifier: Apache-2.0
#include "host/surfaces/surface_scene.h"

#include <limits>
#include <utility>

#include "host/base/formats/mips.h"
#include "host/scene/rows/mip_levels.h"
#include "host/scene/rows/texture_table.h"
#include "host/scene/rows/vertex_rows.h"
#include "host/stages/surfaces/build_mips.h"

namespace kilolux {
namespace {

constexpr std::string_view kOwner = "surfaces";

// The same features of every mesh.
MeshFeatures same_features(const SurfaceFeatures& features) {
    return [features](const Mesh&) -> std::optional<SurfaceFeatures> { return features; };
}

void upload_texels(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                   const TextureTable& table, const DeviceArray<std::uint64_t>& texels) {
    if (table.rows().empty()) return;
    BuildMips mips(gpu, tuning);
    for (const auto& [encoded, first] : table.images()) {
        const Image& image = scene.images[static_cast<std::size_t>(encoded.first)];
        TextureRow row{};
        place_mips(row, static_cast<uint>(image.width), static_cast<uint>(image.height), first);
        mips.enqueue(first_level(image, encoded.second), row, texels);
    }
    gpu.queue.finish();
}

}  // namespace

std::uint64_t surface_scene_bytes(const Scene& scene, const SurfaceFeatures& features) {
    std::uint64_t bytes =
        TextureTable(scene, same_features(features)).texels() * sizeof(std::uint64_t);
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
      mesh_features_(same_features(features)),
      instances_(gpu, kOwner),
      blocks_(gpu, kOwner),
      meshes_(gpu, kOwner),
      vertices_(gpu, kOwner),
      indices_(gpu, kOwner),
      materials_(gpu, kOwner),
      textures_(gpu, kOwner),
      texels_(gpu, kOwner) {
    upload_rows(tuning);
}

SurfaceScene::~SurfaceScene() {
    if (drawn_.read()) clWaitForEvents(1, &drawn_.read());
}

void SurfaceScene::upload_rows(const Tuning& tuning) {
    const TextureTable table(scene_, mesh_features_);
    rows_ = surface_rows(scene_, mesh_features_, table);
    upload<SurfaceMaterial>(gpu_, materials_.reserve(rows_.materials.size()), rows_.materials);
    upload<TextureRow>(gpu_, textures_.reserve(table.rows().size()), table.rows());
    upload<MeshRow>(gpu_, meshes_.reserve(rows_.meshes.size()), rows_.meshes);
    upload<float>(gpu_, vertices_.reserve(rows_.vertices.size()), rows_.vertices);
    upload<uint>(gpu_, indices_.reserve(rows_.indices.size()), rows_.indices);
    rows_.vertices = {};
    rows_.indices = {};
    upload_texels(gpu_, tuning, scene_, table, texels_.reserve(table.texels()));
}

void SurfaceScene::refresh() {
    if (rewrite_materials(rows_, scene_, mesh_features_)) {
        upload<SurfaceMaterial>(gpu_, materials_.get(), rows_.materials);
    }
    rewrite_vertices(
        rows_, scene_, mesh_features_, [&](std::size_t first, std::span<const float> rows) {
            gpu_.queue.enqueueWriteBuffer(vertices_.get(), CL_TRUE, first * sizeof(float),
                                          rows.size_bytes(), rows.data());
        });
}

SurfaceBuffers SurfaceScene::at(std::span<const Draw> draws) {
    refresh();
    if (drawn_.read()) drawn_.read.wait();
    drawn_.rows.clear();
    for (const Draw& draw : draws) drawn_.rows.push_back(draw.row);
    std::vector<uint> blocks = instance_blocks(drawn_.rows, drawn_triangles(draws, scene_));
    drawn_.rows.emplace_back().first_triangle = std::numeric_limits<uint>::max();
    drawn_.read = start_upload(gpu_, instances_.reserve(drawn_.rows.size()), drawn_.rows);
    // The camera moves rows, and seldom changes which instances there are.
    if (blocks != drawn_.blocks) {
        const DeviceArray<uint> room = blocks_.reserve(blocks.size());
        drawn_.blocks = std::move(blocks);
        drawn_.read = start_upload(gpu_, room, drawn_.blocks);
    }
    return {instances_.get(), blocks_.get(),    meshes_.get(),   vertices_.get(),
            indices_.get(),   materials_.get(), textures_.get(), texels_.get()};
}

}  // namespace kilolux
