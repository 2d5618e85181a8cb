// SPDX-License-Identifier: Apache-2.0
// Prints the rows of kernels/shared/area/ggx_fit.h: the program `fit_ggx`, built on demand.
//
// At each node (roughness, n.v) the transform of a cosine lobe that is nearest to the GGX lobe is
// searched (Nelder and Mead). Then polynomials are fitted to the transforms, each error weighted by
// the second derivative of lobe_distance(), and to the albedos.
#include <array>
#include <cstdio>
#include <functional>
#include <vector>

#include "tests/measure/area/fit/ggx_lobe.h"

namespace kilolux {
namespace {

constexpr double kSpread2 = 8.0;  // GGX_SPREAD2

// Logarithm of along, tilt and logarithm of across, relative to those of a narrow lobe.
using Parameters = std::array<double, 3>;

struct Node {
    RoundLobe lobe;
    double roughness, spread;  // spread: sqrt(n.v^2 + kSpread2 alpha^2)
    LobeAlbedo albedo;
    Parameters best;
    double distance;
    double curvature[3][3];
};

TransformedCosine transform_of(const Node& node, const Parameters& p) {
    const double half = 0.5 / node.lobe.alpha, spread = node.spread;
    return {spread * spread * half * std::exp(p[0]), spread * half * p[1], half * std::exp(p[2])};
}

double distance_of(const Node& node, const Parameters& p, int steps) {
    return lobe_distance(node.lobe, transform_of(node, p), node.albedo.all, steps);
}

struct Vertex {
    double value;
    Parameters at;
};

Parameters along_line(const Parameters& from, const Parameters& to, double t) {
    Parameters p;
    for (int k = 0; k < 3; ++k) p[k] = from[k] + t * (to[k] - from[k]);
    return p;
}

// The simplex method of Nelder and Mead 1965.
Vertex minimum(const Parameters& start, double step,
               const std::function<double(const Parameters&)>& f) {
    std::array<Vertex, 4> s;
    for (int i = 0; i < 4; ++i) {
        s[i].at = start;
        if (i > 0) s[i].at[i - 1] += step;
        s[i].value = f(s[i].at);
    }
    const auto less = [](const Vertex& a, const Vertex& b) { return a.value < b.value; };
    for (int round = 0; round < 200; ++round) {
        std::sort(s.begin(), s.end(), less);
        if (s[3].value - s[0].value < 1e-9) break;
        Parameters middle{};
        for (int k = 0; k < 3; ++k) middle[k] = (s[0].at[k] + s[1].at[k] + s[2].at[k]) / 3.0;
        const auto tried = [&](double t) {
            const Parameters p = along_line(middle, s[3].at, t);
            return Vertex{f(p), p};
        };
        Vertex next = tried(-1.0);
        if (next.value < s[0].value) next = std::min(next, tried(-2.0), less);
        if (next.value >= s[2].value) next = tried(0.5);
        if (next.value < s[3].value) {
            s[3] = next;
            continue;
        }
        for (int i = 1; i < 4; ++i) {
            s[i].at = along_line(s[0].at, s[i].at, 0.5);
            s[i].value = f(s[i].at);
        }
    }
    return *std::min_element(s.begin(), s.end(), less);
}

void set_curvature(Node& node) {
    constexpr double kStep = 0.05;
    const auto at = [&](int a, double x, int b, double y) {
        Parameters p = node.best;
        p[a] += kStep * x;
        p[b] += kStep * y;
        return distance_of(node, p, 64);
    };
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
            const double change =
                a == b
                    ? at(a, 1, b, 0) - 2.0 * node.distance + at(a, -1, b, 0)
                    : (at(a, 1, b, 1) - at(a, 1, b, -1) - at(a, -1, b, 1) + at(a, -1, b, -1)) / 4.0;
            node.curvature[a][b] = change / (kStep * kStep);
        }
    }
}

