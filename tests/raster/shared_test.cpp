// SPDX-License-Identifier: Apache-2.0
// What C++ and GLSL share means the same in both: struct layouts, depth slices, octahedral normals.
#include <bit>
#include <cstddef>
#include <random>

#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "raster/compute_probe.h"
#include "raster/shaders/draw_rows.h"
#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using SharedTest = GlTest;

struct Member {
    std::string name;
    std::size_t offset;
};

struct SharedStruct {
    std::string name;
    std::string header;
    std::size_t size;
    std::vector<Member> members;
    std::string use;  // a float of element 1, so that the block is active
};

#define MEMBER(Struct, member) \
    Member { #member, offsetof(Struct, member) }

std::vector<SharedStruct> shared_structs() {
    return {
        {"Light",
         "kernels/shared/light.h",
         sizeof(Light),
         {MEMBER(Light, position_range), MEMBER(Light, color_scale), MEMBER(Light, axis_cos)},
         "axis_cos.w"},
        {"ShadeLight",
         "kernels/shared/light.h",
         sizeof(ShadeLight),
         {MEMBER(ShadeLight, position_inv_range2), MEMBER(ShadeLight, color_scale),
          MEMBER(ShadeLight, axis_cos)},
         "axis_cos.w"},
        {"DirectionalLight",
         "kernels/shared/light.h",
         sizeof(DirectionalLight),
         {MEMBER(DirectionalLight, to_light), MEMBER(DirectionalLight, color)},
         "color.w"},
        {"View",
         "kernels/shared/view.h",
         sizeof(View),
         {MEMBER(View, ray), MEMBER(View, depth), MEMBER(View, width), MEMBER(View, height),
          MEMBER(View, stride), MEMBER(View, orthographic), MEMBER(View, view_from_world_x),
          MEMBER(View, view_from_world_y), MEMBER(View, view_from_world_z),
          MEMBER(View, camera_position), MEMBER(View, first_row), MEMBER(View, first_column),
          MEMBER(View, layer_mask), MEMBER(View, unused0)},
         "depth.x"},
        {"ClusterGrid",
         "kernels/shared/cluster_grid.h",
         sizeof(ClusterGrid),
         {MEMBER(ClusterGrid, tiles_x), MEMBER(ClusterGrid, tiles_y), MEMBER(ClusterGrid, slices),
          MEMBER(ClusterGrid, slices_per_octave), MEMBER(ClusterGrid, tile_width),
          MEMBER(ClusterGrid, tile_height), MEMBER(ClusterGrid, z_first_bits),
          MEMBER(ClusterGrid, cluster_count), MEMBER(ClusterGrid, position_pad),
          MEMBER(ClusterGrid, unused0), MEMBER(ClusterGrid, unused1),
          MEMBER(ClusterGrid, fine_slice_bits)},
         "cluster_count"},
        {"InstanceRow",
         "kernels/shared/surface_scene.h",
         sizeof(InstanceRow),
         {{"view_from_object[0]", offsetof(InstanceRow, view_from_object)},
          {"normal_from_object[0]", offsetof(InstanceRow, normal_from_object)},
          MEMBER(InstanceRow, eye_high),
          MEMBER(InstanceRow, eye_low),
          MEMBER(InstanceRow, first_triangle),
          MEMBER(InstanceRow, mesh),
          MEMBER(InstanceRow, is_similarity),
          MEMBER(InstanceRow, first_caster)},
         "first_triangle"},
        {"MeshRow",
         "kernels/shared/surface_scene.h",
         sizeof(MeshRow),
         {MEMBER(MeshRow, first_float), MEMBER(MeshRow, vertex_floats),
          MEMBER(MeshRow, first_index), MEMBER(MeshRow, material), MEMBER(MeshRow, normal),
          MEMBER(MeshRow, tangent), MEMBER(MeshRow, texcoord0), MEMBER(MeshRow, texcoord1),
          MEMBER(MeshRow, color), MEMBER(MeshRow, unused0), MEMBER(MeshRow, unused1),
          MEMBER(MeshRow, unused2)},
         "material"},
        {"SurfaceMaterial",
         "kernels/shared/surface_scene.h",
         sizeof(SurfaceMaterial),
         {{"row.base_color", offsetof(SurfaceMaterial, row)},
          {"row.emissive_cutoff", offsetof(MaterialRow, emissive_cutoff)},
          {"row.factors", offsetof(MaterialRow, factors)},
          {"row.specular", offsetof(MaterialRow, specular)},
          {"row.clearcoat", offsetof(MaterialRow, clearcoat)},
          {"row.sheen", offsetof(MaterialRow, sheen)},
          {"row.anisotropy", offsetof(MaterialRow, anisotropy)},
          {"row.volume", offsetof(MaterialRow, volume)},
          {"row.transmission", offsetof(MaterialRow, transmission)},
          {"row.uv_x[0]", offsetof(MaterialRow, uv_x)},
          {"row.uv_y[0]", offsetof(MaterialRow, uv_y)},
          {"textures[0]", offsetof(SurfaceMaterial, textures)},
          MEMBER(SurfaceMaterial, flags),
          MEMBER(SurfaceMaterial, lookup_use),
          MEMBER(SurfaceMaterial, unused0),
          MEMBER(SurfaceMaterial, lookup_shared)},
         "flags"},
        {"TextureRow",
         "kernels/shared/surface_scene.h",
         sizeof(TextureRow),
         {MEMBER(TextureRow, width),
          MEMBER(TextureRow, height),
          MEMBER(TextureRow, levels),
          MEMBER(TextureRow, filters),
          MEMBER(TextureRow, wrap_s),
          MEMBER(TextureRow, wrap_t),
          MEMBER(TextureRow, first_texel),
          MEMBER(TextureRow, unused0),
          {"level_offset[0]", offsetof(TextureRow, level_offset)}},
         "filters"},
        {"ForwardRow",
         "raster/shaders/draw_rows.h",
         sizeof(ForwardRow),
         {{"grid.tiles_x", offsetof(ForwardRow, grid)},
          MEMBER(ForwardRow, light_count),
          MEMBER(ForwardRow, directional_count),
          MEMBER(ForwardRow, ambient),
          MEMBER(ForwardRow, unused0)},
         "ambient"},
    };
}

GLint buffer_variable(GLuint program, const std::string& name, GLenum property) {
    const GLuint index = glGetProgramResourceIndex(program, GL_BUFFER_VARIABLE, name.c_str());
    if (index == GL_INVALID_INDEX) return -1;
    GLint value = -1;
    glGetProgramResourceiv(program, GL_BUFFER_VARIABLE, index, 1, &property, 1, nullptr, &value);
    return value;
}

TEST_F(SharedTest, StructsHaveTheSameLayout) {
    for (const SharedStruct& s : shared_structs()) {
        const GlProgram program =
            compute_program({s.header},
                            "layout(local_size_x = 1) in;\n"
                            "layout(std430, binding = 0) buffer Probe { " +
                                s.name +
                                " probe[]; };\n"
                                "layout(std430, binding = 1) buffer Out { float result; };\n"
                                "void main() { result = float(probe[1]." +
                                s.use + "); }\n");
        for (const Member& member : s.members) {
            EXPECT_EQ(buffer_variable(program.name(), "probe[0]." + member.name, GL_OFFSET),
                      static_cast<GLint>(member.offset))
                << s.name << "." << member.name;
        }
        EXPECT_EQ(buffer_variable(program.name(), "probe[0]." + s.members[0].name,
                                  GL_TOP_LEVEL_ARRAY_STRIDE),
                  static_cast<GLint>(s.size))
            << s.name;
        GLint count = 0;
        glGetProgramInterfaceiv(program.name(), GL_BUFFER_VARIABLE, GL_ACTIVE_RESOURCES, &count);
        const bool nested = s.name == "ForwardRow";  // its parts are counted by themselves
        EXPECT_TRUE(nested || count <= static_cast<GLint>(s.members.size()) + 1)
            << s.name << " has members that this test does not know";
    }
}

ClusterGrid grid_of(float z_first, uint slices_per_octave, uint slices) {
    ClusterGrid grid{};
    grid.tiles_x = 3;
    grid.tiles_y = 2;
    grid.slices = slices;
    grid.slices_per_octave = slices_per_octave;
    grid.z_first_bits = std::bit_cast<uint>(z_first);
    grid.cluster_count = 6 * slices;
    return grid;
}

std::vector<uint> depths_to_try(const ClusterGrid& grid) {
    std::vector<uint> bits;
    for (uint slice = 0; slice <= grid.slices; ++slice) {
        const uint boundary = std::bit_cast<uint>(depth_of_slice(grid, slice));
        for (uint ulp = 0; ulp <= 400; ++ulp) bits.push_back(boundary - 200u + ulp);
    }
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-20.0f, 40.0f);
    for (int i = 0; i < 100000; ++i) {
        bits.push_back(std::bit_cast<uint>(std::exp2(exponent(random))));
    }
    for (const float z : {0.0f, -0.0f, -1.0f, -1e30f, 1e30f, INFINITY, -INFINITY}) {
        bits.push_back(std::bit_cast<uint>(z));
    }
    return bits;
}

