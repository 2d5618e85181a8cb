// SPDX-License-Identifier: Apache-2.0
// All ways make the same surfaces: OpenGL's ids and OpenCL's, resolved, OpenGL's planes, and
// OpenGL's lit fragments. All are compiled from kernels/shared.
#include <cmath>
#include <filesystem>
#include <random>

#include "host/scene/gltf/load_scene.h"
#include "tests/support/paths.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

TextureUse add_noise(Scene& scene, int size, const Sampler& sampler, unsigned seed) {
    std::mt19937 random(seed);
    Image image{"noise", size, size, {}};
    for (int i = 0; i < 4 * size * size; ++i) {
        image.rgba.push_back(static_cast<std::uint8_t>(64 + random() % 192));
    }
    scene.images.push_back(std::move(image));
    Texture texture;
    texture.image = static_cast<int>(scene.images.size()) - 1;
    texture.sampler = sampler;
    scene.textures.push_back(texture);
    TextureUse use;
    use.texture = static_cast<int>(scene.textures.size()) - 1;
    return use;
}

Sampler trilinear(Wrap wrap) {
    return {wrap, wrap, Filter::linear, Filter::linear, true, Filter::linear};
}

// A material with every map, of different samplers, sets and transforms.
Material mapped_material(Scene& scene) {
    Material m;
    m.base_color_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 1);
    m.normal_texture = add_noise(scene, 32, trilinear(Wrap::mirror), 2);
    m.normal_scale = 0.3f;
    m.metallic_roughness_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 3);
    m.occlusion_texture = add_noise(scene, 17, trilinear(Wrap::clamp), 4);
    m.occlusion_texture.uv_set = 1;
    m.emissive_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 5);
    m.emissive_texture.uv_from_texcoord = glm::mat3(1.5f, 0.5f, 0, -0.5f, 1.5f, 0, 0.1f, 0.2f, 1);
    m.emissive = glm::vec3(0.05f);
    m.metallic = 0.5f;
    m.specular_color_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 6);
    m.specular = 0.8f;
    return m;
}

// A sheet of hills with all attributes, from -4 to 4 along x and z.
Mesh hills(int material) {
    constexpr int kSide = 9;
    Mesh mesh;
    mesh.material = material;
    for (int i = 0; i < kSide * kSide; ++i) {
        const auto x = static_cast<float>(i % kSide - 4);
        const auto z = static_cast<float>(i / kSide - 4);
        mesh.positions.emplace_back(x, 0.3f * std::sin(x) * std::cos(z), z);
        mesh.normals.push_back(glm::normalize(
            glm::vec3(-0.3f * std::cos(x) * std::cos(z), 1, 0.3f * std::sin(x) * std::sin(z))));
        mesh.tangents.emplace_back(1, 0, 0, 1);
        mesh.texcoords[0].emplace_back(0.3f * x, 0.3f * z);
        mesh.texcoords[1].emplace_back(0.11f * x + 0.5f, 0.13f * z + 0.5f);
        mesh.colors.emplace_back(1, 0.5f + 0.1f * x, 0.9f, 1);
    }
    for (std::uint32_t i = 0; i < kSide * (kSide - 1); ++i) {
        if (i % kSide == kSide - 1) continue;
        mesh.indices.insert(mesh.indices.end(),
                            {i, i + kSide, i + 1, i + 1, i + kSide, i + kSide + 1});
    }
    return mesh;
}

// Hills, hung over by others that are scaled unevenly, mirrored, cut by alpha and seen from below.
Scene mapped_scene() {
    Scene scene;
    scene.name = "mapped";
    scene.materials.push_back(mapped_material(scene));
    scene.materials.push_back(mapped_material(scene));
    scene.materials[1].alpha_mode = AlphaMode::mask;
    scene.materials[1].double_sided = true;
    scene.meshes = {hills(0), hills(1)};
    scene.instances.push_back({0, glm::dmat4(1.0)});
    glm::dmat4 above(1.0);
    above[0] = {-0.4, 0.1, 0.0, 0.0};
    above[2] = {0.0, 0.3, 0.5, 0.0};
    above[3] = {0.5, 1.4, -1.0, 1.0};
    scene.instances.push_back({1, above});
    return scene;
}

Camera hill_camera() {
    return look_at({1.0, 1.6, 4.5}, {0, 0.4, -1}, {0, 1, 0}, glm::radians(60.0));
}

RenderSettings way_settings() {
    RenderSettings settings = small_settings(192, 108, 200);
    settings.shading = Shading::pbr;
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.1f;
    return settings;
}

struct Way {
    Frame frame;
    DecodedSurfaces surfaces;  // none of the forward renderers
};

