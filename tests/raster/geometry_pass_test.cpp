// SPDX-License-Identifier: Apache-2.0
#include "raster/solid_pass.h"

#include <random>

#include "host/base/error.h"
#include "tests/raster/gl_fixture.h"

namespace kilolux {
namespace {

using GeometryPassTest = GlTest;

const GBufferNeeds kFull = make_needs(GBUFFER_FULL);

// Half a step of the 16-bit octahedral code, worst case 0.0037 degrees, as a chord; and float32.
constexpr double kPackedNormal = 7e-5;
constexpr double kFullNormal = 1e-6;

TEST_F(GeometryPassTest, BackgroundIsExactlyZero) {
    Scene empty;
    const HostGBuffer g = draw_gbuffer(empty, front_camera(2), 17, 31);
    for (const std::byte byte : g.bytes) ASSERT_EQ(byte, std::byte{0});
    Scene scene = one_object(quad_mesh(0.5f));
    const HostGBuffer part = draw_gbuffer(scene, front_camera(1), 64, 64);
    EXPECT_EQ(part.depth(0, 0), 0.0f);
    EXPECT_GT(part.depth(32, 32), 0.0f);
}

TEST_F(GeometryPassTest, CoversEveryPixelOfOddSizes) {
    const Scene scene = one_object(quad_mesh(1000.0f));
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {17, 31}, {33, 1}, {1, 64}, {257, 3}}) {
        const HostGBuffer g = draw_gbuffer(scene, front_camera(2), size.x, size.y);
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                ASSERT_FLOAT_EQ(g.depth(x, y), 0.05f)
                    << size.x << "x" << size.y << " at " << x << "," << y;
            }
            for (uint x = static_cast<uint>(size.x); x < g.stride; ++x) {
                ASSERT_EQ(g.depth(static_cast<int>(x), y), 0.0f) << "past the width";
            }
        }
    }
}

TEST_F(GeometryPassTest, RowZeroIsTheTopAndColumnZeroTheLeft) {
    Mesh quad = quad_mesh(0.5f);
    const Scene scene = one_object(quad, {}, translation({-0.5, 0.5, 0}));
    const HostGBuffer g = draw_gbuffer(scene, front_camera(1), 64, 64);
    EXPECT_GT(g.depth(16, 16), 0.0f) << "upper left";
    EXPECT_EQ(g.depth(48, 16), 0.0f) << "upper right";
    EXPECT_EQ(g.depth(16, 48), 0.0f) << "lower left";
}

TEST_F(GeometryPassTest, NearerSurfaceWinsInAnyOrder) {
    Scene scene = one_object(quad_mesh());
    scene.materials.push_back({});
    scene.materials[0].base_color = {1, 0, 0, 1};
    scene.materials[1].base_color = {0, 1, 0, 1};
    scene.meshes.push_back(quad_mesh());
    scene.meshes[1].material = 1;
    scene.instances.push_back({1, translation({0, 0, 0.25})});
    const HostGBuffer a = draw_gbuffer(scene, front_camera(2), 16, 16);
    std::swap(scene.instances[0], scene.instances[1]);
    const HostGBuffer b = draw_gbuffer(scene, front_camera(2), 16, 16);
    EXPECT_EQ(a.bytes4(PLANE_ALBEDO, 8, 8), glm::ivec4(0, 255, 0, 255));
    EXPECT_EQ(a.bytes, b.bytes);
}

TEST_F(GeometryPassTest, BackFacesAreCulledUnlessDoubleSided) {
    const glm::dmat4 turned(glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1));  // half a turn about y
    Material material;
    Scene scene = one_object(quad_mesh(), material, turned);
    EXPECT_EQ(draw_gbuffer(scene, front_camera(2), 8, 8).depth(4, 4), 0.0f);
    scene.materials[0].double_sided = true;
    const HostGBuffer g = draw_gbuffer(scene, front_camera(2), 8, 8, kFull);
    EXPECT_GT(g.depth(4, 4), 0.0f);
    expect_near(g.vector(PLANE_NORMAL_X, 4, 4), {0, 0, 1}, kFullNormal, "back face's normal");
}

