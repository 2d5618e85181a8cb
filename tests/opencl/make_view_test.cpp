// SPDX-License-Identifier: Apache-2.0
#include "host/base/make_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/support/messages.h"

namespace kilolux {
namespace {

using Vector = std::array<double, 4>;

Vector operator*(const Matrix4& m, const Vector& v) {
    Vector out{};
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column)
            out[row] += m[4 * column + row] * v[column];
    }
    return out;
}

// A projection by its planes; far may be infinite.
struct Lens {
    bool perspective, left, reversed, minus_one, infinite;
    double shift_x = 0.0, shift_y = 0.0;  // off-centre [ndc]
};

std::string name(const Lens& l) {
    return std::string(l.perspective ? "perspective" : "orthographic") +
           (l.left ? " left" : " right") + (l.reversed ? " reversed" : " standard") +
           (l.minus_one ? " -1..1" : " 0..1") + (l.infinite ? " infinite" : " finite");
}

constexpr double kNear = 0.25, kFar = 40.0;

// Depth 0 ... 1 or -1 ... 1 is a * (1/z or z) + b between the planes.
Matrix4 projection(const Lens& l) {
    const double forward = l.left ? 1.0 : -1.0;
    const double far = l.infinite ? std::numeric_limits<double>::infinity() : kFar;
    const double q_near = l.perspective ? 1.0 / kNear : kNear,
                 q_far = l.perspective ? 1.0 / far : far;
    const double low = l.minus_one ? -1.0 : 0.0;
    const double at_near = l.reversed ? 1.0 : low, at_far = l.reversed ? low : 1.0;
    const double a = (at_near - at_far) / (q_near - q_far), b = at_near - a * q_near;
    Matrix4 m{};
    m[0] = 1.3;
    m[5] = 1.9;
    if (l.perspective) {
        m[8] = l.shift_x * forward;
        m[9] = l.shift_y * forward;
        m[10] = b * forward;
        m[11] = forward;
        m[14] = a;
    } else {
        m[10] = a * forward;
        m[12] = l.shift_x;
        m[13] = l.shift_y;
        m[14] = b;
        m[15] = 1.0;
    }
    return m;
}

// A rotation about a skew axis, mirrored for left hands, from a camera at (1, 2, 3).
Matrix4 view_matrix(bool left) {
    const double c = 0.6, s = 0.8, z = left ? -1.0 : 1.0;
    Matrix4 m = {c, 0.0, s * z, 0.0, 0.0, 1.0, 0.0, 0.0, -s, 0.0, c * z, 0.0, 0.0, 0.0, 0.0, 1.0};
    const Vector moved = m * Vector{1.0, 2.0, 3.0, 0.0};
    for (std::size_t i = 0; i < 3; ++i) m[12 + i] = -moved[i];
    return m;
}

// A world point through the matrices to pixel and depth buffer, and back by the View.
void expect_round_trip(const Lens& lens, const Vector& world) {
    const ViewMatrices matrices{view_matrix(lens.left),
                                projection(lens),
                                640,
                                360,
                                lens.minus_one ? NdcDepth::minus_one_to_one : NdcDepth::zero_to_one,
                                lens.left ? ViewHand::left : ViewHand::right};
    const MatrixView made = make_view(matrices);
    const Vector clip = matrices.projection * (matrices.view * world);
    const double px = (clip[0] / clip[3] + 1.0) / 2.0 * 640.0;
    const double py = (1.0 - clip[1] / clip[3]) / 2.0 * 360.0;
    const double ndc = clip[2] / clip[3], d = lens.minus_one ? (ndc + 1.0) / 2.0 : ndc;
    ASSERT_TRUE(d > -1e-9 && d < 1.0 + 1e-9) << d;
    EXPECT_EQ(made.invert_depth, !lens.reversed);
    const double stored = made.invert_depth ? 1.0 - d : d;
    const View& v = made.view;
    const FV x = static_cast<float>(px), y = static_cast<float>(py);
    const FV z = view_depth(v, x, y, static_cast<float>(stored));
    const FV3 p = view_position(v, x, y, z);
    const auto along = [&](const float4& row) {
        return row.x * (world[0] - made.camera[0]) + row.y * (world[1] - made.camera[1]) +
               row.z * (world[2] - made.camera[2]);
    };
    const double tolerance = 2e-4 * std::abs(z);  // float32 of depth and coefficients
    EXPECT_NEAR(p.x, along(v.view_from_world_x), tolerance);
    EXPECT_NEAR(p.y, along(v.view_from_world_y), tolerance);
    EXPECT_NEAR(p.z, along(v.view_from_world_z), tolerance);
    EXPECT_LT(p.z, 0.0f);
}