TEST_F(SharedTest, SlicesOfDepthAreTheSameInGlsl) {
    const GlProgram program =
        compute_program({"kernels/shared/cluster_grid.h"},
                        "layout(local_size_x = 64) in;\n"
                        "layout(std430, binding = 0) buffer In { uint z_bits[]; };\n"
                        "layout(std430, binding = 1) buffer Out { uint slice[]; };\n"
                        "layout(std430, binding = 2) buffer Grid { ClusterGrid grid; };\n"
                        "void main() {\n"
                        "    uint i = gl_GlobalInvocationID.x;\n"
                        "    if (i < z_bits.length()) slice[i] = slice_of_depth(grid, "
                        "uintBitsToFloat(z_bits[i]));\n"
                        "}\n");
    for (const ClusterGrid& grid :
         {grid_of(0.1f, 4, 94), grid_of(1e-3f, 8, 187), grid_of(0.37f, 1, 5), grid_of(1, 64, 24),
          grid_of(0.2f, 3, 50), grid_of(1.7f, 63, 400)}) {
        const GlBuffer buffer = storage_buffer(2, &grid, sizeof(grid));
        const std::vector<uint> bits = depths_to_try(grid);
        const std::vector<uint> slices = run_compute<uint>(program, bits);
        for (std::size_t i = 0; i < bits.size(); ++i) {
            ASSERT_EQ(slices[i], slice_of_depth(grid, std::bit_cast<float>(bits[i])))
                << "z = " << std::bit_cast<float>(bits[i]) << ", bits " << bits[i];
        }
    }
}

