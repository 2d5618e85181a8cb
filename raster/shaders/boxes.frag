#version 450 core
// SPDX-License-Identifier: Apache-2.0
layout(location = 2) uniform vec4 target;  // x, y, width, height [pixel]
layout(binding = 0) uniform sampler2D depths;
in vec4 color;
in float depth;
layout(location = 0) out vec4 out_color;

// Boxes touch their surfaces: edges up to this factor deeper than a surface still count as seen.
const float kMargin = 1.005;
const float kHidden = 0.12;

void main() {
    vec2 place = (gl_FragCoord.xy - target.xy) / target.zw;
    float surface = texture(depths, vec2(place.x, 1.0 - place.y)).r;
    bool hidden = surface > 0.0 && depth > surface * kMargin;
    out_color = vec4(color.rgb, hidden ? color.a * kHidden : color.a);
}
