// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/base/surface_features.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "kernels/shared/shadow.h"
#include "kernels/shared/surface_scene.h"

/// What passes between the stages that make surfaces.
namespace kilolux {

/// Defines the macros of kernels that read surfaces.
void define_surfaces(BuildOptions& options, const SurfaceFeatures& surfaces, const Tuning& tuning);

/// A scene's surfaces on the device, as kernels/shared/surface_scene.h has them.
struct SurfaceBuffers {
    DeviceArray<InstanceRow> instances;  // drawn ones, in the order of their ids, and an end
    DeviceArray<uint> instance_blocks;   // of every INSTANCE_BLOCK-th triangle, and of the last
    DeviceArray<MeshRow> meshes;
    DeviceArray<float> vertices;
    DeviceArray<uint> indices;
    DeviceArray<SurfaceMaterial> materials;
    DeviceArray<TextureRow> textures;
    DeviceArray<std::uint64_t> texels;

    void each(auto&& set) const {  // SCENE_ARGS
        set("instances", instances);
        set("instance_blocks", instance_blocks);
        set("meshes", meshes);
        set("vertices", vertices);
        set("indices", indices);
        set("materials", materials);
        set("textures", textures);
        set("texels", texels);
    }
};

/// Shadow casters in shadow space, laid out as in kernels/shared/shadow.h, and the materials and
/// textures of those that alpha masks cut.
struct ShadowCasters {
    DeviceArray<ShadowNode> nodes;  // 0: the root
    DeviceArray<float> triangles;   // [count][3][3]
    DeviceArray<MaskedCaster> masked;
    DeviceArray<TintCaster> tinting;  // in the second hierarchy
    DeviceArray<SurfaceMaterial> materials;
    DeviceArray<TextureRow> textures;
    DeviceArray<std::uint64_t> texels;

    void each(auto&& set) const {  // CASTER_ARGS
        set("shadow_nodes", nodes);
        set("casters", triangles);
        set("masked_casters", masked);
        set("tint_casters", tinting);
        set("materials", materials);
        set("textures", textures);
        set("texels", texels);
    }
};

/// The casters of a frame's shadows, and where its pixels' rays end.
struct ShadowInput {
    ShadowCasters casters;
    ShadowView view{};
    DeviceArray<float> origins;  // [4][height][stride], see kernels/shadows/shadow_space.h
    // With KernelFeatures::sampled_shadows, see kernels/shadows/shadow_pick.h.
    float rays = 0.0f;  // most rays a pixel, on average
    uint seed = 0;      // of the frame and sample

    void each(auto&& set) const {  // SHADOW_ARGS
        set("shadow", view);
        set("origins", origins);
        set(casters);
    }
};

/// The inputs of picking lights for sampled shadows.
struct ShadowSamples {
    DeviceArray<float> whole;  // [3][height][stride]: radiance if all lights are seen
    float rays = 0.0f;         // see ShadowInput
    uint seed = 0;

    void each(auto&& set) const {  // SAMPLE_ARGS
        set("whole", whole);
        set("rays", rays);
        set("seed", seed);
    }
};

/// Defines the macros of kernels that cast shadows.
void define_casters(BuildOptions& options, const SurfaceFeatures& surfaces, const Tuning& tuning);

/// Bits that say which pixels see which lights, laid out as in kernels/shadows/cast_shadows.h.
struct ShadowWords {
    DeviceArray<uint> offsets;  // [tile_count + 1]
    uint capacity = 0;          // words that there is room for
    DeviceArray<uint> words;

    void each(auto&& set) const {  // WORD_ARGS
        set("word_offsets", offsets);
        set("word_capacity", capacity);
        set("words", words);
    }
};

/// Where shadows are cast to.
struct ShadowTargets {
    ShadowWords words;
    DeviceArray<uint> kept{};  // see TARGET_ARGS; none: all are cast

    void each(auto&& set) const {  // TARGET_ARGS
        set(words);
        set("kept", kept);
    }
};

/// Triangles of each tile of the picture: lists[offsets[t] .. offsets[t + 1]), numbers along the
/// instances, as kernels/surfaces/raster_tile.h has them.
struct TriangleLists {
    DeviceArray<RasterRow> triangles;  // by number; those of the lists
    DeviceArray<uint> offsets;         // [tile_count + 1]
    DeviceArray<uint> lists;           // [capacity]
    uint capacity = 0;
    uint tile_count = 0;

    void each(auto&& set) const {  // TRIANGLE_LIST_ARGS
        set("triangles", triangles);
        set("offsets", offsets);
        set("lists", lists);
        set("capacity", capacity);
    }
};

/// Defines the macros of bin_triangles and raster_triangles that describe the tiles.
void define_tiles(BuildOptions& options, const Tuning& tuning);

/// Tiles of a view.
uint raster_tile_count(const View& view, const Tuning& tuning);

}  // namespace kilolux