TEST_F(GeometryPassTest, MirroredInstancesKeepTheirFrontFaces) {
    for (const glm::dvec3 scale :
         {glm::dvec3(-1, 1, 1), {1, -1, 1}, {1, 1, -1}, {-2, -0.5, 1}, {-1, -1, -1}}) {
        glm::dmat4 world(1.0);
        for (int i = 0; i < 3; ++i) world[i][i] = scale[i];
        const HostGBuffer g =
            draw_gbuffer(one_object(quad_mesh(), {}, world), front_camera(2), 8, 8, kFull);
        const bool front = scale.z > 0;  // a mirror in z turns the quad's face away
        EXPECT_EQ(g.depth(4, 4) > 0, front) << scale.x << "," << scale.y << "," << scale.z;
        if (front) expect_near(g.vector(PLANE_NORMAL_X, 4, 4), {0, 0, 1}, kFullNormal, "mirrored");
    }
}

// A quad tilted by non-uniform scale: its true normal comes from the transformed edges.
TEST_F(GeometryPassTest, NormalsOfNonUniformScaleAreThoseOfTheSurface) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> angle(-0.6, 0.6);
    std::uniform_real_distribution<double> scale(0.2, 5.0);
    for (int i = 0; i < 20; ++i) {
        const double a = angle(random);
        Mesh mesh = quad_mesh(0.3f);
        for (std::size_t v = 0; v < 4; ++v) {
            mesh.positions[v].z = static_cast<float>(std::tan(a)) * mesh.positions[v].x;
            mesh.normals[v] = {static_cast<float>(-std::sin(a)), 0,
                               static_cast<float>(std::cos(a))};
        }
        glm::dmat4 world(1.0);
        for (int k = 0; k < 3; ++k) world[k][k] = scale(random);
        if (i % 3 == 0) world[0][0] *= -1;
        const auto corner = [&](std::size_t v) {
            return glm::dvec3(world * glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0));
        };
        glm::dvec3 expected =
            glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        if (expected.z < 0) expected = -expected;
        const Scene scene = one_object(mesh, {}, world);
        const HostGBuffer full = draw_gbuffer(scene, front_camera(5), 32, 32, kFull);
        expect_near(full.vector(PLANE_NORMAL_X, 16, 16), expected, kFullNormal, "full");
        const HostGBuffer packed = draw_gbuffer(scene, front_camera(5), 32, 32);
        expect_near(packed.packed_normal(16, 16), expected, kPackedNormal, "packed");
    }
}

TEST_F(GeometryPassTest, OddNormalsGiveDefinedDirections) {
    const float huge = 1e20f;
    for (const glm::vec3 normal : {glm::vec3(0), {0, 3e-20f, 4e-20f}, {0, 3 * huge, 4 * huge}}) {
        Mesh mesh = quad_mesh();
        mesh.normals.assign(4, normal);
        const HostGBuffer g = draw_gbuffer(one_object(mesh), front_camera(2), 8, 8, kFull);
        const glm::dvec3 expected =
            normal == glm::vec3(0) ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 0.6, 0.8);
        expect_near(g.vector(PLANE_NORMAL_X, 4, 4), expected, kFullNormal, "normal");
    }
}

TEST_F(GeometryPassTest, SingularTransformsKeepTheirNormal) {
    glm::dmat4 flat(1.0);
    flat[2][2] = 0.0;
    const HostGBuffer g =
        draw_gbuffer(one_object(quad_mesh(), {}, flat), front_camera(2), 8, 8, kFull);
    EXPECT_GT(g.depth(4, 4), 0.0f);
    expect_near(g.vector(PLANE_NORMAL_X, 4, 4), {0, 0, 1}, kFullNormal, "flattened");
}

TEST_F(GeometryPassTest, FullHoldsWhatTheMaterialSays) {
    Material material;
    material.base_color = {0.25f, 0.5f, 0.75f, 1.0f};
    material.roughness = 0.375f;
    material.metallic = 0.625f;
    material.emissive = {3.0f, 0.125f, 20.0f};
    const HostGBuffer g =
        draw_gbuffer(one_object(quad_mesh(), material), front_camera(2), 8, 8, kFull);
    EXPECT_EQ(g.vector(PLANE_ALBEDO_R, 4, 4), glm::dvec3(0.25, 0.5, 0.75));
    EXPECT_EQ(g.at<float>(PLANE_ROUGHNESS, 4, 4), 0.375f);
    EXPECT_EQ(g.at<float>(PLANE_METALLIC, 4, 4), 0.625f);
    EXPECT_EQ(g.vector(PLANE_EMISSIVE_R, 4, 4), glm::dvec3(3, 0.125, 20));
    EXPECT_EQ(g.at<float>(PLANE_OCCLUSION_F, 4, 4), 1.0f);
}

