// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "raster/gl_context.h"
#include "raster/solid_pass.h"

namespace kilolux {

/// A test with a headless context current.
class GlTest : public testing::Test {
 protected:
    static void SetUpTestSuite() { context_ = std::make_unique<GlContext>(GlContext::headless()); }
    static void TearDownTestSuite() { context_.reset(); }

    static std::unique_ptr<GlContext> context_;
};

inline std::unique_ptr<GlContext> GlTest::context_;

/// A G-buffer in host memory.
struct HostGBuffer {
    GBufferLayout layout{};
    uint stride = 0;
    std::vector<std::byte> bytes;

    template <typename Element>
    Element at(uint plane, int x, int y) const {
        Element element;
        const std::size_t index =
            static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x);
        std::memcpy(&element, bytes.data() + layout.offset_bytes[plane] + index * sizeof(Element),
                    sizeof(Element));
        return element;
    }
    float depth(int x, int y) const { return at<float>(PLANE_DEPTH, x, y); }

    /// The float plane and the two after it.
    glm::dvec3 vector(uint first_plane, int x, int y) const {
        return {at<float>(first_plane, x, y), at<float>(first_plane + 1, x, y),
                at<float>(first_plane + 2, x, y)};
    }

    /// The octahedral normal of `packed`, decoded in double.
    glm::dvec3 packed_normal(int x, int y) const {
        const uint bits = at<uint>(PLANE_NORMAL, x, y);
        const double u = (bits & 0xffffu) / 65535.0 * 2.0 - 1.0;
        const double v = (bits >> 16) / 65535.0 * 2.0 - 1.0;
        const double z = 1.0 - std::abs(u) - std::abs(v);
        const double fold = std::max(-z, 0.0);
        return glm::normalize(
            glm::dvec3(u + (u >= 0 ? -fold : fold), v + (v >= 0 ? -fold : fold), z));
    }

    /// Four 8-bit channels of a plane.
    glm::ivec4 bytes4(uint plane, int x, int y) const {
        const uint bits = at<uint>(plane, x, y);
        return {bits & 255u, (bits >> 8) & 255u, (bits >> 16) & 255u, bits >> 24};
    }
};

/// Draws the scene once and reads all planes.
inline HostGBuffer draw_gbuffer(const Scene& scene, const Camera& camera, int width, int height,
                                const GBufferNeeds& needs = {}) {
    const GpuScene gpu(scene);
    GeometryPass pass(gpu, needs);
    pass.draw(camera, width, height);
    HostGBuffer out;
    out.stride = view_of(camera, width, height).stride;
    out.layout = make_gbuffer_layout(needs, out.stride, static_cast<uint>(height));
    out.bytes = read_gbuffer(pass.targets(), out.layout, out.stride);
    return out;
}

inline void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance,
                        const std::string& what) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << what << ": (" << a.x << ", " << a.y << ", " << a.z << ") against (" << b.x << ", " << b.y
        << ", " << b.z << ")";
}

/// A rectangle in the plane z = 0, [-half, half]^2, normal +z, texture coordinates (0, 0) at the
/// upper left and (1, 1) at the lower right, tangent +x.
inline Mesh quad_mesh(float half = 1.0f) {
    Mesh mesh;
    mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = 0;
    return mesh;
}

/// One mesh with one material at a place in the world.
inline Scene one_object(Mesh mesh, const Material& material = {},
                        const glm::dmat4& world_from_object = glm::dmat4(1.0)) {
    Scene scene;
    scene.name = "test";
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    scene.instances.push_back({0, world_from_object});
    return scene;
}

/// Adds an image with its texture, nearest and without mipmaps, and returns how a material uses it.
inline TextureUse add_texture(Scene& scene, int width, int height, std::vector<std::uint8_t> rgba) {
    Texture texture;
    texture.image = static_cast<int>(scene.images.size());
    texture.sampler = {Wrap::repeat, Wrap::repeat, Filter::nearest, Filter::nearest, false, {}};
    scene.images.push_back({"image", width, height, std::move(rgba)});
    scene.textures.push_back(texture);
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

/// A camera at (0, 0, distance) that looks at the origin, 90 degrees high.
inline Camera front_camera(double distance) {
    return look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0}, glm::radians(90.0));
}

/// sRGB code of a linear value, IEC 61966-2-1.
inline double srgb_code(double linear) {
    return 255.0 *
           (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

inline glm::dmat4 translation(const glm::dvec3& t) {
    glm::dmat4 m(1.0);
    m[3] = glm::dvec4(t, 1.0);
    return m;
}

/// A G-buffer with the material and occlusion planes, of surfaces that are not all matt.
inline GBufferNeeds make_needs(uint layout, float emissive_scale = 1.0f) {
    GBufferNeeds needs;
    needs.layout = layout;
    needs.emissive_scale = emissive_scale;
    needs.material = needs.occlusion = needs.gloss = true;
    return needs;
}

}  // namespace kilolux
