#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A scene vertex to view and clip space. What a variant needs is 1, the rest 0: TEXCOORD0,
// TEXCOORD1, VERTEX_COLOR, TANGENT, POSITION, SURFACE (0: coverage alone), IDS.

layout(location = 0) uniform vec4 view_from_object[3];    // rows; w: offset
// Rows; [0].w: -1 where the object is mirrored, else 1.
layout(location = 3) uniform vec4 normal_from_object[3];
layout(location = 6) uniform mat4 clip_from_view;
layout(location = 9) uniform uint first_triangle;
layout(location = 10) uniform vec3 eye_high;  // the camera in object space, a pair of floats
layout(location = 11) uniform vec3 eye_low;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 texcoord0;
layout(location = 4) in vec2 texcoord1;
layout(location = 5) in vec4 color;

#if POSITION
layout(location = 0) out vec3 v_position;  // view space [m]
#endif
#if SURFACE
layout(location = 1) out vec3 v_normal;  // view space, unit at the vertices
#endif
#if TANGENT
layout(location = 2) out vec4 v_tangent;  // view space, unit at the vertices; w: handedness
#endif
#if TEXCOORD0
layout(location = 3) out vec2 v_texcoord0;
#endif
#if TEXCOORD1
layout(location = 4) out vec2 v_texcoord1;
#endif
#if VERTEX_COLOR
layout(location = 5) out vec4 v_color;
#endif

#if IDS
layout(location = 6) flat out uint v_first_triangle;
#endif

invariant gl_Position;

#include "raster/shaders/normalize.glsl"

void main() {
    // As InstanceRow says.
    precise vec4 p = vec4((position - eye_high) - eye_low, 1.0);
    vec3 p_view = vec3(dot(view_from_object[0], p), dot(view_from_object[1], p),
                       dot(view_from_object[2], p));
    gl_Position = clip_from_view * vec4(p_view, 1.0);
#if IDS
    v_first_triangle = first_triangle;
#endif
#if POSITION
    v_position = p_view;
#endif
#if SURFACE
    v_normal = unit_or_zero(vec3(dot(normal_from_object[0].xyz, normal),
                                 dot(normal_from_object[1].xyz, normal),
                                 dot(normal_from_object[2].xyz, normal)));
#endif
#if TANGENT
    v_tangent.xyz = unit_or_zero(vec3(dot(view_from_object[0].xyz, tangent.xyz),
                                      dot(view_from_object[1].xyz, tangent.xyz),
                                      dot(view_from_object[2].xyz, tangent.xyz)));
    // A mirror turns a right-handed basis into a left-handed one.
    v_tangent.w = tangent.w * normal_from_object[0].w;
#endif
#if TEXCOORD0
    v_texcoord0 = texcoord0;
#endif
#if TEXCOORD1
    v_texcoord1 = texcoord1;
#endif
#if VERTEX_COLOR
    v_color = color;
#endif
}
