// SPDX-License-Identifier: Apache-2.0
#include "host/picture/decoded_surfaces.h"

#include <cmath>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Fills `n` values a pixel from `components(pixel in the planes, output)`.
template <typename T, typename Components>
void fill(std::vector<T>& values, std::size_t n, const View& view, Components&& components) {
    values.resize(n * view.width * view.height);
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            components(y * view.stride + x, &values[n * (y * view.width + x)]);
        }
    }
}

Layer plane_layer(std::string_view name, std::vector<std::string> channels,
                  const DecodedSurfaces& s, std::size_t first_plane) {
    Layer layer{std::string(name), std::move(channels)};
    const std::size_t n = layer.channels.size();
    fill(layer.values, n, s.view, [&](std::size_t pixel, float* out) {
        for (std::size_t c = 0; c < n; ++c) out[c] = s.at(first_plane + c, pixel);
    });
    return layer;
}

Layer world_layer(std::string_view name, std::vector<std::string> channels,
                  const DecodedSurfaces& s, const Camera& camera) {
    Layer layer{std::string(name), std::move(channels)};
    const bool position = name == "position";
    fill(layer.values, 3, s.view, [&](std::size_t pixel, float* out) {
        const glm::dvec3 v = s.vector(position ? SURFACE_POSITION : SURFACE_NORMAL, pixel);
        const bool drawn = s.shows_surface(pixel);
        const glm::dvec3 world =
            camera.world_from_view * v + (position ? camera.position : glm::dvec3(0.0));
        for (int c = 0; c < 3; ++c) out[c] = drawn ? static_cast<float>(world[c]) : 0.0f;
    });
    return layer;
}

Layer count_layer(const DecodedSurfaces& s) {
    Layer layer{"light-count", {"light-count"}};
    fill(layer.ids, 1, s.view, [&](std::size_t pixel, std::uint32_t* out) {
        const uint count = s.evaluated[pixel];
        *out = count == kBackground ? 0 : count;
    });
    return layer;
}

// Coarse cluster + 1, so that background is 0.
Layer cluster_layer(const DecodedSurfaces& s) {
    Layer layer{"cluster", {"cluster"}};
    fill(layer.ids, 1, s.view, [&](std::size_t pixel, std::uint32_t* out) {
        const std::optional<uint> cluster = coarse_cluster_at(s, pixel);
        *out = cluster ? *cluster + 1 : 0;
    });
    return layer;
}

Layer visibility_layer(const DecodedSurfaces& s) {
    if (s.seen.empty()) throw UsageError("aov visibility: no shadows were cast");
    Layer layer{"visibility", {"visibility"}};
    fill(layer.values, 1, s.view, [&](std::size_t pixel, float* out) {
        *out = s.shows_surface(pixel) ? static_cast<float>(1.0 - hidden_share(s, pixel)) : 0.0f;
    });
    return layer;
}

Layer error_layer(const DecodedSurfaces& s) {
    if (s.variance.empty()) throw UsageError("aov error-standard: nothing was sampled");
    Layer layer{"error-standard", {"error.standard"}};
    fill(layer.values, 1, s.view, [&](std::size_t pixel, float* out) {
        *out = s.shows_surface(pixel) ? std::sqrt(s.variance[pixel]) : 0.0f;
    });
    return layer;
}

Layer bound_layer(const DecodedSurfaces& s) {
    if (s.bound.empty()) throw UsageError("aov error-bound: only --renderer deferred has one");
    Layer layer{"error-bound", {"error.bound.R", "error.bound.G", "error.bound.B"}};
    const std::size_t plane = std::size_t{s.view.stride} * s.view.height;
    fill(layer.values, 3, s.view, [&](std::size_t pixel, float* out) {
        for (std::size_t c = 0; c < 3; ++c) out[c] = s.bound[c * plane + pixel];
    });
    return layer;
}

Layer samples_layer(const DecodedSurfaces& s) {
    if (s.taken.empty()) throw UsageError("aov sample-count: needs --samples auto");
    Layer layer{"sample-count", {"sample-count"}};
    fill(layer.ids, 1, s.view,
         [&](std::size_t pixel, std::uint32_t* out) { *out = s.taken[pixel]; });
    return layer;
}

}  // namespace

double hidden_share(const DecodedSurfaces& s, std::size_t i) {
    if (s.facing[i] == 0) return 0.0;
    return 1.0 - static_cast<double>(s.seen[i]) / static_cast<double>(s.facing[i]);
}

std::optional<uint> coarse_cluster_at(const DecodedSurfaces& s, std::size_t pixel) {
    const float z = s.at(SURFACE_DEPTH, pixel);
    if (z == 0.0f) return std::nullopt;
    const uint x = static_cast<uint>(pixel % s.view.stride) / s.grid.tile_width;
    const uint row = static_cast<uint>(pixel / s.view.stride) + s.view.first_row;
    return cluster_index(s.grid, x, row / s.grid.tile_height, slice_of_depth(s.grid, z));
}

double mean_over_surfaces(const std::vector<uint>& counts) {
    double sum = 0.0;
    std::size_t drawn = 0;
    for (const uint count : counts) {
        if (count == kBackground) continue;
        sum += count;
        ++drawn;
    }
    return drawn > 0 ? sum / static_cast<double>(drawn) : 0.0;
}

const std::vector<std::string>& aov_names() {
    static const std::vector<std::string> names = {
        "depth",          "position",    "normal",      "albedo",  "roughness",
        "metallic",       "emissive",    "light-count", "cluster", "visibility",
        "error-standard", "error-bound", "sample-count"};
    return names;
}

Layer make_aov(std::string_view name, const DecodedSurfaces& s, const Camera& camera) {
    if (name == "depth") return plane_layer(name, {"Z"}, s, SURFACE_DEPTH);
    if (name == "position") return world_layer(name, {"P.X", "P.Y", "P.Z"}, s, camera);
    if (name == "normal") return world_layer(name, {"N.X", "N.Y", "N.Z"}, s, camera);
    if (name == "albedo")
        return plane_layer(name, {"albedo.R", "albedo.G", "albedo.B"}, s, SURFACE_ALBEDO);
    if (name == "roughness") return plane_layer(name, {"roughness"}, s, SURFACE_ROUGHNESS);
    if (name == "error-standard") return error_layer(s);
    if (name == "error-bound") return bound_layer(s);
    if (name == "visibility") return visibility_layer(s);
    if (name == "metallic") return plane_layer(name, {"metallic"}, s, SURFACE_METALLIC);
    if (name == "emissive")
        return plane_layer(name, {"emissive.R", "emissive.G", "emissive.B"}, s, SURFACE_EMISSIVE);
    if (name == "light-count") return count_layer(s);
    if (name == "cluster") return cluster_layer(s);
    if (name == "sample-count") return samples_layer(s);
    throw UsageError("--aov: '" + std::string(name) + "' is not a layer");
}

}  // namespace kilolux
