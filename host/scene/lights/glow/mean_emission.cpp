// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/glow/mean_emission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/scene/mip_level.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

constexpr double kPointsPerTexel = 8.0;  // along a side
constexpr double kLeastPoints = 32.0;    // likewise

// A material's map over one triangle.
class TriangleMap {
 public:
    TriangleMap(const Scene& scene, const TextureUse& use, TextureEncoding encoding,
                const Mesh& mesh, std::size_t number) {
        const int texture = use.texture;
        if (!use.present() || scene.textures[static_cast<std::size_t>(texture)].image < 0) return;
        const Texture& read = scene.textures[static_cast<std::size_t>(texture)];
        const Image& image = scene.images[static_cast<std::size_t>(read.image)];
        sampler_ = read.sampler;
        level_ = {image.width, image.height, &image, encoding};
        const auto& texcoords = mesh.texcoords[use.uv_set == 1 ? 1 : 0];
        for (std::size_t i = 0; i < 3 && !texcoords.empty(); ++i) {
            const glm::dvec3 uv(glm::dvec2(texcoords[mesh.indices[3 * number + i]]), 1.0);
            uv_[i] = glm::dvec2(glm::dmat3(use.uv_from_texcoord) * uv);
        }
    }

    // RGBA at barycentric weights; 1 without a map.
    glm::dvec4 at(const glm::dvec3& weights) const {
        if (level_.image == nullptr) return glm::dvec4(1.0);
        return filtered(sampler_.magnify, level_, sampler_,
                        weights.x * uv_[0] + weights.y * uv_[1] + weights.z * uv_[2]);
    }

    // Of the edge opposite to corner i, in texels.
    double edge(std::size_t i) const {
        const glm::dvec2 d = uv_[(i + 2) % 3] - uv_[(i + 1) % 3];
        return std::hypot(d.x * level_.width, d.y * level_.height);
    }

 private:
    Sampler sampler_;
    MipLevel level_;
    std::array<glm::dvec2, 3> uv_{};
};

// Emission and coverage over one triangle.
class TriangleEmission {
 public:
    TriangleEmission(const Scene& scene, const Mesh& mesh, const Material& material,
                     std::size_t number)
        : material_(material),
          color_(scene, material.emissive_texture, TextureEncoding::srgb, mesh, number),
          alpha_(scene, material.base_color_texture, TextureEncoding::linear, mesh, number) {
        for (std::size_t i = 0; i < 3 && !mesh.colors.empty(); ++i) {
            vertex_alpha_[static_cast<glm::length_t>(i)] =
                mesh.colors[mesh.indices[3 * number + i]].w;
        }
    }

    glm::dvec3 at(const glm::dvec3& weights) const {
        return coverage(weights) * glm::dvec3(material_.emissive) * glm::dvec3(color_.at(weights));
    }

    double edge(std::size_t i) const {
        const bool covers = material_.alpha_mode == AlphaMode::opaque;
        return std::max(color_.edge(i), covers ? 0.0 : alpha_.edge(i));
    }

 private:
    double coverage(const glm::dvec3& weights) const {
        if (material_.alpha_mode == AlphaMode::opaque) return 1.0;
        const double alpha = double{material_.base_color.w} * alpha_.at(weights).w *
                             glm::dot(weights, vertex_alpha_);
        if (material_.alpha_mode == AlphaMode::blend) return std::clamp(alpha, 0.0, 1.0);
        return alpha >= double{material_.alpha_cutoff} ? 1.0 : 0.0;
    }

    const Material& material_;
    TriangleMap color_, alpha_;
    glm::dvec3 vertex_alpha_{1.0};
};

// A grid over a triangle: u from corner `apex` to the edge opposite to it, v along that edge.
struct TriangleGrid {
    std::size_t apex = 0;
    std::size_t rows = 1, columns = 1;

    // Barycentric weights.
    glm::dvec3 weights(double u, double v) const {
        glm::dvec3 out;
        out[static_cast<glm::length_t>(apex)] = 1.0 - u;
        out[static_cast<glm::length_t>((apex + 1) % 3)] = u * (1.0 - v);
        out[static_cast<glm::length_t>((apex + 2) % 3)] = u * v;
        return out;
    }
};

// The columns run along the shortest edge.
TriangleGrid grid_of(const TriangleEmission& emission, std::size_t most_points) {
    TriangleGrid out;
    std::array<double, 3> edges{};
    for (std::size_t i = 0; i < 3; ++i) edges[i] = emission.edge(i);
    out.apex = static_cast<std::size_t>(std::ranges::min_element(edges) - edges.begin());
    const double most = static_cast<double>(most_points);
    const auto points = [](double texels) {
        return std::max(kLeastPoints, std::ceil(kPointsPerTexel * std::min(texels, 1e6)));
    };
    double rows = points(*std::ranges::max_element(edges)), columns = points(edges[out.apex]);
    if (rows * columns > most) {
        const double share = std::sqrt(most / (rows * columns));
        columns = std::max(1.0, std::floor(columns * share));
        rows = std::max(1.0, std::floor(std::min(rows, most / columns)));
    }
    out.rows = static_cast<std::size_t>(rows);
    out.columns = static_cast<std::size_t>(columns);
    return out;
}

}  // namespace

bool glows(const Material& material) {
    const glm::vec3& e = material.emissive;
    return !material.unlit && std::max({e.x, e.y, e.z}) > 0.0f;
}

bool has_varied_emission(const Material& material) {
    return material.emissive_texture.present() || material.alpha_mode != AlphaMode::opaque;
}

MeanEmission mean_emission(const Scene& scene, const Mesh& mesh, const Material& material,
                           std::size_t number, std::size_t most_points) {
    if (!has_varied_emission(material)) return {glm::dvec3(material.emissive), 0.0};
    const TriangleEmission emission(scene, mesh, material, number);
    const TriangleGrid grid = grid_of(emission, most_points);
    const ulong key = item_key(0, number);
    const auto rows = static_cast<double>(grid.rows), columns = static_cast<double>(grid.columns);
    const glm::dvec3 first = emission.at(grid.weights(0.5, 0.5));
    // Sums of differences from one value: what is uniform has exactly no variance.
    glm::dvec3 sum(0.0), squares(0.0);
    double area = 0.0;
    for (std::size_t i = 0; i < grid.rows; ++i) {
        for (std::size_t j = 0; j < grid.columns; ++j) {
            const ulong cell = item_key(key, i * grid.columns + j);
            const double u = (static_cast<double>(i) + unit_double(item_bits(cell, 0))) / rows;
            const double v = (static_cast<double>(j) + unit_double(item_bits(cell, 1))) / columns;
            const glm::dvec3 d = emission.at(grid.weights(u, v)) - first;
            sum += u * d;
            squares += u * d * d;
            area += u;
        }
    }
    const glm::dvec3 mean = sum / area;
    const glm::dvec3 variance = glm::max(squares / area - mean * mean, glm::dvec3(0.0));
    return {glm::max(first + mean, glm::dvec3(0.0)), variance.x + variance.y + variance.z};
}

}  // namespace kilolux
