// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/prefiltered_environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include "host/base/system/parallel.h"

namespace kilolux {
namespace {

constexpr double kRoughnessMin = 0.045;  // ROUGHNESS_MIN of kernels/shared/surface.h
constexpr double kNDotVMin = 1e-4;       // N_DOT_V_MIN, ibid.
constexpr unsigned kTableSize = 64;
// Half the angle to a lobe's axis within which 96 % of its light is, in alphas.
constexpr double kLobeAlphas = 5.0;

// Widths of a level and of the environment that it is made of: a few texels a lobe.
struct LevelPlan {
    double roughness;
    int width;
    int source_width;
};
constexpr LevelPlan kLevels[] = {{0.0, 1024, 1024}, {0.125, 512, 512}, {0.25, 256, 256},
                                 {0.375, 128, 128}, {0.5, 64, 128},    {0.625, 64, 128},
                                 {0.75, 64, 128},   {0.875, 64, 128},  {1.0, 64, 128}};
constexpr LevelPlan kIrradiance = {-1.0, 64, 128};

double alpha_of(double roughness) {
    const double r = std::max(roughness, kRoughnessMin);
    return r * r;
}

// The part of `count` steps that step `i` of `other` ones over the same extent covers.
struct Covered {
    double begin, end;  // in steps
    int first, last;    // whole or in part
};
Covered covered(int i, int other, int count) {
    const double scale = static_cast<double>(count) / other;
    const double begin = i * scale, end = (i + 1) * scale;
    return {begin, end, static_cast<int>(begin),
            std::min(static_cast<int>(std::ceil(end)), count) - 1};
}

// The mean of the texels that each new texel covers, weighted by solid angle.
Environment resampled(const Environment& from, int height) {
    const double step = std::numbers::pi / from.height;
    Environment out{2 * height, height, {}};
    out.rows.resize(out.place(0, height));
    parallel_for(0, height, [&](int y) {
        const Covered rows = covered(y, height, from.height);
        for (int x = 0; x < out.width; ++x) {
            const Covered columns = covered(x, out.width, from.width);
            glm::dvec3 sum(0.0);
            double weights = 0.0;
            for (int i = rows.first; i <= rows.last; ++i) {
                const double high = std::cos(step * std::max<double>(rows.begin, i)) -
                                    std::cos(step * std::min<double>(rows.end, i + 1));
                for (int j = columns.first; j <= columns.last; ++j) {
                    const double wide =
                        std::min<double>(columns.end, j + 1) - std::max<double>(columns.begin, j);
                    sum += high * wide * glm::dvec3(from.rows[from.place(j, i)]);
                    weights += high * wide;
                }
            }
            out.rows[out.place(x, y)] = glm::vec3(sum / weights);
        }
    });
    return out;
}

// A texel in a sum over an environment.
struct SkyTexel {
    glm::dvec3 direction;
    double solid_angle;
};

std::vector<SkyTexel> texels_of(const Environment& e) {
    std::vector<SkyTexel> out;
    out.reserve(e.rows.size());
    for (int y = 0; y < e.height; ++y) {
        for (int x = 0; x < e.width; ++x) out.push_back({e.direction(x, y), e.solid_angle(y)});
    }
    return out;
}

// A lobe about an axis: GGX with the eye on the lobe's axis, or a cosine.
class Lobe {
 public:
    explicit Lobe(double roughness) : is_cosine_(roughness < 0.0) {
        const double alpha = alpha_of(roughness);
        alpha2_ = alpha * alpha;
        reach_ = is_cosine_
                     ? 0.5 * std::numbers::pi
                     : std::min(0.5 * std::numbers::pi, 2.0 * std::atan(kLobeAlphas * alpha));
    }
    double weight(double cos_angle) const {
        if (is_cosine_) return cos_angle;
        const double n_dot_h2 = 0.5 + 0.5 * cos_angle;  // of the half vector
        const double d = n_dot_h2 * (alpha2_ - 1.0) + 1.0;
        return cos_angle / (d * d);
    }
    double reach() const { return reach_; }  // [rad]

