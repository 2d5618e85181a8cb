// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "raster/gl_object.h"

namespace kilolux {

/// The light of one frame of forward shading.
struct ForwardLights {
    std::span<const Light> lights;                  // camera-relative
    std::span<const DirectionalLight> directional;  // camera-relative
    float ambient = 0.0f;                           // radiance that falls in from everywhere
    // forward-plus only: lights of coarse cluster c are lists[offsets[c] .. offsets[c + 1]),
    // ascending.
    ClusterGrid grid{};
    std::span<const uint> cluster_offsets;
    std::span<const uint> light_lists;
};

/// A light in view space, as kernels/prepare_lights.cl makes it.
ShadeLight shade_light(const View& view, const Light& light);

/// An array that shaders read through a texture unit. llvmpipe reads a storage buffer lane by lane,
/// which took six times as long as all arithmetic of a light together; a texel it reads at once.
class BufferTexture {
 public:
    /// Texels of `format`, each of `texel_bytes`; `name` stands in error messages.
    BufferTexture(GLenum format, std::size_t texel_bytes, const char* name);

    /// New contents. Throws Error when OpenGL's buffer textures hold fewer texels.
    void refill(std::span<const std::byte> bytes);
    void bind(GLuint unit) const { glBindTextureUnit(unit, view_.name()); }

 private:
    GlBuffer buffer_;
    GlTexture view_;
    GLenum format_;
    std::size_t texel_bytes_;
    const char* name_;
};

/// Lights in buffers that forward.frag reads.
class ForwardLightBuffers {
 public:
    ForwardLightBuffers();

    /// Throws Error when there are more lights, clusters or list entries than a buffer texture
    /// holds.
    void upload(const ForwardLights& lights, const View& view);

    /// Binds uniform block 1, storage block 0 and the texture units that draw_rows.h names.
    void bind() const;

 private:
    GlBuffer frame_, directional_;
    BufferTexture light_rows_, cluster_offsets_, light_lists_;
};

}  // namespace kilolux
