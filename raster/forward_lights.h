// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/light_extras.h"
#include "kernels/shared/lights/light_transform.h"
#include "kernels/shared/view.h"
#include "raster/gl_object.h"

namespace kilolux {

/// The light of one frame of forward shading.
struct ForwardLights {
    std::span<const Light> lights;                  // camera-relative
    std::span<const DirectionalLight> directional;  // camera-relative
    uint seed = 0;                                  // of random ranges; 0: none is random
    float ambient = 0.0f;                           // radiance that falls in from everywhere
    // forward-plus only: lights of coarse cluster c are lists[offsets[c] .. offsets[c + 1]),
    // ascending.
    ClusterGrid grid{};
    std::span<const uint> cluster_offsets;
    std::span<const uint> light_lists;
    // With SceneFeatures::light_profiles: one per light, camera-relative, and their tables.
    std::span<const AimedProfile> profiles;
    std::span<const float> profile_tables;
    // With SceneFeatures::area_lights: one per light, camera-relative.
    std::span<const LightShape> shapes;
};

/// How shaders read lights and lists; the bits are the same. llvmpipe reads a storage buffer lane
/// by lane, which took six times as long as a light's arithmetic, but a texel at once; an NVIDIA
/// H200 takes a quarter longer with textures.
enum class LightAccess { storage, texture };

/// The faster one for the current context.
LightAccess faster_light_access();

/// An array for shaders, as a storage block and as a texture.
class LightArray {
 public:
    /// Texels of `format`, each of `texel_bytes`; `name` appears in error messages.
    LightArray(GLenum format, std::size_t texel_bytes, const char* name);

    /// Replaces the contents. Throws Error when textures are read and OpenGL's hold fewer texels.
    void refill(std::span<const std::byte> bytes, LightAccess access);
    void bind(GLuint storage_block, GLuint texture_unit) const;

 private:
    GlBuffer buffer_;
    GlTexture texture_;
    GLenum format_;
    std::size_t texel_bytes_;
    const char* name_;
};

/// Buffers of lights that forward.frag reads.
class ForwardLightBuffers {
 public:
    explicit ForwardLightBuffers(LightAccess access);

    /// Throws Error when there are more lights, clusters or list entries than can be read.
    void upload(const ForwardLights& lights, const View& view);

    /// Binds uniform block 1, storage blocks 0 to 6 and the texture units that draw_rows.h names.
    void bind() const;

 private:
    LightAccess access_;
    GlBuffer frame_, directional_;
    LightArray lights_, cluster_offsets_, light_lists_, profiles_, profile_tables_, shapes_;
};

}  // namespace kilolux
