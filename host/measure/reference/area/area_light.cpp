// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/area/area_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "host/scene/lights/light_shape.h"

namespace kilolux {
namespace {

using glm::dvec3;

constexpr std::size_t kCells = 20'000;
// Longest side of a cell as a share of its distance: Gauss's rule of 6 points is then exact to
// 1e-12.
constexpr double kLargestCell = 0.4;

// A piece of a flat shape as the image of a rectangle of (u, v).
struct Patch {
    // A triangle: corner + u x + (1 - u) v y, as much as (1 - u) |x x y|.
    // A segment of an ellipse: corner + sin(u) x + cos(u) v y, as much as cos(u)^2 |x x y|.
    bool round = false;
    dvec3 corner{0.0}, x{0.0}, y{0.0};
    double u0 = 0.0, u1 = 1.0, v0 = 0.0;  // v ends at 1

    dvec3 point(double u, double v) const {
        if (round) return corner + std::sin(u) * x + std::cos(u) * v * y;
        return corner + u * x + (1.0 - u) * v * y;
    }
    double density(double u) const { return round ? std::cos(u) * std::cos(u) : 1.0 - u; }
};

struct QuadratureCell {
    std::size_t patch = 0;
    double u0 = 0.0, u1 = 0.0, v0 = 0.0, v1 = 0.0;
    dvec3 value{0.0};
    double size = 0.0, error = 0.0;  // of the integral of the absolute value; of value
    bool operator<(const QuadratureCell& other) const { return error < other.error; }
};

struct Rule {
    std::vector<double> nodes, weights;  // on [-1, 1]
};

// Gauss-Legendre: roots of the Legendre polynomial by Newton's method.
Rule gauss(int n) {
    Rule rule;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
        double slope = 0.0;
        for (int pass = 0; pass < 50; ++pass) {
            double value = 1.0, before = 0.0;
            for (int k = 1; k <= n; ++k)
                before = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * before) / k);
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        rule.nodes.push_back(x);
        rule.weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
    }
    return rule;
}

double largest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

class Integrator {
 public:
    Integrator(std::vector<Patch> patches, const AreaIntegrand& integrand)
        : patches_(std::move(patches)), integrand_(integrand) {}

    AreaIntegral integrate(double tolerance) {
        for (std::size_t i = 0; i < patches_.size(); ++i)
            add({i, patches_[i].u0, patches_[i].u1, patches_[i].v0, 1.0});
        while (!cells_.empty() && cells_.size() < kCells && error_ > tolerance * size_) {
            const QuadratureCell worst = cells_.top();
            cells_.pop();
            error_ -= worst.error;
            size_ -= worst.size;
            split(worst, true);
            split(worst, false);
        }
        return sum();
    }

 private:
    AreaIntegral sum() {
        AreaIntegral result;
        double size = 0.0;
        for (; !cells_.empty(); cells_.pop()) {
            result.value += cells_.top().value;
            result.error += cells_.top().error;
            size += cells_.top().size;
        }
        result.error += 1e-14 * size;
        return result;
    }

    void split(QuadratureCell cell, bool first) {
        const Patch& patch = patches_[cell.patch];
        const auto sides = lengths(cell, patch);
        double& low = sides[0] > sides[1] ? cell.u0 : cell.v0;
        double& high = sides[0] > sides[1] ? cell.u1 : cell.v1;
        (first ? high : low) = std::midpoint(low, high);
        add(cell);
    }

    static std::array<double, 2> lengths(const QuadratureCell& cell, const Patch& patch) {
        const double u = std::midpoint(cell.u0, cell.u1), v = std::midpoint(cell.v0, cell.v1);
        const auto between = [&](double ua, double va, double ub, double vb) {
            return glm::distance(patch.point(ua, va), patch.point(ub, vb));
        };
        return {between(cell.u0, v, u, v) + between(u, v, cell.u1, v),
                std::max(between(u, cell.v0, u, cell.v1),
                         std::max(between(cell.u0, cell.v0, cell.u0, cell.v1),
                                  between(cell.u1, cell.v0, cell.u1, cell.v1)))};
    }

    // Small cells are evaluated, others split.
    void add(QuadratureCell cell) {
        const Patch& patch = patches_[cell.patch];
        const auto sides = lengths(cell, patch);
        const dvec3 middle =
            patch.point(std::midpoint(cell.u0, cell.u1), std::midpoint(cell.v0, cell.v1));
        if (std::max(sides[0], sides[1]) > kLargestCell * glm::length(middle)) {
            // If the surface point lies in the light's plane, splitting would never stop.
            if (std::max(cell.u1 - cell.u0, cell.v1 - cell.v0) < 1e-12) return;
            split(cell, true);
            split(cell, false);
            return;
        }
        static const Rule kLow = gauss(6), kHigh = gauss(8);
        double unused = 0.0;
        const dvec3 low = apply(kLow, cell, patch, unused);
        cell.value = apply(kHigh, cell, patch, cell.size);
        cell.error = largest(cell.value - low);
        size_ += cell.size;
        error_ += cell.error;
        cells_.push(cell);
    }

