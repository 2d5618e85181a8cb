// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/memory_plan.h"

#include <fmt/format.h>
#include <algorithm>
#include <span>

#include "host/base/error.h"
#include "host/base/system/memory.h"
#include "host/images/images.h"
#include "host/picture/aovs.h"
#include "host/picture/bands.h"
#include "host/picture/decoded_surfaces.h"
#include "host/render/environment_light.h"
#include "host/render/layers.h"
#include "host/render/whole_picture.h"
#include "host/stages/lights/drift_lights.h"
#include "host/stages/lights/move_lights.h"
#include "host/stages/lights/prepare_lights.h"
#include "host/stages/lists/bin_pixels.h"
#include "host/stages/lists/count_lights.h"
#include "host/stages/lists/mask_tiles.h"
#include "host/stages/picture/adaptive_samples.h"
#include "host/stages/picture/sum_samples.h"
#include "host/stages/shadows/shadow_origins.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/decode_gbuffer.h"
#include "host/stages/surfaces/raster_triangles.h"
#include "host/surfaces/shadow_scene.h"
#include "host/surfaces/surface_scene.h"
#include "kernels/shared/cluster_grid.h"
#include "raster/forward_pass.h"
#include "raster/solid_pass.h"

namespace kilolux {
namespace {

using Bytes = std::uint64_t;

// The program with its drivers and their compilers: resident size of a 16x16 picture, rounded up.
constexpr Bytes kProgram = Bytes{256} << 20;
// Bytes of one light: twice as the scene has it, and its rows.
constexpr Bytes kLight = 2 * sizeof(SceneLight) + MoveLights::kLightBytes +
                         PrepareLights::kLightBytes + DriftLights::kLightBytes;
// Radiance and display picture.
constexpr Bytes kPicturePixel = Radiance::kPixelBytes + DisplayTarget::kPixelBytes;
// Writing a file takes as much again.
constexpr Bytes kHostPixel = 2 * kPicturePixel;
// On the device, and twice on the host: as planes and pixels.
constexpr Bytes kBandPixel = 3 * kPicturePixel;
// Kernels count the elements of a picture's planes in 32 bits.
constexpr Bytes kMostBandPixels = (Bytes{1} << 32) / SURFACE_PLANES - 1;
// Anisotropy changes no texture's memory.
constexpr int kAnyAnisotropy = 1;
// OpenCL drivers and encoders of image files take the rest of what is available.
constexpr double kAvailableShare = 0.8;

// All that the process may hold, the program's own part of it included.
Bytes whole_limit(const RenderSettings& settings) {
    if (settings.max_memory_bytes > 0) return settings.max_memory_bytes;
    const Bytes own = std::min(resident_memory_bytes(), kProgram);
    return static_cast<Bytes>(kAvailableShare *
                              static_cast<double>(std::min(available_memory_bytes(), ~own) + own));
}

std::string limit_text(const RenderSettings& settings) {
    const std::string whole = mebibytes(whole_limit(settings));
    if (settings.memory_shares > 1) {
        return fmt::format("{} renderers share {} (--max-memory)", settings.memory_shares, whole);
    }
    return settings.max_memory_bytes > 0 ? "--max-memory is " + whole
                                         : "there are " + whole + " to use (--max-memory)";
}

Bytes bytes_of(const auto&... vectors) { return (std::span(vectors).size_bytes() + ...); }

// Bytes of the scene on the host; once more for OpenGL where its fragments sample the images.
Bytes scene_bytes(const Scene& scene, bool sampled_by_gl) {
    Bytes bytes = 0;
    for (const Mesh& mesh : scene.meshes) {
        bytes += bytes_of(mesh.positions, mesh.normals, mesh.tangents, mesh.texcoords[0],
                          mesh.texcoords[1], mesh.colors, mesh.indices);
    }
    Bytes images = 0;
    for (const Image& image : scene.images) images += image.bytes() * 4 / 3;
    return 2 * bytes + (sampled_by_gl ? 2 : 1) * images +
           scene.instances.size() * 2 * sizeof(Instance);
}

struct Need {
    Bytes fixed = 0;            // whatever the bands
    Bytes device_fixed = 0;     // the part of `fixed` that is device buffers
    Bytes picture_pixel = 0;    // for each pixel of the pictures on the host
    Bytes band_pixel = 0;       // for each pixel of a band
    Bytes largest_element = 0;  // of a band's pixel in one buffer
};

// Layers of groups' light have as many channels as radiance has.
Bytes layer_bytes(const RenderSettings& settings) {
    const std::size_t groups = settings.light_groups.size();
    return settings.want.aovs.size() * most_aov_channels() * sizeof(float) +
           (groups > 0 ? (groups + 1) * Radiance::kPixelBytes : 0);
}

// Bytes of a pixel of the pictures on the host.
Bytes picture_pixel_bytes(const RenderSettings& settings) {
    Bytes bytes = kHostPixel + 2 * layer_bytes(settings);
    if (settings.want.view != ViewKind::lit) bytes += DecodedSurfaces::kPixelBytes;
    if (settings.want.view == ViewKind::illuminance) bytes += Radiance::kPixelBytes;
    if (settings.want.view == ViewKind::difference) bytes *= 2;
    return bytes;
}

// Bytes of the scene on the device, for any picture size.
Bytes scene_device_bytes(const Scene& scene, const RenderSettings& settings, const ScenePlan& plan,
                         bool ids, bool blends) {
    const std::size_t nodes = plan.kernels.light_tree ? 2 * scene.lights.size() : 0;
    Bytes bytes = (settings.lights.count + scene.lights.size() + nodes) * kLight;
    if (ids || blends) {
        bytes += surface_scene_bytes(
            scene, surface_features(scene, plan.of_layers().gbuffer, kAnyAnisotropy));
    }
    bytes += EnvironmentLight::device_bytes(settings);
    if (ids && settings.geometry != Geometry::ids) {  // `automatic` may draw in OpenCL, too
        bytes += BinTriangles::kTriangleBytes * triangle_count(scene);
    }
    if (blends) bytes += BinTriangles::kTriangleBytes * triangle_count(scene);  // at most
    if (plan.kernels.shadows) bytes += shadow_scene_bytes(scene);
    return bytes;
}

// Bytes of a pixel of a band.
Bytes band_pixel_bytes(const RenderSettings& settings, const ScenePlan& plan, bool ids,
                       bool blends) {
    const bool decodes = reads_pixels(settings);
    const std::size_t groups = settings.light_groups.size();
    Bytes lists = BinPixels::kPixelBytes;
    if (plan.kernels.shadows) lists += ShadowOrigins::kPixelBytes;
    Bytes bytes = static_cast<Bytes>(plan.gbuffer_bytes_per_pixel) + lists + kBandPixel +
                  2 * groups * Radiance::kPixelBytes;                           // and on the host
    if (plan.kernels.sampled_shadows) bytes += groups * Radiance::kPixelBytes;  // unshadowed
    if (settings.want.illuminance()) bytes += 2 * Radiance::kPixelBytes;
    if (blends) {
        bytes += static_cast<Bytes>(plan.of_layers().gbuffer_bytes_per_pixel) + lists +
                 Layers::kPixelBytes + groups * Radiance::kPixelBytes;
    }
    if (ids) bytes += RasterTriangles::kPixelBytes;  // or as many that OpenGL hands over
    if (ids && settings.auto_samples.on) bytes += MaskTiles::kPixelBytes;
    if (settings.auto_samples.on) {
        bytes += AdaptiveSamples::kPixelBytes + (1 + groups) * AdaptiveSamples::kRadianceBytes;
    } else if (settings.samples > 1) {
        bytes += (1 + groups) * SumSamples::kPixelBytes;
    }
    if (decodes || settings.want.counts) bytes += 2 * CountLights::kPixelBytes;  // and on the host
    if (decodes) bytes += 2 * DecodeGBuffer::kPixelBytes + layer_bytes(settings);
    if (settings.want.layers()) bytes += 2 * DecodeGBuffer::kPixelBytes + 2 * sizeof(uint);
    return bytes;
}

Bytes padded_width(const RenderSettings& settings) {
    return static_cast<Bytes>(settings.width + FINE_TILE - 1) / FINE_TILE * FINE_TILE;
}

// Bytes of a pixel's light in the largest buffer of it.
Bytes radiance_element(const RenderSettings& settings) {
    const std::size_t groups = settings.light_groups.size();
    if (settings.auto_samples.on) return AdaptiveSamples::state_floats(groups) * sizeof(float);
    const Bytes sums = settings.samples > 1 ? SumSamples::kSumFloats : 1;
    return (1 + groups) * sums * Radiance::kPixelBytes;
}

Need need_of(const Scene& scene, const RenderSettings& settings, const ScenePlan& plan,
             bool draws_in_opencl) {
    const Bytes width = padded_width(settings);
    const auto height = static_cast<Bytes>(settings.height);
    const Bytes tile_rows =
        is_forward(settings.renderer) ? height : std::min<Bytes>(height, kRasterRows);
    const bool reads_layers = settings.want.layers() || settings.want.probes;
    const bool blends =
        has_blended_surfaces(scene) && (!is_forward(settings.renderer) || reads_layers);
    const bool ids = resolves_ids(settings.geometry) && !is_forward(settings.renderer);
    Need need;
    const Bytes on_device = scene_device_bytes(scene, settings, plan, ids, blends);
    need.device_fixed = on_device + width * height * whole_picture_pixel_bytes(settings);
    need.fixed = kProgram + scene_bytes(scene, !ids) + need.device_fixed;
    need.picture_pixel = picture_pixel_bytes(settings);
    need.fixed += settings.want.crop_pixels * need.picture_pixel;
    if (settings.want.view == ViewKind::difference)
        need.fixed += on_device;  // of the reference pipeline
    Bytes target_pixel = is_forward(settings.renderer) ? ForwardPass::kPixelBytes : 0;
    if (!is_forward(settings.renderer) && !draws_in_opencl) {
        target_pixel += ids ? IdsPass::kPixelBytes : plan_targets(plan.gbuffer).pixel_bytes;
    }
    need.fixed += width * tile_rows * target_pixel;
    need.band_pixel = band_pixel_bytes(settings, plan, ids, blends);
    need.largest_element = std::max<Bytes>(
        {reads_pixels(settings) ? DecodeGBuffer::kPixelBytes : 0, radiance_element(settings),
         static_cast<Bytes>(plan.of_layers().gbuffer_bytes_per_pixel)});
    return need;
}

// Most rows of a band: bounded by a device's buffer, and by 32-bit indices.
Bytes most_rows(const Need& need, const DeviceInfo& device, Bytes width) {
    const Bytes buffer = std::min<Bytes>(device.max_allocation_bytes, 0xf0000000u);
    return std::min(buffer / need.largest_element, kMostBandPixels) / width;
}

std::string lights_text(Bytes count, const char* kind) {
    return fmt::format("{} {}light{}", count, kind, count == 1 ? "" : "s");
}

std::string picture_text(const Scene& scene, const RenderSettings& settings) {
    return fmt::format("{}x{} pixels with {}", settings.width, settings.height,
                       lights_text(settings.lights.count + scene.lights.size(), ""));
}

int multiple_of_tile(Bytes rows) { return static_cast<int>(rows / FINE_TILE * FINE_TILE); }

// Rows that the host holds as one, and what does not depend on the rows of a band with them.
struct Strip {
    int rows = 0;
    Bytes fixed = 0;
};

Strip all_rows(const RenderSettings& settings, const Need& need) {
    const auto height = static_cast<Bytes>(settings.height);
    return {settings.height, need.fixed + padded_width(settings) * height * need.picture_pixel};
}

// The highest strip of at most kStripPixels, shared by the makers, of which those that are held
// take a small part of the memory: bands and lists need the rest.
Strip highest_strip(const RenderSettings& settings, const Need& need, int lowest, Bytes limit) {
    constexpr Bytes kHeld = 4;  // one is made, one is coded, with copies, and one waits
    constexpr Bytes kPart = 8;  // they take one part in so many of what is left
    const Bytes left = limit > need.fixed ? limit - need.fixed : 0;
    const Bytes width = padded_width(settings);
    const int step = std::max(lowest, kFileBlockRows);
    const auto multiple = [step](Bytes rows) {
        return std::max(step, static_cast<int>(rows) / step * step);
    };
    const Bytes row = kHeld * width * need.picture_pixel;
    const auto makers = static_cast<Bytes>(settings.want.strip_makers);
    const int rows = multiple(std::min(kStripPixels / width / makers, left / kPart / row));
    return {rows, need.fixed + row * static_cast<Bytes>(rows)};
}

Strip choose_strip(const RenderSettings& settings, const Need& need, int lowest, Bytes limit) {
    const Strip whole = all_rows(settings, need);
    if (settings.want.strip_makers == 0 || !can_make_strips(settings)) return whole;
    const Bytes width = padded_width(settings);
    const bool is_large = width * static_cast<Bytes>(settings.height) > kLargePicture;
    // With half of the memory for bands, and for lists, which are not planned.
    const bool fits = 2 * whole.fixed <= limit + need.fixed;
    if (fits && !is_large) return whole;
    const Strip out = highest_strip(settings, need, lowest, limit);
    return out.fixed < whole.fixed ? out : whole;
}

}  // namespace

std::uint64_t memory_limit(const RenderSettings& settings) {
    return whole_limit(settings) / static_cast<Bytes>(settings.memory_shares);
}

MemoryPlan plan_memory(const Scene& scene, const RenderSettings& settings, const ScenePlan& plan,
                       const DeviceInfo& device, bool draws_in_opencl) {
    const Need need = need_of(scene, settings, plan, draws_in_opencl);
    const Bytes limit = memory_limit(settings);
    const Bytes width = padded_width(settings);
    const int whole = (settings.height + FINE_TILE - 1) / FINE_TILE * FINE_TILE;
    const int tile = is_forward(settings.renderer) ? whole : std::min(whole, kRasterRows);
    const int lowest = is_forward(settings.renderer) ? tile : FINE_TILE;
    const auto [strip, fixed] = choose_strip(settings, need, lowest, limit);
    const int most = strip < settings.height ? std::min(tile, strip) : tile;
    const Bytes row = width * need.band_pixel;
    const Bytes fitting = limit > fixed ? (limit - fixed) / row : 0;
    const int rows = multiple_of_tile(
        std::min<Bytes>({fitting, most_rows(need, device, width), static_cast<Bytes>(most)}));
    if (rows < lowest) {
        throw Error("memory: " + picture_text(scene, settings) + " need at least " +
                    mebibytes(fixed + static_cast<Bytes>(lowest) * row) + "; " +
                    limit_text(settings));
    }
    MemoryPlan out;
    out.band_rows = settings.band_rows > 0 ? std::clamp(settings.band_rows, lowest, rows) : rows;
    out.least_rows = lowest;
    out.strip_rows = strip;
    out.bytes = fixed + static_cast<Bytes>(rows) * row;
    constexpr Bytes kHeldShare = 4;  // finished pictures get one part in four of what is left
    out.held_bytes = (limit - out.bytes) / kHeldShare;
    // A CPU's buffers share the host's memory: lights and bands get what is planned, lists the
    // rest.
    out.device_bytes = device.is_cpu
                           ? limit - out.held_bytes - fixed + need.device_fixed
                           : device.memory_bytes / static_cast<Bytes>(settings.device_shares);
    return out;
}

void check_light_memory(std::uint64_t lights, const RenderSettings& settings) {
    const Bytes limit = memory_limit(settings);
    const Bytes need = kProgram + lights * kLight;
    if (need <= limit) return;
    const std::string what =
        kProgram > limit ? "the program with its drivers needs at least " + mebibytes(kProgram)
                         : "the program and " + lights_text(lights, "generated ") +
                               " need at least " + mebibytes(need);
    throw Error("memory: " + what + "; " + limit_text(settings));
}

}  // namespace kilolux
