#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A scene vertex to clip space.
#include "raster/shaders/scene.glsl"

layout(location = 0) in vec3 position;

invariant gl_Position;

void main() {
    // As InstanceRow says.
    vec3 high = scene_instances[drawn_instance].eye_high.xyz;
    vec3 low = scene_instances[drawn_instance].eye_low.xyz;
    precise vec4 p = vec4((position - high) - low, 1.0);
    vec3 p_view = vec3(dot(scene_instances[drawn_instance].view_from_object[0], p),
                       dot(scene_instances[drawn_instance].view_from_object[1], p),
                       dot(scene_instances[drawn_instance].view_from_object[2], p));
    mat4 clip_from_view = mat4(camera.clip_from_view[0], camera.clip_from_view[1],
                               camera.clip_from_view[2], camera.clip_from_view[3]);
    gl_Position = clip_from_view * vec4(p_view, 1.0);
}