    dvec3 apply(const Rule& rule, const QuadratureCell& cell, const Patch& patch,
                double& size) const {
        const double half_u = 0.5 * (cell.u1 - cell.u0), half_v = 0.5 * (cell.v1 - cell.v0);
        const double u = std::midpoint(cell.u0, cell.u1), v = std::midpoint(cell.v0, cell.v1);
        // The distance of the plane times the area of (x, y), the same for all its points.
        const double volume = std::abs(glm::dot(patch.corner, glm::cross(patch.x, patch.y)));
        dvec3 sum{0.0};
        size = 0.0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double at = u + half_u * rule.nodes[i];
            for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
                const dvec3 p = patch.point(at, v + half_v * rule.nodes[k]);
                const double r = glm::length(p);
                const dvec3 add = integrand_(p / r) * (rule.weights[i] * rule.weights[k] *
                                                       patch.density(at) * volume / (r * r * r));
                sum += add;
                size += largest(add);
            }
        }
        size *= half_u * half_v;
        return sum * (half_u * half_v);
    }

    std::vector<Patch> patches_;
    const AreaIntegrand& integrand_;
    std::priority_queue<QuadratureCell> cells_;
    double size_ = 0.0, error_ = 0.0;
};

// A sphere fills the directions of the disk on which its tangents from the origin end.
std::optional<AreaShape> flat_shape(AreaShape shape) {
    if (shape.kind == AreaKind::sphere) {
        const double distance = glm::length(shape.center);
        if (distance <= shape.radius) return std::nullopt;
        const dvec3 axis = shape.center / distance;
        const dvec3 other = std::abs(axis.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const double free = (distance - shape.radius) * (distance + shape.radius);
        const dvec3 x = glm::normalize(glm::cross(axis, other));
        const double radius = shape.radius * std::sqrt(free) / distance;
        shape.kind = AreaKind::disk;
        shape.center = axis * (free / distance);
        shape.half_x = radius * x;
        shape.half_y = radius * glm::cross(axis, x);
        shape.two_sided = true;
    }
    const double faced = glm::dot(shape.center, glm::cross(shape.half_x, shape.half_y));
    if (shape.two_sided ? faced == 0.0 : !(faced < 0.0)) return std::nullopt;
    return shape;
}

std::vector<Patch> ellipse_patches(const AreaShape& shape, const std::optional<dvec3>& normal) {
    Patch patch{true,
                shape.center,
                shape.half_x,
                shape.half_y,
                -std::numbers::pi / 2.0,
                std::numbers::pi / 2.0,
                -1.0};
    if (!normal) return {patch};
    const double height = glm::dot(*normal, shape.center);
    const double x = glm::dot(*normal, shape.half_x), y = glm::dot(*normal, shape.half_y);
    const double reach = std::hypot(x, y);
    if (height >= reach) return {patch};
    if (height <= -reach) return {};
    // Conjugate half axes of the same ellipse: the second is parallel to the horizon.
    patch.x = (shape.half_x * x + shape.half_y * y) / reach;
    patch.y = (shape.half_y * x - shape.half_x * y) / reach;
    patch.u0 = std::asin(-height / reach);
    return {patch};
}

std::vector<dvec3> cut_corners(const std::vector<dvec3>& corners, const dvec3& normal) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const dvec3& p = corners[i];
        const dvec3& q = corners[(i + 1) % corners.size()];
        const double from = glm::dot(p, normal), to = glm::dot(q, normal);
        if (from >= 0.0) kept.push_back(p);
        if ((from >= 0.0) != (to >= 0.0)) kept.push_back(p + (q - p) * (from / (from - to)));
    }
    return kept;
}

std::vector<Patch> polygon_patches(const AreaShape& shape, const std::optional<dvec3>& normal) {
    const dvec3 &c = shape.center, &x = shape.half_x, &y = shape.half_y;
    std::vector<dvec3> corners{c - x - y, c + x - y, c + x + y, c - x + y};
    if (shape.kind == AreaKind::triangle) {
        const auto of_triangle = corners_of(c, {x, y});
        corners.assign(of_triangle.begin(), of_triangle.end());
    }
    if (normal) corners = cut_corners(corners, *normal);
    std::vector<Patch> patches;
    for (std::size_t i = 2; i < corners.size(); ++i)
        patches.push_back(
            {false, corners[0], corners[i - 1] - corners[0], corners[i] - corners[0]});
    return patches;
}

AreaIntegral integrate(const AreaShape& given, const std::optional<dvec3>& normal,
                       const AreaIntegrand& integrand, double tolerance) {
    const std::optional<AreaShape> shape = flat_shape(given);
    if (!shape) return {};
    return Integrator(shape->kind == AreaKind::disk ? ellipse_patches(*shape, normal)
                                                    : polygon_patches(*shape, normal),
                      integrand)
        .integrate(tolerance);
}

}  // namespace

AreaIntegral integrate_area(const AreaShape& shape, const AreaIntegrand& integrand,
                            double tolerance) {
    return integrate(shape, std::nullopt, integrand, tolerance);
}

AreaIntegral integrate_area(const AreaShape& shape, const glm::dvec3& normal,
                            const AreaIntegrand& integrand, double tolerance) {
    return integrate(shape, normal, integrand, tolerance);
}

AreaCosine reference_cosine(const AreaShape& shape, const glm::dvec3& normal) {
    const AreaIntegral integral = integrate_area(shape, normal, [&](const dvec3& to_light) {
        return dvec3(std::max(glm::dot(to_light, normal), 0.0));
    });
    return {integral.value.x, integral.error};
}

}  // namespace kilolux
