// SPDX-License-Identifier: Apache-2.0
// Normals packed into two 16-bit numbers, by OpenGL and by OpenCL.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/certify/cases.h"
#include "host/certify/opengl_beside.h"
#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "raster/compute_probe.h"

namespace kilolux {
namespace {

constexpr std::string_view kOctHeaders[] = {"kernels/device/lanes.h", "kernels/shared/gbuffer.h"};
constexpr std::string_view kOctProbe = R"(
kernel void probe(global const uint* codes, uint count, global float* out) {
    uint i = get_global_id(0) * VW;
    UV packed = lane_load(codes + i);
    FV x = fma(lane_to_float(packed & 0xffffu), fv(2.0f / 65535.0f), fv(-1.0f));
    FV y = fma(lane_to_float(packed >> 16), fv(2.0f / 65535.0f), fv(-1.0f));
    FV3 n = octahedral_decode(x, y);
    lane_store(n.x, out + i);
    lane_store(n.y, out + count + i);
    lane_store(n.z, out + 2 * count + i);
}
)";
constexpr const char* kOctEncodeGlsl = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer In { vec4 direction[]; };
layout(std430, binding = 1) buffer Out { uint code[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= direction.length()) return;
    FV3 e = octahedral_encode(fv3(direction[i].x, direction[i].y, direction[i].z));
    code[i] = packUnorm2x16(vec2(e.x, e.y) * 0.5 + 0.5);
}
)";
constexpr const char* kOctDecodeGlsl = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer In { uint code[]; };
layout(std430, binding = 1) buffer Out { vec4 normal[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= code.length()) return;
    float x = fma(float(code[i] & 0xffffu), 2.0 / 65535.0, -1.0);
    float y = fma(float(code[i] >> 16), 2.0 / 65535.0, -1.0);
    FV3 n = octahedral_decode(x, y);
    normal[i] = vec4(n.x, n.y, n.z, 0.0);
}
)";

// 6 axes, 12 edges and 8 faces of the octahedron, with zeros of both signs; then random directions,
// some of them near the seams z = 0 and x = 0.
std::vector<float4> hard_directions() {
    std::vector<float4> out;
    const auto add = [&](glm::dvec3 v, bool negative_zero) {
        const glm::vec3 n(glm::normalize(v));
        const auto zero = [&](float c) { return c == 0.0f && negative_zero ? -0.0f : c; };
        out.push_back({zero(n.x), zero(n.y), zero(n.z), 0.0f});
    };
    for (int i = 0; i < 27; ++i) {
        const glm::dvec3 v(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (v == glm::dvec3(0)) continue;
        add(v, false);
        add(v, true);
    }
    Random random(25);
    while (out.size() < 1000000) {
        glm::dvec3 v = random.direction();
        const std::size_t kind = out.size() % 10;
        if (kind == 0) v.z *= random.log_uniform(1e-8, 1e-2);
        if (kind == 1) v.x *= random.log_uniform(1e-8, 1e-2);
        add(v, false);
    }
    return out;
}

constexpr std::size_t kSpecialDirections = 52;

std::vector<float4> decoded_by_device(const Gpu& gpu, std::vector<uint> codes) {
    const std::size_t count = codes.size();
    codes.resize(round_up(count, 16), 0u);
    const auto planes =
        run_probe<float>(gpu, {kOctHeaders, kOctProbe}, codes.size() / lanes_of(gpu),
                         3 * codes.size(), codes, static_cast<uint>(codes.size()));
    std::vector<float4> normals;
    for (std::size_t i = 0; i < count; ++i) {
        normals.push_back(
            {planes[i], planes[codes.size() + i], planes[2 * codes.size() + i], 0.0f});
    }
    return normals;
}

// As GLSL's packUnorm2x16.
std::vector<uint> encoded_by_host(const std::vector<float4>& directions) {
    std::vector<uint> codes;
    const auto code = [](float c) {
        return static_cast<uint>(std::lround(65535.0f * (0.5f * c + 0.5f)));
    };
    for (const float4& d : directions) {
        const FV3 e = octahedral_encode(fv3(d.x, d.y, d.z));
        codes.push_back(code(e.x) | code(e.y) << 16);
    }
    return codes;
}

double angle_rad(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

void try_octahedral_wrap(const Gpu& gpu, Findings& findings) {
    const std::vector<float4> directions = hard_directions();
    const std::optional<GlContext> context = opengl_beside(findings);
    const std::vector<std::string> header = {"kernels/shared/gbuffer.h"};
    const std::vector<uint> codes =
        context ? run_compute<uint>(compute_program(header, kOctEncodeGlsl), directions)
                : encoded_by_host(directions);
    const std::vector<float4> device = decoded_by_device(gpu, codes);
    const std::vector<float4> glsl =
        context ? run_compute<float4>(compute_program(header, kOctDecodeGlsl), codes) : device;
    Worst degrees;
    Worst axes;
    Worst apart;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const glm::dvec3 n = xyz(directions[i]);
        const auto place = [&] { return fmt::format("{:f} {:f} {:f}", n.x, n.y, n.z); };
        const double angle = std::max(angle_rad(n, xyz(device[i])), angle_rad(n, xyz(glsl[i])));
        degrees.add(glm::degrees(angle), place);
        const bool axis = std::abs(n.x) + std::abs(n.y) + std::abs(n.z) == 1.0;
        if (i < kSpecialDirections && axis) axes.add(angle, place);
        for (int c = 0; c < 3; ++c) {
            apart.add(std::abs(xyz(device[i])[c] - xyz(glsl[i])[c]) / 0x1p-24, place);
        }
    }
    findings.at_most("degrees off after 2x16 bits", degrees, 0.0038);
    findings.at_most("axes off [rad]", axes, 1e-4);
    findings.at_least("axes", axes.checked, 12);
    // What GLSL 4.50 (4.7.1) allows a driver, in ulp of a component in [1/2, 1): an fma of two
    // roundings moves x and y by u each, 2.5 ulp at the face's slope of sqrt(3); division 2.5 ulp;
    // sqrt inherits 2 + 2.5.
    findings.at_most("GLSL against OpenCL [ulp]", apart, 2.5 + 2.5 + 4.5);
}

}  // namespace kilolux