TEST_F(GeometryPassTest, PackedHoldsSrgbColoursAndLinearParameters) {
    Material material;
    material.base_color = {0.01f, 0.2f, 0.75f, 1.0f};
    material.roughness = 0.4f;
    material.metallic = 0.6f;
    material.emissive = {4.0f, 1.0f, 0.5f};
    const GBufferNeeds needs = make_needs(GBUFFER_PACKED, 4.0f);
    const HostGBuffer g =
        draw_gbuffer(one_object(quad_mesh(), material), front_camera(2), 8, 8, needs);
    const glm::ivec4 albedo = g.bytes4(PLANE_ALBEDO, 4, 4);
    const glm::ivec4 emissive = g.bytes4(PLANE_MATERIAL, 4, 4);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(albedo[c], srgb_code(material.base_color[c]), 0.6) << "channel " << c;
        EXPECT_NEAR(emissive[c], srgb_code(material.emissive[c] / 4.0), 0.6) << "channel " << c;
    }
    EXPECT_EQ(albedo.w, 102);
    EXPECT_EQ(emissive.w, 153);
    EXPECT_EQ(g.at<std::uint8_t>(PLANE_OCCLUSION, 4, 4), 255);
}

TEST_F(GeometryPassTest, BlendedMaterialsAreLeftOut) {
    Material material;
    material.alpha_mode = AlphaMode::blend;
    EXPECT_EQ(draw_gbuffer(one_object(quad_mesh(), material), front_camera(2), 8, 8).depth(4, 4),
              0.0f);
}

TEST_F(GeometryPassTest, UnlitSurfacesEmitTheirBaseColour) {
    Material material;
    material.unlit = true;
    material.base_color = {0.25f, 0.5f, 0.75f, 1.0f};
    const HostGBuffer g =
        draw_gbuffer(one_object(quad_mesh(), material), front_camera(2), 8, 8, kFull);
    EXPECT_EQ(g.vector(PLANE_EMISSIVE_R, 4, 4), glm::dvec3(0.25, 0.5, 0.75));
    EXPECT_EQ(g.vector(PLANE_ALBEDO_R, 4, 4), glm::dvec3(0.0));
}

TEST_F(GeometryPassTest, CullsInstancesOutsideTheFrustumOnly) {
    Scene scene = one_object(quad_mesh());
    scene.instances.clear();
    for (const double x : {-50.0, -2.9, 0.0, 2.9, 50.0}) {
        scene.instances.push_back({0, translation({x, 0, 0})});
    }
    scene.instances.push_back({0, translation({0, 0, 5})});     // behind the camera
    scene.instances.push_back({0, translation({0, 0, -1e6})});  // infinite far plane: kept
    const GpuScene gpu(scene);
    GeometryPass pass(gpu, {});
    pass.draw(front_camera(2), 32, 32);
    EXPECT_EQ(pass.draws().size(), 4u);
    EXPECT_GT(pass.last_ms(), 0.0);
}

TEST_F(GeometryPassTest, SizesTheDriverCannotDrawAreErrors) {
    const Scene scene = one_object(quad_mesh());
    const GpuScene gpu(scene);
    GeometryPass pass(gpu, {});
    EXPECT_THROW(pass.draw(front_camera(2), 0, 4), Error);
    EXPECT_THROW(pass.draw(front_camera(2), 1 << 20, 4), Error);
}

TEST_F(GeometryPassTest, IsTheSameAtALargeDistanceFromTheOrigin) {
    const Scene near_scene = one_object(quad_mesh());
    const glm::dvec3 offset(1048576.015625, 0, -1048575.984375);  // exact in double, not in float32
    const Scene far_scene = one_object(quad_mesh(), {}, translation(offset));
    Camera camera = front_camera(2);
    const HostGBuffer a = draw_gbuffer(near_scene, camera, 64, 64);
    camera.position += offset;
    EXPECT_EQ(a.bytes, draw_gbuffer(far_scene, camera, 64, 64).bytes);
}

}  // namespace
}  // namespace kilolux
