// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/scene/draw_list.h"
#include "host/scene/rows/surface_rows.h"
#include "host/scene/scene.h"
#include "host/stages/surfaces/resolve_surfaces.h"

namespace kilolux {

/// Bytes that a SurfaceScene takes on the device.
std::uint64_t surface_scene_bytes(const Scene& scene, const SurfaceFeatures& features);

/// SurfaceBuffers::instance_blocks of instances to draw with so many triangles in all.
std::vector<uint> instance_blocks(std::span<const InstanceRow> rows, uint triangles);

/// A scene's surfaces on the OpenCL device: vertices, triangles, materials, and textures with their
/// mip levels. Only attributes that the features read are there; surfaces that blend are not.
class SurfaceScene {
 public:
    /// The scene must outlive this; its textures must stay as they are, its meshes and materials as
    /// many. Throws Error when the device cannot hold it, or an image is too large.
    SurfaceScene(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                 const SurfaceFeatures& features);
    ~SurfaceScene();
    SurfaceScene(const SurfaceScene&) = delete;
    SurfaceScene& operator=(const SurfaceScene&) = delete;

    /// The scene with these instances, numbered as their rows say and ascending; materials and
    /// vertices are uploaded anew where revisions say that they changed. Valid until the next call.
    SurfaceBuffers at(std::span<const Draw> draws);

    const SurfaceFeatures& features() const { return features_; }

 private:
    void upload_rows(const Tuning& tuning);
    void refresh();

    Gpu gpu_;
    const Scene& scene_;
    SurfaceFeatures features_;
    MeshFeatures solid_;
    SurfaceRows rows_;  // on the device
    // Host memory that the device may still be reading.
    struct Drawn {
        std::vector<InstanceRow> rows;
        std::vector<uint> blocks;
        cl::Event read;  // both are read
    };
    Drawn drawn_;
    GrowingArray<InstanceRow> instances_;
    GrowingArray<uint> blocks_;
    GrowingArray<MeshRow> meshes_;
    GrowingArray<float> vertices_;
    GrowingArray<uint> indices_;
    GrowingArray<SurfaceMaterial> materials_;
    GrowingArray<TextureRow> textures_;
    GrowingArray<std::uint64_t> texels_;
};

}  // namespace kilolux
