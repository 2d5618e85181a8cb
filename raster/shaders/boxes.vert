#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Edges of boxes: an instance a box, two vertices an edge.
layout(location = 0) in vec3 box_min;
layout(location = 1) in vec3 box_max;
layout(location = 2) in vec4 box_color;
layout(location = 0) uniform mat4 view_from_box;
layout(location = 1) uniform mat4 clip_from_view;
out vec4 color;
out float depth;  // [m]

void main() {
    // Edge e runs along axis e / 4; its other two coordinates are the bits of e % 4.
    int edge = gl_VertexID / 2;
    int axis = edge / 4;
    vec3 corner = vec3(0.0);
    corner[axis] = float(gl_VertexID % 2);
    corner[(axis + 1) % 3] = float(edge % 2);
    corner[(axis + 2) % 3] = float(edge / 2 % 2);
    vec4 position = view_from_box * vec4(mix(box_min, box_max, corner), 1.0);
    color = box_color;
    depth = -position.z;
    gl_Position = clip_from_view * position;
}
