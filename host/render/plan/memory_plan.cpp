// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/memory_plan.h"

#include <fmt/format.h>
#include <algorithm>

#include "host/base/error.h"
#include "host/base/memory.h"
#include "host/picture/bands.h"
#include "host/surfaces/shadow_scene.h"
#include "host/surfaces/surface_scene.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/light_drift.h"
#include "kernels/shared/raster_row.h"
#include "kernels/shared/surface_planes.h"

namespace kilolux {
namespace {

using Bytes = std::uint64_t;

// The program with its drivers and their compilers: resident size of a 16x16 picture, rounded up.
constexpr Bytes kProgram = Bytes{256} << 20;
// Of one light: twice as the scene has it, rows on the host and on the device, prepared; its path,
// three times, and its place in their order, twice.
constexpr Bytes kLight =
    2 * sizeof(SceneLight) + 4 * 48 + 48 + 3 * sizeof(LightDrift) + 2 * sizeof(std::uint64_t);
// Radiance and display picture, and as much again while a file is made of them.
constexpr Bytes kHostPixel = 2 * (3 * sizeof(float) + 4);
// Radiance and display picture on the device, and twice on the host: as planes and pixels.
constexpr Bytes kBandPixel = 3 * (3 * sizeof(float) + 4);
// Active clusters, their lists and the sums of both, about two clusters a fine tile; and the order
// of the tiles' pixels.
constexpr Bytes kListsPixel = 2;
// Where a pixel's shadow rays end.
constexpr Bytes kShadowPixel = 4 * sizeof(float);
// Kernels count the elements of a picture's planes in 32 bits.
constexpr Bytes kMostBandPixels = (Bytes{1} << 32) / SURFACE_PLANES_WITH_SPECULAR - 1;
// No texture takes more memory for it.
constexpr int kAnyAnisotropy = 1;
// OpenCL drivers and images of the files leave a share of what is available unused.
constexpr double kAvailableShare = 0.8;

Bytes limit_of(const RenderSettings& settings) {
    if (settings.max_memory_bytes > 0) return settings.max_memory_bytes;
    return static_cast<Bytes>(kAvailableShare * static_cast<double>(available_memory_bytes()));
}

std::string limit_text(const RenderSettings& settings) {
    return settings.max_memory_bytes > 0
               ? "--max-memory is " + mebibytes(settings.max_memory_bytes)
               : "there are " + mebibytes(limit_of(settings)) + " to use (--max-memory)";
}

// On the host; and for OpenGL, where its fragments sample the images, once more.
Bytes scene_bytes(const Scene& scene, bool sampled_by_gl) {
    Bytes bytes = 0;
    for (const Mesh& mesh : scene.meshes) {
        constexpr Bytes kVertex =
            2 * sizeof(glm::vec3) + 2 * sizeof(glm::vec4) + 2 * sizeof(glm::vec2);
        bytes += mesh.positions.size() * kVertex + mesh.indices.size() * sizeof(std::uint32_t);
    }
    Bytes images = 0;
    for (const Image& image : scene.images) images += image.rgba.size() * 4 / 3;
    return 2 * bytes + (sampled_by_gl ? 2 : 1) * images +
           scene.instances.size() * 2 * sizeof(Instance);
}

// Of OpenGL's targets for a G-buffer, depth included.
Bytes target_pixel_bytes(const ScenePlan& plan) {
    constexpr Bytes kFloat4 = 16;
    const Bytes optional = plan.gbuffer.material ? 5 : 1;
    if (plan.gbuffer.layout == GBUFFER_FULL) return 4 + kFloat4 * (plan.gbuffer.material ? 5 : 4);
    if (plan.gbuffer.layout == GBUFFER_HALF) return 4 + 8 + 8 + 4 + optional;
    return static_cast<Bytes>(plan.gbuffer_bytes_per_pixel);
}

struct Need {
    Bytes fixed = 0;            // whatever the bands
    Bytes device_fixed = 0;     // the part of `fixed` that is device buffers
    Bytes band_pixel = 0;       // for each pixel of a band
    Bytes largest_element = 0;  // of a band's pixel in one buffer
};

Bytes layer_bytes(const RenderSettings& settings) {
    constexpr Bytes kMostChannels = 3;
    return settings.want.aovs.size() * kMostChannels * sizeof(float);
}

// What the whole picture takes on the host, and where stages need all of it, there too.
Bytes picture_pixel_bytes(const RenderSettings& settings) {
    Bytes bytes = kHostPixel + 2 * layer_bytes(settings);
    if (settings.want.view != ViewKind::lit)
        bytes += SURFACE_PLANES_WITH_SPECULAR * sizeof(float) + 8;
    if (settings.want.view == ViewKind::difference) bytes *= 2;
    return bytes;
}

// Of bloom, which mixes the whole picture: light, its copy, the smaller levels, the display
// picture.
Bytes bloom_pixel_bytes(const RenderSettings& settings) {
    constexpr Bytes kLightPixel = 3 * sizeof(float);
    return settings.bloom > 0.0f ? 2 * kLightPixel + kLightPixel / 3 + 4 : 0;
}

Need need_of(const Scene& scene, const RenderSettings& settings, const ScenePlan& plan) {
    const Bytes width = static_cast<Bytes>(settings.width + FINE_TILE - 1) / FINE_TILE * FINE_TILE;
    const auto height = static_cast<Bytes>(settings.height);
    const Bytes tile_rows =
        is_forward(settings.renderer) ? height : std::min<Bytes>(height, kRasterRows);
    const bool blends = has_blended_surfaces(scene);
    const bool decodes = settings.want.pixels();
    Need need;
    const bool ids = resolves_ids(settings.geometry) && !is_forward(settings.renderer);
    const std::size_t nodes = plan.kernels.light_tree ? 2 * scene.lights.size() : 0;
    need.device_fixed = (settings.lights.count + scene.lights.size() + nodes) * kLight +
                        width * height * bloom_pixel_bytes(settings);
    if (ids) {
        need.device_fixed +=
            surface_scene_bytes(scene, surface_features(scene, plan.gbuffer, kAnyAnisotropy));
    }
    // Texels of all levels.
    if (settings.background) {
        need.device_fixed += settings.background->rows.size() * sizeof(glm::vec3) * 4 / 3;
    }
    if (settings.reflections) {
        need.device_fixed += settings.reflections->texels.size() * sizeof(float);
    }
    // Each triangle's row and box of tiles; the tiles' lists are like those of lights.
    if (settings.geometry == Geometry::compute) {
        need.device_fixed +=
            (sizeof(RasterRow) + 4 * sizeof(std::uint32_t)) * triangle_count(scene);
    }
    if (plan.kernels.shadows) need.device_fixed += shadow_scene_bytes(scene);
    need.fixed = kProgram + scene_bytes(scene, !ids || blends) + need.device_fixed +
                 width * height * picture_pixel_bytes(settings);
    constexpr Bytes kForwardTarget = 20;
    if (!is_forward(settings.renderer)) need.fixed += width * tile_rows * target_pixel_bytes(plan);
    if (is_forward(settings.renderer) || blends) need.fixed += width * tile_rows * kForwardTarget;
    need.band_pixel = static_cast<Bytes>(plan.gbuffer_bytes_per_pixel) + kBandPixel + kListsPixel;
    if (plan.kernels.shadows) need.band_pixel += kShadowPixel;
    if (settings.auto_samples.on) {
        constexpr Bytes kPlanes = 2 * 5 + 3 + 1;  // of AdaptiveSamples
        need.band_pixel += kPlanes * sizeof(float) + sizeof(uint);
    } else if (settings.samples > 1) {
        need.band_pixel += 3 * (sizeof(double) + 2 * sizeof(float));
    }
    if (decodes || settings.want.counts) need.band_pixel += 4 * sizeof(std::uint32_t);
    if (decodes) {
        need.band_pixel += 2 * SURFACE_PLANES_WITH_SPECULAR * sizeof(float) + layer_bytes(settings);
    }
    if (blends) need.band_pixel += 3 * 3 * sizeof(float);
    need.largest_element =
        decodes ? SURFACE_PLANES_WITH_SPECULAR * sizeof(float) : 3 * sizeof(float);
    need.largest_element =
        std::max(need.largest_element, static_cast<Bytes>(plan.gbuffer_bytes_per_pixel));
    return need;
}

// Rows of a band at most: what a buffer of the device holds, and what 32 bits address.
Bytes most_rows(const Need& need, const DeviceInfo& device, Bytes width) {
    const Bytes buffer = std::min<Bytes>(device.max_allocation_bytes, 0xf0000000u);
    return std::min(buffer / need.largest_element, kMostBandPixels) / width;
}

bool needs_whole_tiles(const Scene& scene, const RenderSettings& settings) {
    return is_forward(settings.renderer) || has_blended_surfaces(scene);
}

std::string picture_text(const RenderSettings& settings) {
    return fmt::format("{}x{} pixels with {} generated lights", settings.width, settings.height,
                       settings.lights.count);
}

int multiple_of_tile(Bytes rows) { return static_cast<int>(rows / FINE_TILE * FINE_TILE); }

}  // namespace

MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device) {
    const Need need = need_of(scene, settings, plan);
    const Bytes limit = limit_of(settings);
    const Bytes width = static_cast<Bytes>(settings.width + FINE_TILE - 1) / FINE_TILE * FINE_TILE;
    const int whole = (settings.height + FINE_TILE - 1) / FINE_TILE * FINE_TILE;
    const int tile = is_forward(settings.renderer) ? whole : std::min(whole, kRasterRows);
    const int lowest = needs_whole_tiles(scene, settings) ? tile : FINE_TILE;
    const Bytes row = width * need.band_pixel;
    const Bytes fitting = limit > need.fixed ? (limit - need.fixed) / row : 0;
    const int rows = multiple_of_tile(
        std::min<Bytes>({fitting, most_rows(need, device, width), static_cast<Bytes>(tile)}));
    if (rows < lowest) {
        throw Error("memory: " + picture_text(settings) + " need at least " +
                    mebibytes(need.fixed + static_cast<Bytes>(lowest) * row) + "; " +
                    limit_text(settings));
    }
    MemoryPlan out;
    out.band_rows = settings.band_rows > 0 ? std::clamp(settings.band_rows, lowest, rows) : rows;
    out.bytes = need.fixed + static_cast<Bytes>(rows) * row;
    // A CPU's buffers are memory like the rest: lights and bands as planned, and for lists what is
    // left.
    out.device_bytes = device.is_cpu ? limit - need.fixed + need.device_fixed : device.memory_bytes;
    return out;
}

void check_light_memory(const RenderSettings& settings) {
    const Bytes need = kProgram + settings.lights.count * kLight;
    if (need <= limit_of(settings)) return;
    throw Error(fmt::format("memory: {} lights need at least {}; {}", settings.lights.count,
                            mebibytes(need), limit_text(settings)));
}

}  // namespace kilolux