TEST(MakeView, FindsThePointsThatTheMatricesDrew) {
    for (int bits = 0; bits < 32; ++bits) {
        const auto bit = [bits](int i) { return (bits >> i & 1) != 0; };
        const Lens lens{bit(0), bit(1), bit(2), bit(3), bit(4), 0.2, -0.1};
        if (!lens.perspective && lens.infinite) continue;
        SCOPED_TRACE(name(lens));
        // In front of the camera at (1, 2, 3), which looks along (-0.8, 0, -0.6).
        for (const Vector& world :
             {Vector{-0.6, 2.3, 1.9, 1.0}, {-7.0, 1.0, -3.5, 1.0}, {0.7, 2.0, 2.8, 1.0}}) {
            expect_round_trip(lens, world);
        }
        const MatrixView made =
            make_view(ViewMatrices{view_matrix(lens.left), projection(lens), 640, 360, {}, {}});
        EXPECT_NEAR(made.camera[0], 1.0, 1e-12);
        EXPECT_NEAR(made.camera[1], 2.0, 1e-12);
        EXPECT_NEAR(made.camera[2], 3.0, 1e-12);
    }
}

TEST(MakeView, BackgroundIsZero) {
    for (const bool reversed : {false, true}) {
        const MatrixView made = make_view(
            {view_matrix(false), projection({true, false, reversed, false, true}), 64, 32, {}, {}});
        EXPECT_EQ(made.view.depth.w, 0.0f) << "depth 0 is infinitely far away";
        EXPECT_FLOAT_EQ(made.view.depth.x, 1.0f / kNear);
        EXPECT_EQ(made.view.stride, 64u);
    }
}

TEST(MakeView, RefusesWhatIsNoCamera) {
    const Matrix4 view = view_matrix(false), lens = projection({true, false, true, false, true});
    const auto refusal = [](const Matrix4& v, const Matrix4& p) {
        return message_of<Error>([&] { make_view(ViewMatrices{v, p, 64, 32, {}, {}}); });
    };
    Matrix4 scaled = view;
    for (double& value : scaled) value *= 2.0;
    EXPECT_TRUE(contains(refusal(scaled, lens), "the view matrix scales or shears"));
    Matrix4 oblique = lens;
    oblique[2] = 0.1;
    EXPECT_EQ(refusal(view, oblique),
              "make_view: projection element (2, 0) is 0.100000, must be 0");
    EXPECT_TRUE(contains(refusal(view, Matrix4{}), "singular"));
    Matrix4 flat = lens;
    flat[5] = 0.0;
    EXPECT_TRUE(contains(refusal(view, flat), "singular"));
    Matrix4 flipped = lens;
    flipped[5] = -1.5;
    EXPECT_TRUE(contains(refusal(view, flipped), "element (1, 1) is -1.500000, must be > 0"));
    for (std::size_t i = 0; i < 16; ++i) {  // also elements that no check adds up
        Matrix4 bad_view = view, bad_lens = lens;
        bad_view[i] = bad_lens[i] = std::nan("");
        const std::string where =
            "element (" + std::to_string(i % 4) + ", " + std::to_string(i / 4) + ") is ";
        EXPECT_TRUE(contains(refusal(bad_view, lens), "make_view: view " + where));
        EXPECT_TRUE(contains(refusal(view, bad_lens), "make_view: projection " + where));
    }
    EXPECT_EQ(message_of<Error>([&] {
                  make_view(ViewMatrices{view, lens, 64, 0, {}, {}});
              }),
              "make_view: a picture of 64x0 pixels");
}

}  // namespace
}  // namespace kilolux
