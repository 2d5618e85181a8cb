// SPDX-License-Identifier: Apache-2.0
#include "raster/forward_lights.h"

#include <fmt/format.h>
#include <array>
#include <vector>

#include "host/base/error.h"
#include "raster/gl_context.h"
#include "raster/shaders/draw_rows.h"

namespace kilolux {
namespace {

// Replaces the contents; never empty, since an empty buffer cannot be bound.
void refill_buffer(const GlBuffer& buffer, std::span<const std::byte> bytes) {
    constexpr std::array<std::byte, 64> kNothing{};
    if (bytes.empty()) bytes = kNothing;
    glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                      GL_STREAM_DRAW);
}

std::size_t most_texels() {
    GLint texels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    return static_cast<std::size_t>(texels);
}

}  // namespace

LightAccess faster_light_access() {
    return is_software_renderer() ? LightAccess::texture : LightAccess::storage;
}

LightArray::LightArray(GLenum format, std::size_t texel_bytes, const char* name)
    : buffer_(make_buffer()),
      texture_(make_texture(GL_TEXTURE_BUFFER)),
      format_(format),
      texel_bytes_(texel_bytes),
      name_(name) {}

void LightArray::refill(std::span<const std::byte> bytes, LightAccess access) {
    const std::size_t texels = bytes.size() / texel_bytes_;
    if (access == LightAccess::texture && texels > most_texels()) {
        throw Error(
            fmt::format("forward renderer: {} need {} texels of a buffer texture; OpenGL "
                        "has at most {} here",
                        name_, texels, most_texels()));
    }
    refill_buffer(buffer_, bytes);
    if (access == LightAccess::texture) {
        glTextureBuffer(texture_.name(), format_, buffer_.name());
    }
}

void LightArray::bind(GLuint storage_block, GLuint texture_unit) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, storage_block, buffer_.name());
    glBindTextureUnit(texture_unit, texture_.name());
}

ForwardLightBuffers::ForwardLightBuffers(LightAccess access)
    : access_(access),
      frame_(make_buffer()),
      directional_(make_buffer()),
      lights_(GL_RGBA32F, sizeof(float4), "lights"),
      cluster_offsets_(GL_R32UI, sizeof(uint), "clusters"),
      light_lists_(GL_R32UI, sizeof(uint), "light lists"),
      profiles_(GL_RGBA32F, sizeof(float4), "light profiles"),
      profile_tables_(GL_R32F, sizeof(float), "light profiles' tables"),
      shapes_(GL_RGBA32F, sizeof(float4), "light shapes") {}

void ForwardLightBuffers::upload(const ForwardLights& lights, const View& view) {
    std::vector<ShadeLight> local;
    local.reserve(lights.lights.size());
    for (std::size_t i = 0; i < lights.lights.size(); ++i) {
        local.push_back(shade_light(view, lights.lights[i], static_cast<uint>(i), lights.seed));
    }
    std::vector<DirectionalLight> directional;
    for (const DirectionalLight& light : lights.directional) {
        directional.push_back({rotated(view, light.to_light, 0.0f), light.color});
    }
    ForwardRow frame{};
    frame.grid = lights.grid;
    frame.light_count = static_cast<uint>(local.size());
    frame.directional_count = static_cast<uint>(directional.size());
    frame.ambient = lights.ambient;
    refill_buffer(frame_, std::as_bytes(std::span(&frame, 1)));
    refill_buffer(directional_, std::as_bytes(std::span(directional)));
    lights_.refill(std::as_bytes(std::span(local)), access_);
    cluster_offsets_.refill(std::as_bytes(lights.cluster_offsets), access_);
    light_lists_.refill(std::as_bytes(lights.light_lists), access_);
    std::vector<AimedProfile> profiles;
    for (const AimedProfile& p : lights.profiles) profiles.push_back(aimed_in_view(view, p));
    profiles_.refill(std::as_bytes(std::span(profiles)), access_);
    profile_tables_.refill(std::as_bytes(lights.profile_tables), access_);
    std::vector<LightShape> shapes;
    for (const LightShape& shape : lights.shapes) shapes.push_back(shape_in_view(view, shape));
    shapes_.refill(std::as_bytes(std::span(shapes)), access_);
}

void ForwardLightBuffers::bind() const {
    glBindBufferBase(GL_UNIFORM_BUFFER, FORWARD_BLOCK, frame_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, directional_.name());
    lights_.bind(1, LIGHTS_UNIT);
    cluster_offsets_.bind(2, CLUSTER_OFFSETS_UNIT);
    light_lists_.bind(3, LIGHT_LISTS_UNIT);
    profiles_.bind(4, LIGHT_PROFILES_UNIT);
    profile_tables_.bind(5, PROFILE_TABLES_UNIT);
    shapes_.bind(6, LIGHT_SHAPES_UNIT);
}

}  // namespace kilolux
