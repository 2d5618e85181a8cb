// SPDX-License-Identifier: Apache-2.0
// exact_sign.h against an independent implementation in 128-bit integers.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kSignHeaders[] = {"kernels/surfaces/exact_sign.h"};
constexpr std::string_view kSignProbe = R"(
kernel void probe(global const float* v, global int* out) {
    size_t i = get_global_id(0);
    out[i] = edge_side(fixed_of(vload3(3 * i, v)), fixed_of(vload3(3 * i + 1, v)),
                       fixed_of(vload3(3 * i + 2, v)));
}
)";

using FloatVector = std::array<float, 3>;
using Triple = std::array<FloatVector, 3>;  // a, b, d
using Integer = __int128;

std::vector<int> device_sides(const std::vector<Triple>& triples) {
    const Gpu gpu = test_gpu(1);  // scalars at every width
    std::vector<float> values;
    for (const Triple& t : triples) {
        for (const FloatVector& v : t) values.insert(values.end(), v.begin(), v.end());
    }
    return run_probe<int>(gpu, {kSignHeaders, kSignProbe}, triples.size(), triples.size(), values);
}

int sign(Integer v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

// For whole coordinates below 2^24.
int side_of_integers(const Triple& t) {
    const auto at = [&](std::size_t v, std::size_t axis) {
        return static_cast<Integer>(t.at(v).at(axis));
    };
    const Integer x = at(0, 1) * at(1, 2) - at(0, 2) * at(1, 1);
    const Integer y = at(0, 2) * at(1, 0) - at(0, 0) * at(1, 2);
    const Integer z = at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
    for (const Integer v : {x * at(2, 0) + y * at(2, 1) + z * at(2, 2), x, y}) {
        if (sign(v) != 0) return sign(v);
    }
    return 0;
}

// Whole numbers of up to `bits` bits; every third ray lies on its edge, every seventh edge has no
// length.
std::vector<Triple> integer_triples(int bits, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto number = [&] {
        const auto value = static_cast<float>(random() % (1u << bits));
        return random() % 2 == 0 ? value : -value;
    };
    std::vector<Triple> out;
    for (int i = 0; i < 4000; ++i) {
        Triple t{};
        for (FloatVector& v : t) v = {number(), number(), number()};
        if (i % 3 == 0) {
            for (std::size_t axis = 0; axis < 3; ++axis) t[2][axis] = t[0][axis] + t[1][axis];
        }
        if (i % 5 == 0) t[0][2] = t[1][2] = 0.0f;
        if (i % 7 == 0) t[1] = t[0];
        out.push_back(t);
    }
    return out;
}

TEST(ExactSign, IsThatOfIntegers) {
    for (const int bits : {2, 8, 16, 23}) {
        const std::vector<Triple> triples = integer_triples(bits, static_cast<std::uint32_t>(bits));
        const std::vector<int> sides = device_sides(triples);
        for (std::size_t i = 0; i < triples.size(); ++i) {
            ASSERT_EQ(sides[i], side_of_integers(triples[i])) << bits << " bits, triple " << i;
        }
    }
}

TEST(ExactSign, DoesNotDependOnLengths) {
    const std::vector<Triple> triples = integer_triples(12, 3);
    std::vector<Triple> scaled = triples;
    for (std::size_t i = 0; i < scaled.size(); ++i) {
        for (std::size_t v = 0; v < 3; ++v) {
            const int exponent = static_cast<int>((i + 31 * v) % 200) - 100;
            for (float& c : scaled[i][v]) c = std::ldexp(c, exponent);
        }
    }
    EXPECT_EQ(device_sides(scaled), device_sides(triples));
}

TEST(ExactSign, TurnsWithItsEdge) {
    std::vector<Triple> triples = integer_triples(20, 4);
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    for (Triple& t : triples) {
        for (FloatVector& v : t) {
            for (float& c : v) c *= std::abs(normal(random));
        }
    }
    std::vector<Triple> turned = triples;
    for (Triple& t : turned) std::swap(t[0], t[1]);
    std::vector<int> negated = device_sides(turned);
    for (int& side : negated) side = -side;
    EXPECT_EQ(device_sides(triples), negated);
}

}  // namespace
}  // namespace kilolux
