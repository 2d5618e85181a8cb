// SPDX-License-Identifier: Apache-2.0
#include "host/picture/aovs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Fills the channels of each pixel from `components(pixel in the planes, output)`.
template <typename T, typename Components>
void fill(const Layer& layer, std::vector<T>& values, const View& view, Components&& components) {
    const std::size_t n = layer.channels.size();
    values.resize(n * view.width * view.height);
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            components(y * view.stride + x, &values[n * (y * view.width + x)]);
        }
    }
}

template <std::size_t first_plane>
void fill_planes(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    fill(layer, layer.values, s.view, [&](std::size_t pixel, float* out) {
        for (std::size_t c = 0; c < layer.channels.size(); ++c)
            out[c] = s.at(first_plane + c, pixel);
    });
}

// Into world space: positions with the camera's place.
template <std::size_t first_plane>
void fill_world(const DecodedSurfaces& s, const Camera& camera, Layer& layer) {
    const glm::dvec3 origin = first_plane == SURFACE_POSITION ? camera.position : glm::dvec3(0.0);
    fill(layer, layer.values, s.view, [&](std::size_t pixel, float* out) {
        const glm::dvec3 world = camera.world_from_view * s.vector(first_plane, pixel) + origin;
        const bool has_surface = s.shows_surface(pixel);
        for (int c = 0; c < 3; ++c) out[c] = has_surface ? static_cast<float>(world[c]) : 0.0f;
    });
}

void fill_light_count(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    fill(layer, layer.ids, s.view, [&](std::size_t pixel, std::uint32_t* out) {
        const uint count = s.evaluated[pixel];
        *out = count == kBackground ? 0 : count;
    });
}

// Of a tree its nodes are evaluated, too.
std::uint64_t most_evaluated(const DecodedSurfaces&, std::uint64_t lights) { return 2 * lights; }

std::uint64_t cluster_count(const DecodedSurfaces& s, std::uint64_t) {
    return s.grid.cluster_count;
}

void fill_cluster(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    fill(layer, layer.ids, s.view, [&](std::size_t pixel, std::uint32_t* out) {
        const std::optional<uint> cluster = coarse_cluster_at(s, pixel);
        *out = cluster ? *cluster + 1 : 0;
    });
}

void fill_visibility(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    fill(layer, layer.values, s.view, [&](std::size_t pixel, float* out) {
        *out = s.shows_surface(pixel) ? static_cast<float>(1.0 - hidden_share(s, pixel)) : 0.0f;
    });
}

void fill_standard_error(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    assert(!s.variance.empty());
    fill(layer, layer.values, s.view, [&](std::size_t pixel, float* out) {
        *out = s.shows_surface(pixel) ? std::sqrt(s.variance[pixel]) : 0.0f;
    });
}

void fill_error_bound(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    assert(!s.bound.empty());
    const std::size_t plane = std::size_t{s.view.stride} * s.view.height;
    fill(layer, layer.values, s.view, [&](std::size_t pixel, float* out) {
        for (std::size_t c = 0; c < 3; ++c) out[c] = s.bound[c * plane + pixel];
    });
}

void fill_illuminance(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    assert(!s.illuminance.empty());
    fill(layer, layer.values, s.view, [&](std::size_t pixel, float* out) {
        *out = s.shows_surface(pixel) ? static_cast<float>(illuminance_at(s, pixel)) : 0.0f;
    });
}

void fill_layer_count(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    assert(!s.layers.empty());
    fill(layer, layer.ids, s.view,
         [&](std::size_t pixel, std::uint32_t* out) { *out = s.layers[pixel]; });
}

// Of --max-samples: see kAutoSamplesRange.
std::uint64_t most_samples(const DecodedSurfaces&, std::uint64_t) { return 65536; }

void fill_sample_count(const DecodedSurfaces& s, const Camera&, Layer& layer) {
    assert(!s.taken.empty());
    fill(layer, layer.ids, s.view,
         [&](std::size_t pixel, std::uint32_t* out) { *out = s.taken[pixel]; });
}

}  // namespace

