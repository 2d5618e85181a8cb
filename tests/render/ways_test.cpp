// SPDX-License-Identifier: Apache-2.0
// All ways make the same surfaces: OpenGL's ids and OpenCL's, resolved, OpenGL's planes, and
// OpenGL's lit fragments. All are compiled from kernels/shared, and on most devices all would have
// the same bits: but Mesa's software rasterizer makes fma() a product and a sum, rounded each. The
// limits follow from that.
#include <cmath>
#include <filesystem>
#include <random>

#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_builder.h"
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
    m.specular_texture = add_noise(scene, 64, trilinear(Wrap::repeat), 7);
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

constexpr int kWayWidth = 144;
constexpr int kWayHeight = 80;

// As kernels/shared/triangle.h says, rounding moves a triangle by a few 2^-24 of its distance: by
// 2^-23 as seen from the camera, of a picture kWayWidth pixels wide that is 2 along its wider side.
constexpr double kShift = 0x1p-23 * kWayWidth;  // [pixel]

// A map's level has at most two texels a pixel, which differ by at most 1. A vertex's attributes
// differ less.
constexpr double kMostOfSurface = 2.0 * kShift;
// Eight units in the last place of a value in [0.5, 1).
constexpr double kMedianOfSurface = 8.0 * 0x1p-23;
// A highlight's radiance follows its normal with a slope of up to ten.
constexpr double kMostOfPicture = 10.0 * kMostOfSurface;
constexpr double kMedianOfPicture = 10.0 * kMedianOfSurface;
// Share of the pixels that must be within: others are at thresholds of textures and masks, or at
// silhouettes.
constexpr double kMost = 0.99;
// OpenGL snaps vertices to 1/256 pixel, which moves edges by up to half of that: with four edges a
// pixel, at so many pixels the centre is so near to one that OpenCL may see another triangle.
constexpr double kSnapped = 4.0 / 512.0;

RenderSettings way_settings() {
    RenderSettings settings = small_settings(kWayWidth, kWayHeight, 200);
    settings.shading = Shading::pbr;
    settings.gbuffer = GBUFFER_FULL;
    settings.ambient = 0.1f;
    return settings;
}

struct Way {
    Frame frame;
    DecodedSurfaces surfaces;  // none of the forward renderers
};

// Renders a scene in one way after the other.
class Ways {
 public:
    Ways(const Scene& scene, const Camera& camera, const RenderSettings& settings)
        : camera_(camera), settings_(settings), renderer_(scene, first(settings)) {}

    Way deferred(Geometry geometry) {
        settings_.renderer = RendererKind::deferred;
        settings_.geometry = geometry;
        renderer_.change(settings_);
        Way out{renderer_.render(camera_, 0.0), {}};
        out.surfaces = renderer_.lit_surfaces().surfaces;
        return out;
    }
    Way forward(RendererKind kind) {
        settings_.renderer = kind;
        settings_.geometry = Geometry::ids;
        renderer_.change(settings_);
        return {renderer_.render(camera_, 0.0), {}};
    }

 private:
    static RenderSettings first(RenderSettings settings) {
        settings.geometry = Geometry::compute;
        return settings;
    }

    Camera camera_;
    RenderSettings settings_;
    Renderer renderer_;
};

std::size_t pixel_count(const DecodedSurfaces& a) {
    return std::size_t{a.view.stride} * a.view.height;
}

// OpenCL resolves both: where the triangles are the same, so is every bit.
void expect_same_ids(const DecodedSurfaces& a, const DecodedSurfaces& b) {
    const std::size_t size = pixel_count(a);
    std::size_t drawn = 0, others = 0;
    for (std::size_t i = 0; i < size; ++i) {
        drawn += a.shows_surface(i) ? 1 : 0;
        bool same = true;
        for (std::size_t at = i; at < a.planes.size(); at += size) {
            same = same && a.planes[at] == b.planes[at];
        }
        others += same ? 0 : 1;
    }
    EXPECT_GT(drawn, size / 2) << "the camera should see the scene";
    EXPECT_LE(static_cast<double>(others), kSnapped * static_cast<double>(drawn));
}

