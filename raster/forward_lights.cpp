// SPDX-License-Identifier: Apache-2.0
#include "raster/forward_lights.h"

#include <algorithm>
#include <array>
#include <vector>

#include "raster/shaders/draw_rows.h"

namespace kilolux {
namespace {

float rotate_row(const float4& row, const float4& v) {
    return fma(row.z, v.z, fma(row.y, v.y, row.x * v.x));
}

float4 rotated(const View& view, const float4& v, float w) {
    return {rotate_row(view.view_from_world_x, v), rotate_row(view.view_from_world_y, v),
            rotate_row(view.view_from_world_z, v), w};
}

// New contents; never empty, since an empty buffer cannot be bound.
template <typename Row>
void refill(const GlBuffer& buffer, std::span<const Row> rows) {
    constexpr std::array<std::byte, 64> kNothing{};
    const void* bytes = rows.empty() ? static_cast<const void*>(kNothing.data()) : rows.data();
    const std::size_t size = rows.empty() ? kNothing.size() : rows.size_bytes();
    glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(size), bytes, GL_STREAM_DRAW);
}

}  // namespace

ShadeLight shade_light(const View& view, const Light& light) {
    const float range = light.position_range.w;
    ShadeLight out{};
    out.position_inv_range2 =
        rotated(view, light.position_range, std::min(1.0f / (range * range), 1e38f));
    out.color_scale = light.color_scale;
    out.axis_cos = rotated(view, light.axis_cos, light.axis_cos.w);
    return out;
}

ForwardLightBuffers::ForwardLightBuffers()
    : frame_(make_buffer()),
      lights_(make_buffer()),
      directional_(make_buffer()),
      cluster_offsets_(make_buffer()),
      light_lists_(make_buffer()) {}

void ForwardLightBuffers::upload(const ForwardLights& lights, const View& view) {
    std::vector<ShadeLight> local;
    local.reserve(lights.lights.size());
    for (const Light& light : lights.lights) local.push_back(shade_light(view, light));
    std::vector<DirectionalLight> directional;
    for (const DirectionalLight& light : lights.directional) {
        directional.push_back({rotated(view, light.to_light, 0.0f), light.color});
    }
    ForwardRow frame{};
    frame.view = view;
    frame.grid = lights.grid;
    frame.light_count = static_cast<uint>(local.size());
    frame.directional_count = static_cast<uint>(directional.size());
    frame.ambient = lights.ambient;
    refill(frame_, std::span<const ForwardRow>(&frame, 1));
    refill(lights_, std::span<const ShadeLight>(local));
    refill(directional_, std::span<const DirectionalLight>(directional));
    refill(cluster_offsets_, lights.cluster_offsets);
    refill(light_lists_, lights.light_lists);
}

void ForwardLightBuffers::bind() const {
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, frame_.name());
    GLuint binding = 0;
    for (const GlBuffer* buffer : {&lights_, &directional_, &cluster_offsets_, &light_lists_}) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding++, buffer->name());
    }
}

}  // namespace kilolux