 private:
    bool is_cosine_;
    double alpha2_ = 0.0;
    double reach_;
};

// The environment's mean, weighted by the lobe about `axis`.
glm::dvec3 mean_around(const Environment& e, const std::vector<SkyTexel>& texels, const Lobe& lobe,
                       const glm::dvec3& axis) {
    const double from_top = std::acos(std::clamp(axis.y, -1.0, 1.0));
    const auto row = [&](double angle) {
        return static_cast<int>(std::floor(angle / std::numbers::pi * e.height));
    };
    const int first = std::max(row(from_top - lobe.reach()), 0);
    const int last = std::min(row(from_top + lobe.reach()), e.height - 1);
    const double around = std::sin(lobe.reach()) / std::max(std::sin(from_top), 1e-9);
    const bool all = around >= 1.0 || lobe.reach() >= 0.5 * std::numbers::pi;
    const int half =
        all ? e.width / 2
            : std::min(e.width / 2, 1 + static_cast<int>(std::asin(around) /
                                                         (2.0 * std::numbers::pi) * e.width));
    const int middle = static_cast<int>(
        std::floor((std::atan2(axis.x, -axis.z) / (2.0 * std::numbers::pi) + 0.5) * e.width));
    const double least = std::cos(lobe.reach());
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (int y = first; y <= last; ++y) {
        for (int i = middle - half; i < middle + half + (all ? e.width % 2 : 1); ++i) {
            const std::size_t place = e.place((i % e.width + e.width) % e.width, y);
            const double cos_angle = glm::dot(axis, texels[place].direction);
            if (cos_angle <= least) continue;
            const double weight = lobe.weight(cos_angle) * texels[place].solid_angle;
            sum += weight * glm::dvec3(e.rows[place]);
            weights += weight;
        }
    }
    return sum / std::max(weights, 1e-300);
}

Environment filtered(const Environment& environment, const LevelPlan& plan) {
    Environment source = shrunk(environment, plan.source_width);
    if (plan.roughness == 0.0) return source;
    const std::vector<SkyTexel> texels = texels_of(source);
    const Lobe lobe(plan.roughness);
    return painted_environment(plan.width / 2, [&](const glm::dvec3& direction) {
        return mean_around(source, texels, lobe, direction);
    });
}

void append(PrefilteredEnvironment& to, const Environment& level) {
    to.levels.push_back({static_cast<uint>(level.width), static_cast<uint>(level.height),
                         static_cast<uint>(to.texels.size() / 3), 0});
    const float* first = &level.rows.data()->x;
    to.texels.insert(to.texels.end(), first, first + 3 * level.rows.size());
}

// The base-2 digits of an index behind the point, mirrored (van der Corput).
double mirrored(unsigned i) {
    double out = 0.0;
    for (double digit = 0.5; i > 0; i >>= 1, digit *= 0.5) out += (i & 1u) != 0 ? digit : 0.0;
    return out;
}

// Schlick's rise at an angle.
double rise(double cos_angle) { return std::pow(std::max(1.0 - cos_angle, 0.0), 5.0); }

// The shares of f0 and f90: half vectors by GGX, height-correlated Smith (Karis 2013, listing 4).
glm::dvec2 specular_shares(double n_dot_v, double roughness) {
    constexpr unsigned kSamples = 512;
    const double alpha2 = alpha_of(roughness) * alpha_of(roughness);
    const glm::dvec3 v(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
    glm::dvec2 out(0.0);
    for (unsigned i = 0; i < kSamples; ++i) {
        const double u = (i + 0.5) / kSamples, phi = 2.0 * std::numbers::pi * mirrored(i);
        const double z = std::sqrt((1.0 - u) / (1.0 + (alpha2 - 1.0) * u));
        const double r = std::sqrt(1.0 - z * z);
        const glm::dvec3 h(r * std::cos(phi), r * std::sin(phi), z);
        const double v_dot_h = glm::dot(v, h), n_dot_l = 2.0 * v_dot_h * h.z - v.z;
        if (n_dot_l <= 0.0 || v_dot_h <= 0.0) continue;
        const auto smith = [&](double a, double b) {
            return a * std::sqrt(b * b * (1.0 - alpha2) + alpha2);
        };
        const double visible = 0.5 / (smith(n_dot_v, n_dot_l) + smith(n_dot_l, n_dot_v));
        const double share = 4.0 * visible * n_dot_l * v_dot_h / z / kSamples;
        out += share * glm::dvec2(1.0 - rise(v_dot_h), rise(v_dot_h));
    }
    return out;
}

// The mean of Schlick's rise over diffuse light: directions weighted by the cosine.
double diffuse_loss(double n_dot_v) {
    constexpr unsigned kSamples = 512;
    const glm::dvec3 v(std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
    double out = 0.0;
    for (unsigned i = 0; i < kSamples; ++i) {
        const double u = (i + 0.5) / kSamples, phi = 2.0 * std::numbers::pi * mirrored(i),
                     r = std::sqrt(u);
        const glm::dvec3 l(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - u));
        out += rise(glm::dot(v, glm::normalize(v + l))) / kSamples;
    }
    return out;
}

std::vector<float> reflectance_table() {
    std::vector<float> table(std::size_t{3} * kTableSize * kTableSize);
    parallel_for(0u, kTableSize, [&](unsigned column) {
        const double n_dot_v = std::max(column / (kTableSize - 1.0), kNDotVMin);
        const double loss = diffuse_loss(n_dot_v);
        for (unsigned row = 0; row < kTableSize; ++row) {
            const glm::dvec2 shares = specular_shares(n_dot_v, row / (kTableSize - 1.0));
            const std::size_t place = 3 * (std::size_t{row} * kTableSize + column);
            table[place] = static_cast<float>(shares.x);
            table[place + 1] = static_cast<float>(shares.y);
            table[place + 2] = static_cast<float>(loss);
        }
    });
    return table;
}

}  // namespace

Environment shrunk(const Environment& from, int width) {
    if (from.width <= width) return from;
    if (from.height % 2 != 0) return shrunk(resampled(from, from.height / 2), width);
    Environment out{from.width / 2, from.height / 2, {}};
    out.rows.reserve(from.rows.size() / 4);
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            glm::dvec3 sum(0.0);
            for (int i = 0; i < 4; ++i) sum += from.light(2 * x + i % 2, 2 * y + i / 2);
            out.rows.emplace_back(sum /
                                  (2.0 * (from.solid_angle(2 * y) + from.solid_angle(2 * y + 1))));
        }
    }
    return shrunk(out, width);
}

PrefilteredEnvironment prefiltered(const Environment& environment) {
    PrefilteredEnvironment out;
    const Environment finest = shrunk(environment, kLevels[0].source_width);
    for (const LevelPlan& plan : kLevels) append(out, filtered(finest, plan));
    append(out, filtered(finest, kIrradiance));
    out.table = reflectance_table();
    out.table_size = kTableSize;
    return out;
}

}  // namespace kilolux
