// SPDX-License-Identifier: Apache-2.0

// The unit vector along v, also where the square of v's length would overflow or underflow; zero
// for zero.
vec3 unit_or_zero(vec3 v) {
    vec3 a = abs(v);
    float largest = max(a.x, max(a.y, a.z));
    if (!(largest > 0.0)) return vec3(0.0);
    vec3 scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

// A direction for every v: +z, towards the viewer, where v has none, NaN included.
vec3 unit_or_z(vec3 v) {
    vec3 unit = unit_or_zero(v);
    return dot(unit, unit) > 0.0 ? unit : vec3(0.0, 0.0, 1.0);
}