const std::vector<AovKind>& aov_kinds() {
    static const std::vector<AovKind> kinds = {
        {"depth",
         {"Z"},
         "Z: distance along the view direction, in metres",
         fill_planes<SURFACE_DEPTH>},
        {"position",
         {"P.X", "P.Y", "P.Z"},
         "P.X, P.Y, P.Z: in the world, in metres",
         fill_world<SURFACE_POSITION>},
        {"normal",
         {"N.X", "N.Y", "N.Z"},
         "N.X, N.Y, N.Z: in the world",
         fill_world<SURFACE_NORMAL>},
        {"albedo",
         {"albedo.R", "albedo.G", "albedo.B"},
         "albedo.R, .G, .B: linear",
         fill_planes<SURFACE_ALBEDO>},
        {"roughness", {"roughness"}, "0 to 1", fill_planes<SURFACE_ROUGHNESS>},
        {"metallic", {"metallic"}, "0 to 1", fill_planes<SURFACE_METALLIC>},
        {"emissive",
         {"emissive.R", "emissive.G", "emissive.B"},
         "emissive.R, .G, .B: radiance",
         fill_planes<SURFACE_EMISSIVE>},
        {"light-count",
         {"light-count"},
         "lights evaluated, integers",
         fill_light_count,
         most_evaluated},
        {"cluster",
         {"cluster"},
         "coarse cluster + 1, integers; 0: background",
         fill_cluster,
         cluster_count},
        {"visibility",
         {"visibility"},
         "share of the lights in reach that are seen",
         fill_visibility},
        {"illuminance",
         {"illuminance"},
         "of opaque surfaces by lights, in lux: intensity x falloff x cosine, with exact shadows "
         "where asked for",
         fill_illuminance},
        {"error-standard",
         {"error.standard"},
         "of the luminance: of one sample (--shadows sampled, --tails stochastic), or of the mean "
         "(--samples auto)",
         fill_standard_error},
        {"error-bound",
         {"error.bound.R", "error.bound.G", "error.bound.B"},
         "most radiance that --tails bounded or tree errs by (deferred only)",
         fill_error_bound},
        {"sample-count",
         {"sample-count"},
         "samples of --samples auto, integers",
         fill_sample_count,
         most_samples},
        {"layer-count",
         {"layer-count"},
         "surfaces that blend over the pixel, integers",
         fill_layer_count}};
    return kinds;
}

namespace {

const AovKind& kind_of(std::string_view name) {
    const auto kind = std::ranges::find(aov_kinds(), name, &AovKind::name);
    if (kind != aov_kinds().end()) return *kind;
    throw UsageError("--aov: '" + std::string(name) + "' is not a layer");
}

}  // namespace

std::size_t most_aov_channels() {
    const auto channels = [](const AovKind& kind) { return kind.channels.size(); };
    return std::ranges::max(aov_kinds(), {}, channels).channels.size();
}

Layer make_aov(std::string_view name, const DecodedSurfaces& surfaces, const Camera& camera) {
    const AovKind& kind = kind_of(name);
    Layer layer{kind.name, kind.channels};
    kind.fill(surfaces, camera, layer);
    return layer;
}

Layer make_aov_of_strip(std::string_view name, const DecodedSurfaces& surfaces,
                        const Camera& camera, std::uint64_t lights) {
    Layer layer = make_aov(name, surfaces, camera);
    const auto most_id = kind_of(name).most_id;
    if (layer.is_id()) {
        layer.most_id = most_id != nullptr ? most_id(surfaces, lights)
                                           : std::numeric_limits<std::uint32_t>::max();
    }
    return layer;
}

namespace {

Layer light_layer(std::string_view group) {
    const std::string name = std::string(kLightLayers).append(group);
    return {name, {name + ".R", name + ".G", name + ".B"}};
}

}  // namespace

std::vector<Layer> make_light_layers(const DecodedSurfaces& surfaces,
                                     const std::vector<LightGroup>& groups) {
    std::vector<Layer> out;
    if (groups.empty()) return out;
    const std::size_t plane = std::size_t{surfaces.view.stride} * surfaces.view.height;
    const auto light = [&](std::size_t group, std::size_t channel, std::size_t pixel) {
        return surfaces.light[(3 * group + channel) * plane + pixel];
    };
    for (std::size_t g = 0; g < groups.size(); ++g) {
        out.push_back(light_layer(groups[g].name));
        fill(out.back(), out.back().values, surfaces.view, [&](std::size_t pixel, float* to) {
            for (std::size_t c = 0; c < 3; ++c) to[c] = light(g + 1, c, pixel);
        });
    }
    out.push_back(light_layer(kRestGroup));
    fill(out.back(), out.back().values, surfaces.view, [&](std::size_t pixel, float* to) {
        for (std::size_t c = 0; c < 3; ++c) {
            double rest = light(0, c, pixel);
            for (std::size_t g = 1; g <= groups.size(); ++g) rest -= light(g, c, pixel);
            to[c] = static_cast<float>(rest);
        }
    });
    return out;
}

}  // namespace kilolux