// OpenGL's rasterizer decides for both which triangle a pixel shows.
void expect_same_surfaces(const DecodedSurfaces& a, const DecodedSurfaces& b) {
    const std::size_t size = pixel_count(a);
    for (std::size_t plane = 0; plane < a.planes.size() / size; ++plane) {
        SCOPED_TRACE("plane " + std::to_string(plane));
        std::vector<double> differences;
        for (std::size_t i = 0; i < size; ++i) {
            if (!a.shows_surface(i) && !b.shows_surface(i)) continue;
            const double scale = plane < SURFACE_NORMAL ? a.at(SURFACE_DEPTH, i) : 1.0;
            differences.push_back(std::abs(a.at(plane, i) - b.at(plane, i)) / scale);
        }
        EXPECT_LT(quantile(differences, 0.5), kMedianOfSurface);
        EXPECT_LT(quantile(differences, kMost), kMostOfSurface);
    }
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

void expect_same_picture(const Frame& a, const Frame& b) {
    const std::vector<double> differences = picture_differences(a, b);
    EXPECT_LT(quantile(differences, 0.5), kMedianOfPicture);
    EXPECT_LT(quantile(differences, kMost), kMostOfPicture);
}

void expect_one_surface(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    Ways ways(scene, camera, settings);
    const Way compute = ways.deferred(Geometry::compute);
    const Way planes = ways.deferred(Geometry::planes);
    const Way ids = ways.deferred(Geometry::ids);  // last: the forward renderers share its stages
    {
        SCOPED_TRACE("compute");
        expect_same_ids(ids.surfaces, compute.surfaces);
    }
    {
        SCOPED_TRACE("planes");
        expect_same_surfaces(ids.surfaces, planes.surfaces);
        expect_same_picture(ids.frame, planes.frame);
    }
    for (const RendererKind kind : {RendererKind::forward, RendererKind::forward_plus}) {
        SCOPED_TRACE(kind == RendererKind::forward ? "forward" : "forward-plus");
        expect_same_picture(ids.frame, ways.forward(kind).frame);
    }
}

TEST(Ways, MakeTheSameSurfacesOfEveryMap) {
    expect_one_surface(mapped_scene(), hill_camera(), way_settings());
}

// Nearest texels and levels, no mipmaps, and several samples a pixel.
TEST(Ways, MakeTheSameSurfacesWithOtherFilters) {
    Scene scene = mapped_scene();
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        Sampler& sampler = scene.textures[i].sampler;
        if (i % 4 == 1) sampler.between_mipmaps = Filter::nearest;
        if (i % 4 == 2) sampler.mipmaps = false;
        if (i % 4 == 3) sampler.magnify = sampler.minify = Filter::nearest;
    }
    RenderSettings settings = way_settings();
    settings.anisotropy = 4;
    expect_one_surface(scene, hill_camera(), settings);
}

TEST(Ways, MakeTheSameSurfacesOfAGeneratedScene) {
    const Scene scene = make_generated_scene("atrium");
    expect_one_surface(scene, first_camera(scene), way_settings());
}

