// SPDX-License-Identifier: Apache-2.0
// All ways make the same surfaces: OpenGL's ids and OpenCL's, resolved, OpenGL's planes, and
// OpenGL's lit fragments. All are compiled from kernels/shared, and on most devices all would give
// the same bits. Mesa's software rasterizer rounds fma() twice, hence the limits.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <span>

#include "host/scene/gltf/load_scene.h"
#include "tests/render/ways/way_scenes.h"
#include "tests/render/ways/ways.h"
#include "tests/support/paths.h"

namespace kilolux {
namespace {

// A map's level has at most two texels a pixel, which differ by at most 1. A vertex's attributes
// differ less.
constexpr double kMostOfSurface = 2.0 * kShift;
// Eight units in the last place of a value in [0.5, 1).
constexpr double kMedianOfSurface = 8.0 * 0x1p-23;
// A highlight's radiance follows its normal with a slope of up to ten.
constexpr double kMostOfPicture = 10.0 * kMostOfSurface;
constexpr double kMedianOfPicture = 10.0 * kMedianOfSurface;
// Share of the pixels that must be within: others are at thresholds of textures, in highlights, or
// on triangles that are thin.
constexpr double kMost = 0.99;
// What every pixel must be within on a triangle at least a pixel high, of surfaces as of radiance;
// three times kMostOfSurface, for products of several maps.
constexpr double kEvery = 1e-4;
// The share of pixels whose centre is within 1/512 pixel of an edge, with four edges a pixel: there
// OpenCL may see another triangle than OpenGL, which snaps vertices to 1/256 pixel.
constexpr double kSnapped = 4.0 / 512.0;

// OpenCL resolves both: where the triangles are the same, so is every bit.
void expect_same_bits(const Way& a, const Way& b, std::span<const ShownPixel> shown,
                      std::span<const uint> ids_of_b) {
    const std::size_t size = ids_of_b.size();
    ASSERT_EQ(a.surfaces.planes.size(), SURFACE_PLANES * size);
    ASSERT_EQ(b.surfaces.planes.size(), a.surfaces.planes.size());
    std::size_t others = 0, differing = 0;
    for (const ShownPixel& pixel : shown) {
        if (ids_of_b[pixel.in_plane] != pixel.id) {
            ++others;
            continue;
        }
        bool same = pixel_radiance(a.frame, pixel) == pixel_radiance(b.frame, pixel);
        for (std::size_t at = pixel.in_plane; at < a.surfaces.planes.size(); at += size) {
            same = same && a.surfaces.planes[at] == b.surfaces.planes[at];
        }
        differing += same ? 0 : 1;
    }
    EXPECT_EQ(differing, 0u);
    EXPECT_LE(static_cast<double>(others), kSnapped * static_cast<double>(shown.size()));
}

// `differences`: of the shown pixels. A vertex's shift changes gradients in proportion to 1 /
// height. A footprint of n samples is n texels long, so the error is n times as large.
void expect_every_pixel(const std::vector<double>& differences, std::span<const ShownPixel> shown,
                        int anisotropy) {
    std::size_t beyond = 0;
    std::string first;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double limit = kEvery * std::max(1.0, anisotropy / shown[i].triangle_height);
        if (differences[i] <= limit || beyond++ > 0) continue;
        first = fmt::format("({}, {}), triangle {}, {} pixels high: {}", shown[i].x, shown[i].y,
                            shown[i].id, shown[i].triangle_height, differences[i]);
    }
    EXPECT_EQ(beyond, 0u) << "of " << shown.size() << ", the first at " << first;
}

void expect_quantiles(const std::vector<double>& differences, double median, double most) {
    EXPECT_LT(quantile(differences, 0.5), median);
    EXPECT_LT(quantile(differences, kMost), most);
}

// OpenGL's rasterizer decides for both which triangle a pixel shows.
void expect_same_surfaces(const DecodedSurfaces& a, const DecodedSurfaces& b,
                          std::span<const ShownPixel> shown, int anisotropy) {
    const std::size_t size = std::size_t{a.view.stride} * a.view.height;
    ASSERT_EQ(a.planes.size(), SURFACE_PLANES * size);
    ASSERT_EQ(b.planes.size(), a.planes.size());
    for (std::size_t plane = 0; plane < SURFACE_PLANES; ++plane) {
        SCOPED_TRACE("plane " + std::to_string(plane));
        std::vector<double> differences;
        for (const ShownPixel& pixel : shown) {
            const std::size_t i = pixel.in_plane;
            const double scale = plane < SURFACE_NORMAL ? a.at(SURFACE_DEPTH, i) : 1.0;
            differences.push_back(std::abs(a.at(plane, i) - b.at(plane, i)) / scale);
        }
        expect_quantiles(differences, kMedianOfSurface, kMostOfSurface);
        expect_every_pixel(differences, shown, anisotropy);
    }
}

double largest_channel(const glm::dvec3& color) { return std::max({color.x, color.y, color.z}); }

// Relative to the largest channel.
std::vector<double> pixel_differences(const Frame& a, const Frame& b,
                                      std::span<const ShownPixel> shown) {
    std::vector<double> out;
    for (const ShownPixel& pixel : shown) {
        const glm::dvec3 x = pixel_radiance(a, pixel), y = pixel_radiance(b, pixel);
        out.push_back(largest_channel(glm::abs(x - y)) / largest_channel(x));
    }
    return out;
}

// Albedo times occlusion and emission, which ambient light alone shows.
void expect_same_colors(Ways& ways, std::span<const ShownPixel> shown, int anisotropy) {
    ways.light_by(1.0f, 0);
    const Frame ids = ways.deferred(Geometry::ids).frame;
    const auto expect_same = [&](const Way& other) {
        expect_every_pixel(pixel_differences(ids, other.frame, shown), shown, anisotropy);
    };
    expect_same(ways.deferred(Geometry::planes));
    expect_same(ways.forward(RendererKind::forward));
    expect_same(ways.forward(RendererKind::forward_plus));
}

void expect_one_surface(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    Ways ways(scene, camera, settings);
    const std::vector<ShownPixel> shown = ways.shown();
    EXPECT_GT(shown.size(), std::size_t{kWayWidth * kWayHeight / 2}) << "the camera should see it";
    const Way compute = ways.deferred(Geometry::compute);
    const Way planes = ways.deferred(Geometry::planes);
    const Way ids = ways.deferred(Geometry::ids);  // last: the forward renderers share its stages
    {
        SCOPED_TRACE("compute");
        expect_same_bits(ids, compute, shown, ways.compute_ids());
    }
    {
        SCOPED_TRACE("planes");
        expect_same_surfaces(ids.surfaces, planes.surfaces, shown, settings.anisotropy);
        expect_quantiles(picture_differences(ids.frame, planes.frame), kMedianOfPicture,
                         kMostOfPicture);
    }
    for (const RendererKind kind : {RendererKind::forward, RendererKind::forward_plus}) {
        SCOPED_TRACE(kind == RendererKind::forward ? "forward" : "forward-plus");
        const Frame forward = ways.forward(kind).frame;
        expect_quantiles(picture_differences(ids.frame, forward), kMedianOfPicture, kMostOfPicture);
        // The same fragments: a highlight differs by its lights' sum only.
        expect_every_pixel(pixel_differences(planes.frame, forward, shown), shown,
                           settings.anisotropy);
    }
    SCOPED_TRACE("ambient light");
    expect_same_colors(ways, shown, settings.anisotropy);
}

TEST(Ways, MakeTheSameSurfacesOfEveryMap) {
    expect_one_surface(mapped_scene(), hill_camera(), way_settings());
}

TEST(Ways, MakeTheSameSurfacesUnderCoats) {
    expect_one_surface(coated_scene(), hill_camera(), way_settings());
}

TEST(Ways, MakeTheSameSurfacesWithSheen) {
    expect_one_surface(sheen_scene(), hill_camera(), way_settings());
}

TEST(Ways, MakeTheSameSurfacesWithAnisotropy) {
    expect_one_surface(stretched_scene(), hill_camera(), way_settings());
}

// Nearest texels and levels, no mipmaps, and several samples a pixel.
TEST(Ways, MakeTheSameSurfacesWithOtherFilters) {
    RenderSettings settings = way_settings();
    settings.anisotropy = 4;
    expect_one_surface(mapped_scene_with_other_filters(), hill_camera(), settings);
}

TEST(Ways, MakeTheSameSurfacesOfGeneratedScenes) {
    for (const auto& [name, anisotropy] : {std::pair{"grid", 1}, {"atrium", 1}, {"atrium", 4}}) {
        SCOPED_TRACE(fmt::format("{}, {} samples", name, anisotropy));
        const Scene scene = make_generated_scene(name);
        RenderSettings settings = way_settings();
        settings.anisotropy = anisotropy;
        expect_one_surface(scene, first_camera(scene), settings);
    }
}

TEST(Ways, MakeTheSameSurfacesOfAWrittenFile) {
    LoadOptions options;
    options.time = 0.5;
    for (const char* alpha_mode : {"OPAQUE", "BLEND"}) {
        SCOPED_TRACE(alpha_mode);
        expect_one_surface(load(quads_file(alpha_mode), options), quads_camera(), way_settings());
    }
}

TEST(Ways, MakeTheSameSurfacesOfLoadedScenes) {
    const auto folder = std::filesystem::path(source_root()) / ".." / "shared/scenes";
    const std::pair<const char*, Camera> views[] = {
        {"sponza/Sponza.gltf", look_at({-8, 2, 0.5}, {4, 4, -2}, {0, 1, 0}, glm::radians(60.0))},
        {"helmet/DamagedHelmet.glb",
         look_at({0.3, 0.2, 1.7}, {0, 0, 0}, {0, 1, 0}, glm::radians(45.0))},
    };
    bool is_there = false;
    for (const auto& [file, camera] : views) {
        SCOPED_TRACE(file);
        if (!std::filesystem::exists(folder / file)) continue;
        expect_one_surface(load_scene(folder / file), camera, way_settings());
        is_there = true;
    }
    if (!is_there) GTEST_SKIP() << folder << " has none";
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
    if (!std::filesystem::exists(file)) return;
    check(load_scene(file), look_at({-8, 2, 0.5}, {4, 4, -2}, {0, 1, 0}, glm::radians(60.0)));
}

}  // namespace
}  // namespace kilolux