// Directions where octahedral maps go wrong: axes, edges, faces, seams; and random ones.
std::vector<float4> directions() {
    std::vector<float4> out;
    for (int i = 0; i < 27; ++i) {
        const glm::vec3 v(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (v == glm::vec3(0)) continue;
        const glm::vec3 n = glm::normalize(v);
        out.push_back({n.x, n.y, n.z, 0});
        out.push_back({n.x == 0 ? -0.0f : n.x, n.y == 0 ? -0.0f : n.y, n.z == 0 ? -0.0f : n.z, 0});
    }
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 100000; ++i) {
        glm::vec3 n(normal(random), normal(random), normal(random));
        if (i % 10 == 0) n.z *= 1e-6f;
        if (i % 10 == 1) n.x *= 1e-6f;
        n = glm::normalize(n);
        out.push_back({n.x, n.y, n.z, 0});
    }
    return out;
}

double angle_degrees(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

TEST_F(SharedTest, OctahedralNormalsGoThroughSixteenBits) {
    const GlProgram program = compute_program(
        {"kernels/shared/gbuffer.h"},
        "layout(local_size_x = 64) in;\n"
        "layout(std430, binding = 0) buffer In { vec4 direction[]; };\n"
        "layout(std430, binding = 1) buffer Out { vec4 decoded[]; };\n"
        "void main() {\n"
        "    uint i = gl_GlobalInvocationID.x;\n"
        "    if (i >= direction.length()) return;\n"
        "    FV3 e = octahedral_encode(fv3(direction[i].x, direction[i].y, direction[i].z));\n"
        "    vec2 code = unpackUnorm2x16(packUnorm2x16(vec2(e.x, e.y) * 0.5 + 0.5)) * 2.0 - 1.0;\n"
        "    FV3 n = octahedral_decode(code.x, code.y);\n"
        "    decoded[i] = vec4(n.x, n.y, n.z, 0.0);\n"
        "}\n");
    const std::vector<float4> in = directions();
    const std::vector<float4> out = run_compute<float4>(program, in);
    for (std::size_t i = 0; i < in.size(); ++i) {
        const glm::dvec3 n(in[i].x, in[i].y, in[i].z);
        const glm::dvec3 decoded(out[i].x, out[i].y, out[i].z);
        ASSERT_LT(angle_degrees(n, decoded), 0.0038)
            << "(" << n.x << ", " << n.y << ", " << n.z << ")";
        ASSERT_NEAR(glm::length(decoded), 1.0, 1e-6);
        const FV3 host = octahedral_encode(fv3(in[i].x, in[i].y, in[i].z));
        const FV3 back = octahedral_decode(host.x, host.y);
        ASSERT_LT(angle_degrees(n, {back.x, back.y, back.z}), 3e-5);
    }
}

TEST_F(SharedTest, ZeroNormalsEncodeAsTowardsTheViewer) {
    const FV3 e = octahedral_encode(fv3(0, 0, 0));
    const FV3 n = octahedral_decode(e.x, e.y);
    EXPECT_EQ(n.z, 1.0f);
}

}  // namespace
}  // namespace kilolux
