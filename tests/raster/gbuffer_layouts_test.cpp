// SPDX-License-Identifier: Apache-2.0
// Every layout holds what kernels/shared/gbuffer.h says of it, for one tilted surface.
#include "host/base/error.h"
#include "tests/raster/gl_fixture.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

using GBufferLayoutsTest = GlTest;

constexpr int kLayoutWidth = 37;
constexpr int kLayoutHeight = 23;

Scene tilted_scene() {
    Mesh mesh = quad_mesh(30.0f);
    for (std::size_t v = 0; v < 4; ++v) mesh.positions[v].z = 0.5f * mesh.positions[v].x;
    mesh.normals.assign(4, glm::normalize(glm::vec3(-0.5f, 0, 1)));
    Material material;
    material.base_color = {0.8f, 0.4f, 0.2f, 1};
    material.roughness = 0.6f;
    material.metallic = 0.2f;
    material.emissive = {0.5f, 2.0f, 1.0f};
    return one_object(mesh, material, translation({100, 20, -40}));
}

Camera tilted_camera() {
    Camera camera = look_at({102, 22, -30}, {101, 21, -40}, {0.2, 1, 0}, glm::radians(60.0));
    return camera;
}

GBufferNeeds needs_of(uint layout) { return make_needs(layout, 2.0f); }

HostGBuffer draw(uint layout) {
    return draw_gbuffer(tilted_scene(), tilted_camera(), kLayoutWidth, kLayoutHeight,
                        needs_of(layout));
}

double half_value(std::uint16_t bits) {
    const double sign = (bits & 0x8000u) != 0 ? -1.0 : 1.0;
    const int exponent = (bits >> 10) & 31;
    const int mantissa = bits & 1023;
    if (exponent == 0) return sign * std::ldexp(mantissa, -24);
    return sign * std::ldexp(1024 + mantissa, exponent - 25);
}

glm::dvec3 half_vector(const HostGBuffer& g, uint plane, int x, int y) {
    return {half_value(g.at<std::uint16_t>(plane, x, y)),
            half_value(g.at<std::uint16_t>(plane + 1, x, y)),
            half_value(g.at<std::uint16_t>(plane + 2, x, y))};
}

template <typename Check>
void for_each_pixel(Check check) {
    for (int y = 0; y < kLayoutHeight; ++y) {
        for (int x = 0; x < kLayoutWidth; ++x) check(x, y);
    }
}

TEST_F(GBufferLayoutsTest, ReadsAreThePlanesOfTheLayout) {
    for (uint layout = 0; layout <= GBUFFER_OCT_2X4; ++layout) {
        for (const bool optional : {false, true}) {
            GBufferNeeds needs = make_needs(layout);
            needs.material = needs.occlusion = needs.specular = needs.unlit = optional;
            needs.clearcoat = needs.coat_normals = optional && layout != GBUFFER_FULL;
            needs.sheen = needs.anisotropy = optional && layout != GBUFFER_FULL;
            const GBufferLayout planes = make_gbuffer_layout(needs, 16, 1);
            const TargetPlan plan = plan_targets(needs);
            std::vector<uint> expected;
            std::vector<uint> read;
            for (uint plane = 0; plane < PLANE_COUNT; ++plane) {
                if (planes.offset_bytes[plane] != PLANE_ABSENT) expected.push_back(plane);
            }
            for (const PlaneRead& r : plan.reads) read.push_back(r.plane);
            EXPECT_EQ(read, expected) << gbuffer_layout_name(layout) << " optional " << optional;
        }
    }
}

TEST_F(GBufferLayoutsTest, MorePlanesThanOpenGlDrawsToAreRefused) {
    GBufferNeeds needs = make_needs(GBUFFER_FULL);
    needs.material = needs.occlusion = needs.specular = true;
    needs.clearcoat = needs.coat_normals = true;
    const std::string message = message_of<UsageError>([&] { plan_targets(needs); });
    EXPECT_EQ(message,
              "--geometry planes: 25 planes of --gbuffer full for this scene, OpenGL draws to 24 "
              "at once; take --geometry ids");
}

TEST_F(GBufferLayoutsTest, DepthIsTheSameInAll) {
    const HostGBuffer packed = draw(GBUFFER_PACKED);
    for (uint layout = 1; layout <= GBUFFER_OCT_2X4; ++layout) {
        const HostGBuffer g = draw(layout);
        for_each_pixel([&](int x, int y) {
            ASSERT_GT(g.depth(x, y), 0.0f) << x << "," << y;
            ASSERT_EQ(g.depth(x, y), packed.depth(x, y)) << gbuffer_layout_name(layout);
        });
    }
}

TEST_F(GBufferLayoutsTest, PackedAgreesWithFull) {
    const HostGBuffer full = draw(GBUFFER_FULL);
    const HostGBuffer g = draw(GBUFFER_PACKED);
    for_each_pixel([&](int x, int y) {
        expect_near(g.packed_normal(x, y), full.vector(PLANE_NORMAL_X, x, y), 7e-5, "normal");
        ASSERT_NEAR(g.bytes4(PLANE_ALBEDO, x, y).x, srgb_code(0.8), 0.6);
    });
}