Way render_way(const Scene& scene, const Camera& camera, RenderSettings settings, RendererKind kind,
               Geometry geometry) {
    settings.renderer = kind;
    settings.geometry = geometry;
    Renderer renderer(scene, settings);
    Way out{renderer.render(camera, 0.0), {}};
    const bool forward = kind == RendererKind::forward || kind == RendererKind::forward_plus;
    if (!forward) out.surfaces = renderer.lit_surfaces().surfaces;
    return out;
}

// Differences of all planes but depth at pixels that show the same triangle: other triangles have
// other depths.
std::vector<double> surface_differences(const DecodedSurfaces& a, const DecodedSurfaces& b) {
    std::vector<double> out;
    const std::size_t size = std::size_t{a.view.stride} * a.view.height;
    std::size_t drawn = 0;
    std::size_t same = 0;
    for (std::size_t i = 0; i < size; ++i) {
        drawn += a.shows_surface(i) || b.shows_surface(i) ? 1 : 0;
        const double depth = a.at(SURFACE_DEPTH, i);
        if (!a.shows_surface(i) || std::abs(b.at(SURFACE_DEPTH, i) / depth - 1.0) > 1e-6) continue;
        ++same;
        double largest = 0.0;
        for (std::size_t plane = SURFACE_DEPTH + 1; plane < a.planes.size() / size; ++plane) {
            const double scale = plane < SURFACE_NORMAL ? depth : 1.0;
            largest = std::max(largest, std::abs(a.at(plane, i) - b.at(plane, i)) / scale);
        }
        out.push_back(largest);
    }
    EXPECT_GT(drawn, size / 4);
    EXPECT_GT(same, drawn * 99 / 100) << "of " << drawn;
    return out;
}

// Relative to the value, or to a hundredth of the mean where it is nearly black.
std::vector<double> picture_differences(const Frame& a, const Frame& b) {
    double mean = 0.0;
    for (const float value : a.radiance) mean += value;
    const double floor = 0.01 * mean / static_cast<double>(a.radiance.size());
    std::vector<double> out;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        if (a.radiance[i] == 0.0f && b.radiance[i] == 0.0f) continue;
        out.push_back(std::abs(a.radiance[i] - b.radiance[i]) / (a.radiance[i] + floor));
    }
    return out;
}

void expect_one_surface(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    const Way ids = render_way(scene, camera, settings, RendererKind::deferred, Geometry::ids);
    for (const Geometry geometry : {Geometry::compute, Geometry::planes}) {
        SCOPED_TRACE(geometry == Geometry::planes ? "planes" : "compute");
        const Way way = render_way(scene, camera, settings, RendererKind::deferred, geometry);
        const std::vector<double> surfaces = surface_differences(ids.surfaces, way.surfaces);
        EXPECT_LT(quantile(surfaces, 0.5), 1e-6);
        EXPECT_LT(quantile(surfaces, 0.99), 2e-5) << "texture coordinates, in texels, round";
        const std::vector<double> pictures = picture_differences(ids.frame, way.frame);
        EXPECT_LT(quantile(pictures, 0.5), 1e-5);
    }
    for (const RendererKind kind : {RendererKind::forward, RendererKind::forward_plus}) {
        SCOPED_TRACE(kind == RendererKind::forward ? "forward" : "forward-plus");
        const Way way = render_way(scene, camera, settings, kind, Geometry::ids);
        const std::vector<double> pictures = picture_differences(ids.frame, way.frame);
        EXPECT_LT(quantile(pictures, 0.5), 1e-4);
        EXPECT_LT(quantile(pictures, 0.95), 1e-3);
    }
}

TEST(Ways, MakeTheSameSurfacesOfEveryMap) {
    expect_one_surface(mapped_scene(), hill_camera(), way_settings());
    RenderSettings settings = way_settings();
    settings.anisotropy = 4;
    expect_one_surface(mapped_scene(), hill_camera(), settings);
}

TEST(Ways, MakeTheSameSurfacesWithOtherFilters) {
    Scene scene = mapped_scene();
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        Sampler& sampler = scene.textures[i].sampler;
        sampler.between_mipmaps = i % 2 == 0 ? Filter::nearest : Filter::linear;
        sampler.mipmaps = i % 3 != 0;
    }
    expect_one_surface(scene, hill_camera(), way_settings());
}

TEST(Ways, MakeTheSameSurfacesOfAGeneratedScene) {
    const Scene scene = make_generated_scene("atrium");
    expect_one_surface(scene, first_camera(scene), way_settings());
}

TEST(Ways, MakeTheSameSurfacesOfLoadedScenes) {
    const auto folder = std::filesystem::path(source_root()) / ".." / "shared/scenes";
    for (const char* file : {"sponza/Sponza.gltf", "helmet/DamagedHelmet.glb"}) {
        SCOPED_TRACE(file);
        if (!std::filesystem::exists(folder / file)) continue;
        const Scene scene = load_scene(folder / file);
        expect_one_surface(scene, first_camera(scene), way_settings());
    }
}

}  // namespace
}  // namespace kilolux