Node make_node(double roughness, double n_dot_v, const std::vector<Parameters>& neighbours) {
    Node node;
    node.roughness = roughness;
    node.lobe = {roughness * roughness, n_dot_v};
    node.spread = std::sqrt(n_dot_v * n_dot_v + kSpread2 * std::pow(roughness, 4));
    node.albedo = albedo_of(node.lobe, 300);
    std::vector<Parameters> starts = neighbours;
    starts.push_back({0.0, std::sqrt(1.0 - n_dot_v * n_dot_v), 0.0});  // of narrow lobes
    Vertex best{1e9, {}};
    for (const Parameters& start : starts) {
        const Vertex found =
            minimum(start, 0.1, [&](const Parameters& p) { return distance_of(node, p, 24); });
        if (found.value < best.value) best = found;
    }
    best = minimum(best.at, 0.03, [&](const Parameters& p) { return distance_of(node, p, 64); });
    if (n_dot_v == 1.0) best.at[1] = 0.0;
    node.best = best.at;
    node.distance = distance_of(node, node.best, 64);
    set_curvature(node);
    return node;
}

// Nodes crowd at grazing angles and narrow lobes, where the transforms change most.
std::vector<Node> make_nodes() {
    std::vector<Node> nodes, above;
    for (const double roughness : {1.0, 0.91, 0.82, 0.73, 0.64, 0.56, 0.48, 0.41, 0.34, 0.28, 0.22,
                                   0.17, 0.13, 0.1, 0.08, 0.06, 0.045}) {
        std::vector<Node> row;
        for (const double n_dot_v :
             {1.0,  0.98, 0.93, 0.85, 0.75, 0.64,  0.53,  0.43,  0.34,  0.26,
              0.19, 0.13, 0.09, 0.06, 0.04, 0.025, 0.015, 0.008, 0.003, 1e-4}) {
            std::vector<Parameters> neighbours;
            if (!row.empty()) neighbours.push_back(row.back().best);
            if (!above.empty()) neighbours.push_back(above[row.size()].best);
            row.push_back(make_node(roughness, n_dot_v, neighbours));
        }
        nodes.insert(nodes.end(), row.begin(), row.end());
        above = row;
        std::fprintf(stderr, "roughness %g\n", roughness);
    }
    return nodes;
}

// Normal equations of a least-squares fit.
class LeastSquares {
 public:
    explicit LeastSquares(std::size_t size) : rows_(size, std::vector<double>(size + 1, 0.0)) {}

    void add(std::size_t i, std::size_t j, double product) { rows_[i][j] += product; }
    void add_right(std::size_t i, double product) { rows_[i].back() += product; }

    // Gauss-Jordan elimination with pivots.
    std::vector<double> solution() {
        const std::size_t n = rows_.size();
        for (std::size_t i = 0; i < n; ++i) rows_[i][i] *= 1.0 + 1e-12;
        for (std::size_t i = 0; i < n; ++i) {
            std::size_t pivot = i;
            for (std::size_t j = i; j < n; ++j) {
                if (std::abs(rows_[j][i]) > std::abs(rows_[pivot][i])) pivot = j;
            }
            std::swap(rows_[i], rows_[pivot]);
            for (std::size_t j = 0; j < n; ++j) {
                if (j == i) continue;
                const double factor = rows_[j][i] / rows_[i][i];
                for (std::size_t k = i; k <= n; ++k) rows_[j][k] -= factor * rows_[i][k];
            }
        }
        std::vector<double> x(n);
        for (std::size_t i = 0; i < n; ++i) x[i] = rows_[i].back() / rows_[i][i];
        return x;
    }

 private:
    std::vector<std::vector<double>> rows_;
};

// Terms of GGX_FIT: (1 - x^2) x^i t^j, x = n.v / spread, t the roughness or alpha.
struct Basis {
    int x_powers;
    bool of_alpha;