// Quads with noise and a normal map: a large one, before it a mirrored one of this alpha mode, and
// one that alpha cuts out and an animation turns.
GltfBuilder quads_file(const char* alpha_of_mirrored) {
    constexpr int kSide = 32;
    std::mt19937 random(11);
    Blob noise(std::size_t{4} * kSide * kSide);
    for (unsigned char& value : noise) value = static_cast<unsigned char>(64 + random() % 192);
    GltfBuilder file = quad_with_normal_map();
    const int texture = file.add_texture(encode_image("png", kSide, 4, noise), "image/png");
    file.root["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", texture}}},
                                                         {"metallicFactor", 0.5},
                                                         {"roughnessFactor", 0.6}};
    file.add_node({{"mesh", 0}, {"translation", {-3, -3, -0.5}}, {"scale", {6, 6, 1}}});
    const auto add_quad = [&](const char* alpha_mode, nlohmann::json node) {
        nlohmann::json material = file.root["materials"][0];
        material["alphaMode"] = alpha_mode;
        material["doubleSided"] = true;
        nlohmann::json primitive = file.primitive();
        primitive["material"] = file.add("materials", material);
        node["mesh"] = file.add("meshes", {{"primitives", {primitive}}});
        return file.add_node(node);
    };
    add_quad(alpha_of_mirrored, {{"translation", {-0.1, 0, 0.1}}, {"scale", {-1, 1.2, 1}}});
    const int turned = add_quad("MASK", {{"translation", {-0.5, -1.1, 0}}});
    const std::vector<float> turns = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f};
    file.add(
        "animations",
        {{"samplers",
          {{{"input", file.add_floats("SCALAR", {0, 1})},
            {"output", file.add_floats("VEC4", turns)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", turned}, {"path", "rotation"}}}}}}});
    return file;
}

TEST(Ways, MakeTheSameSurfacesOfAWrittenFile) {
    LoadOptions options;
    options.time = 0.5;
    for (const char* alpha_mode : {"OPAQUE", "BLEND"}) {
        SCOPED_TRACE(alpha_mode);
        expect_one_surface(load(quads_file(alpha_mode), options),
                           look_at({0.2, 0.1, 2.0}, {0, 0, 0}, {0, 1, 0}, glm::radians(60.0)),
                           way_settings());
    }
}

TEST(Ways, MakeTheSameSurfacesOfLoadedScenes) {
    const auto folder = std::filesystem::path(source_root()) / ".." / "shared/scenes";
    const std::pair<const char*, Camera> views[] = {
        {"sponza/Sponza.gltf", look_at({-8, 2, 0.5}, {4, 4, -2}, {0, 1, 0}, glm::radians(60.0))},
        {"helmet/DamagedHelmet.glb",
         look_at({0.3, 0.2, 1.7}, {0, 0, 0}, {0, 1, 0}, glm::radians(45.0))},
    };
    for (const auto& [file, camera] : views) {
        SCOPED_TRACE(file);
        if (!std::filesystem::exists(folder / file)) GTEST_SKIP() << file << " is not there";
        expect_one_surface(load_scene(folder / file), camera, way_settings());
    }
}

// The packed G-buffer, which is the default, rounds albedo and roughness to 8 bits and normals to
// 2 x 16; forward renderers have none.
TEST(Ways, ForwardDiffersFromThePackedGBufferByItsRounding) {
    constexpr double kMedianOfPacked = 0.01;  // of an albedo of 8 bits in sRGB
    const auto check = [&](const Scene& scene, const Camera& camera) {
        RenderSettings settings = way_settings();
        settings.gbuffer = RenderSettings{}.gbuffer;
        Ways ways(scene, camera, settings);
        const Frame deferred = ways.deferred(Geometry::ids).frame;
        for (const RendererKind kind : {RendererKind::forward, RendererKind::forward_plus}) {
            const auto differences = picture_differences(deferred, ways.forward(kind).frame);
            EXPECT_LT(quantile(differences, 0.5), kMedianOfPacked);
            EXPECT_GT(quantile(differences, 0.5), kMedianOfPicture) << "is it packed?";
        }
    };
    check(mapped_scene(), hill_camera());
    const auto file =
        std::filesystem::path(source_root()) / ".." / "shared/scenes/sponza/Sponza.gltf";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    check(load_scene(file), look_at({-8, 2, 0.5}, {4, 4, -2}, {0, 1, 0}, glm::radians(60.0)));
}

}  // namespace
}  // namespace kilolux