TEST_F(GBufferLayoutsTest, HalfHoldsWorldSpace) {
    const Camera camera = tilted_camera();
    const HostGBuffer full = draw(GBUFFER_FULL);
    const HostGBuffer g = draw(GBUFFER_HALF);
    for_each_pixel([&](int x, int y) {
        const glm::dvec3 world =
            camera.position + camera.world_from_view * full.vector(PLANE_POSITION_X, x, y);
        // Half a unit in the last place: of numbers below 128 and 64.
        const glm::dvec3 error = glm::abs(half_vector(g, PLANE_POSITION_X, x, y) - world);
        ASSERT_LE(error.x, 0.03126);
        ASSERT_LE(error.y, 0.01564);
        ASSERT_LE(error.z, 0.01564);
        expect_near(half_vector(g, PLANE_NORMAL_X, x, y),
                    camera.world_from_view * full.vector(PLANE_NORMAL_X, x, y), 5e-4, "normal");
        ASSERT_EQ(g.bytes4(PLANE_ALBEDO, x, y), glm::ivec4(204, 102, 51, 153));
    });
    EXPECT_NEAR(g.bytes4(PLANE_MATERIAL, 5, 5).x, srgb_code(0.25), 0.6);
    EXPECT_EQ(g.bytes4(PLANE_MATERIAL, 5, 5).w, 51);
}

TEST_F(GBufferLayoutsTest, HalfPositionsStayFinite) {
    const Scene scene = one_object(quad_mesh(1e6f), {}, translation({0, 0, -1e5}));
    GBufferNeeds half;
    half.layout = GBUFFER_HALF;
    const HostGBuffer g = draw_gbuffer(scene, front_camera(1), 8, 8, half);
    EXPECT_EQ(half_value(g.at<std::uint16_t>(PLANE_POSITION_Z, 4, 4)), -65504.0);
}

TEST_F(GBufferLayoutsTest, NormalXyHoldsXAndY) {
    const HostGBuffer full = draw(GBUFFER_FULL);
    const HostGBuffer g = draw(GBUFFER_NORMAL_XY);
    for_each_pixel([&](int x, int y) {
        const uint bits = g.at<uint>(PLANE_NORMAL, x, y);
        const glm::dvec3 normal = full.vector(PLANE_NORMAL_X, x, y);
        ASSERT_NEAR((bits & 0xffffu) / 65535.0 * 2.0 - 1.0, normal.x, 1.6e-5);
        ASSERT_NEAR((bits >> 16) / 65535.0 * 2.0 - 1.0, normal.y, 1.6e-5);
    });
}

TEST_F(GBufferLayoutsTest, Oct2x4HoldsTwoRows) {
    const HostGBuffer full = draw(GBUFFER_FULL);
    const HostGBuffer g = draw(GBUFFER_OCT_2X4);
    for_each_pixel([&](int x, int y) {
        const float4 row_0 = g.at<float4>(PLANE_ROW_0, x, y);
        const float4 row_1 = g.at<float4>(PLANE_ROW_1, x, y);
        ASSERT_EQ(glm::dvec3(row_0.x, row_0.y, row_0.z), full.vector(PLANE_POSITION_X, x, y));
        ASSERT_EQ(static_cast<uint>(row_0.w), 204u | 102u << 8 | 51u << 16);
        const FV3 normal = octahedral_decode(row_1.x, row_1.y);
        expect_near({normal.x, normal.y, normal.z}, full.vector(PLANE_NORMAL_X, x, y), 1e-6,
                    "normal");
        ASSERT_EQ(row_1.z, 0.6f);
        ASSERT_EQ(row_1.w, 0.2f);
    });
}

// The bridge's way: into a buffer object, planes at the layout's offsets.
TEST_F(GBufferLayoutsTest, PlanesReadIntoAPixelPackBuffer) {
    const Scene scene = tilted_scene();
    const GpuScene gpu(scene);
    const GBufferNeeds needs = needs_of(GBUFFER_PACKED);
    GeometryPass pass(gpu, needs);
    pass.draw(tilted_camera(), kLayoutWidth, kLayoutHeight);
    const GBufferLayout layout = make_gbuffer_layout(needs, 48, kLayoutHeight);
    const std::vector<std::byte> expected = read_gbuffer(pass.targets(), layout, 48);
    const std::vector<std::byte> zero(expected.size());
    const GlBuffer buffer = make_buffer();
    glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(zero.size()), zero.data(), 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name());
    for (const PlaneRead& read : pass.targets().reads()) {
        read_plane(pass.targets(), read, 48,
                   reinterpret_cast<void*>(std::uintptr_t{layout.offset_bytes[read.plane]}));
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    std::vector<std::byte> got(zero.size());
    glGetNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(got.size()), got.data());
    check_gl_errors("read");
    EXPECT_EQ(got, expected);
}

}  // namespace
}  // namespace kilolux