    std::vector<double> at(const Node& node) const {
        const double x = node.lobe.n_dot_v / node.spread;
        const double t = of_alpha ? node.lobe.alpha : node.roughness;
        std::vector<double> terms;
        for (int i = 0; i < x_powers; ++i) {
            for (int j = 0; j < 4; ++j) {
                terms.push_back((1.0 - x * x) * std::pow(x, i) * std::pow(t, j));
            }
        }
        return terms;
    }
};

// Highest power of x first.
void print_rows(const char* name, const Basis& basis, const double* values) {
    std::printf("#define GGX_FIT_%s(POWER)", name);
    for (int i = basis.x_powers - 1; i >= 0; --i) {
        const double* v = values + 4 * i;
        std::printf(" \\\n    POWER(%.9gf, %.9gf, %.9gf, %.9gf)", v[0], v[1], v[2], v[3]);
    }
    std::printf("\n");
}

// Factors of along, tilt and across of narrow lobes, together: their errors add up.
void fit_transforms(const std::vector<Node>& nodes) {
    const Basis basis{4, false};
    const std::size_t n = basis.at(nodes[0]).size();
    LeastSquares squares(3 * n);
    for (const Node& node : nodes) {
        const double sine = std::sqrt(1.0 - node.lobe.n_dot_v * node.lobe.n_dot_v);
        // Error of parameter a: offset[a] + slope[a] * polynomial.
        const double slope[3] = {std::exp(-node.best[0]), sine, std::exp(-node.best[2])};
        const double offset[3] = {slope[0] - 1.0, sine - node.best[1], slope[2] - 1.0};
        const std::vector<double> terms = basis.at(node);
        const double trust = 1.0 / (1.0 + 10.0 * node.distance);
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
                const double weight = node.curvature[a][b] * trust + (a == b ? 0.05 : 0.0);
                for (std::size_t i = 0; i < n; ++i) {
                    const double left = weight * slope[a] * terms[i];
                    for (std::size_t j = 0; j < n; ++j) {
                        squares.add(a * n + i, b * n + j, left * slope[b] * terms[j]);
                    }
                    squares.add_right(a * n + i, -left * offset[b]);
                }
            }
        }
    }
    const std::vector<double> found = squares.solution();
    print_rows("ALONG", basis, &found[0]);
    print_rows("TILT", basis, &found[n]);
    print_rows("ACROSS", basis, &found[2 * n]);
}

// A factor whose error at a node is offset + slope * polynomial.
void fit_factor(const char* name, const std::vector<Node>& nodes, const Basis& basis,
                const std::function<std::array<double, 2>(const Node&)>& slope_offset) {
    const std::size_t n = basis.at(nodes[0]).size();
    LeastSquares squares(n);
    for (const Node& node : nodes) {
        const auto [slope, offset] = slope_offset(node);
        const std::vector<double> terms = basis.at(node);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j)
                squares.add(i, j, slope * slope * terms[i] * terms[j]);
            squares.add_right(i, -slope * terms[i] * offset);
        }
    }
    print_rows(name, basis, squares.solution().data());
}

void fit_all() {
    const std::vector<Node> nodes = make_nodes();
    fit_transforms(nodes);
    fit_factor("ALBEDO", nodes, {5, true}, [](const Node& node) -> std::array<double, 2> {
        return {1.0 / node.albedo.all, 1.0 / node.albedo.all - 1.0};
    });
    // The cosine v.h whose Schlick term is the mean over the lobe, over the spread. 0.3: so that
    // cosines without influence stay near.
    fit_factor("HALF", nodes, {4, false}, [](const Node& node) -> std::array<double, 2> {
        const double mean = std::max(node.albedo.rise / node.albedo.all, 1e-12);
        const double cosine = 1.0 - std::pow(mean, 0.2);
        const double weight = (5.0 * std::pow(1.0 - cosine, 4) + 0.3) * node.spread;
        return {weight, weight * (1.0 - cosine / node.spread)};
    });
}

}  // namespace
}  // namespace kilolux

int main() { kilolux::fit_all(); }
