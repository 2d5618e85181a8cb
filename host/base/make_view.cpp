// SPDX-License-Identifier: Apache-2.0
#include "host/base/make_view.h"

#include <cmath>
#include <string>

#include "host/base/error.h"

namespace kilolux {
namespace {

// Allows for the rounding of matrices that were computed in float32.
constexpr double kRounding = 1e-4;

struct Reader {
    const Matrix4& m;
    double operator()(int row, int column) const {
        return m[static_cast<std::size_t>(4 * column + row)];
    }
};

[[noreturn]] void refuse(const std::string& why) { throw Error("make_view: " + why); }

// Finds NaN in elements that are only copied, which no check of a sum would find.
void check_numbers(const ViewMatrices& matrices) {
    const std::string size = std::to_string(matrices.width) + "x" + std::to_string(matrices.height);
    if (matrices.width == 0 || matrices.height == 0) refuse("a picture of " + size + " pixels");
    for (std::size_t i = 0; i < 16; ++i) {
        const auto require_finite = [i](const char* name, double value) {
            if (std::isfinite(value)) return;
            refuse(std::string(name) + " element (" + std::to_string(i % 4) + ", " +
                   std::to_string(i / 4) + ") is " + std::to_string(value) + ", must be finite");
        };
        require_finite("view", matrices.view[i]);
        require_finite("projection", matrices.projection[i]);
    }
}

void check_view(const Reader& view) {
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) {
            double dot = 0.0;
            for (int i = 0; i < 3; ++i) dot += view(a, i) * view(b, i);
            if (std::abs(dot - (a == b ? 1.0 : 0.0)) <= kRounding) continue;
            refuse("the view matrix scales or shears: rows " + std::to_string(a) + " and " +
                   std::to_string(b) + " have the product " + std::to_string(dot));
        }
    }
}

void check_projection(const Reader& p, bool perspective) {
    if (p(3, 2) == 0.0 && p(3, 3) == 0.0) refuse("the projection is singular");
    const auto require_zero = [&p](int row, int column) {
        if (std::abs(p(row, column)) <= kRounding) return;
        refuse("projection element (" + std::to_string(row) + ", " + std::to_string(column) +
               ") is " + std::to_string(p(row, column)) + ", must be 0");
    };
    for (const auto& [row, column] : {std::array{0, 1}, {1, 0}, {2, 0}, {2, 1}, {3, 0}, {3, 1}}) {
        require_zero(row, column);
    }
    if (perspective) {
        for (int row : {0, 1, 3}) require_zero(row, 3);
    } else {
        for (int row : {0, 1}) require_zero(row, 2);
    }
    const double depth = perspective ? p(2, 3) : p(2, 2);
    if (p(0, 0) == 0.0 || p(1, 1) == 0.0 || depth == 0.0) refuse("the projection is singular");
    if (p(1, 1) < 0.0) {
        refuse("projection element (1, 1) is " + std::to_string(p(1, 1)) +
               ", must be > 0: +Y is up, as before Vulkan's flip of Y");
    }
}

// Rows of the rotation; a left-handed view is mirrored to look down -Z.
void set_rotation(MatrixView& out, const Reader& view, double forward) {
    const auto row = [&view](int r, double sign) {
        return float4{static_cast<float>(sign * view(r, 0)), static_cast<float>(sign * view(r, 1)),
                      static_cast<float>(sign * view(r, 2)), 0.0f};
    };
    out.view.view_from_world_x = row(0, 1.0);
    out.view.view_from_world_y = row(1, 1.0);
    out.view.view_from_world_z = row(2, -forward);
    for (int i = 0; i < 3; ++i) {
        double& p = out.camera[static_cast<std::size_t>(i)];
        p = 0.0;
        for (int r = 0; r < 3; ++r) p -= view(r, i) * view(r, 3);
    }
    out.view.camera_position = {static_cast<float>(out.camera[0]),
                                static_cast<float>(out.camera[1]),
                                static_cast<float>(out.camera[2]), 0.0f};
}

}  // namespace

// With z the distance along the view direction, zv = forward * z. Perspective: w = |p32| z, so
// ndc = (p00 x + p02 zv) / w and 1/z = (ndc.z |p32| - p22 forward) / p23; orthographic: w = p33.
// The buffer's value is d = (ndc.z - least) / span, the stored one s = d or 1 - d.
MatrixView make_view(const ViewMatrices& matrices) {
    const Reader view{matrices.view}, p{matrices.projection};
    const bool perspective = std::abs(p(3, 2)) > std::abs(p(3, 3));
    check_numbers(matrices);
    check_view(view);
    check_projection(p, perspective);
    const bool left = perspective ? p(3, 2) > 0.0 : matrices.orthographic_hand == ViewHand::left;
    const double forward = left ? 1.0 : -1.0;
    const double w = perspective ? std::abs(p(3, 2)) : p(3, 3);
    const double offset_x = perspective ? p(0, 2) * forward : p(0, 3);
    const double offset_y = perspective ? p(1, 2) * forward : p(1, 3);
    MatrixView out;
    View& v = out.view;
    v.width = matrices.width;
    v.height = matrices.height;
    v.stride = (v.width + 15u) / 16u * 16u;
    v.orthographic = perspective ? 0u : 1u;
    v.ray = {static_cast<float>(2.0 * w / (matrices.width * p(0, 0))),
             static_cast<float>((-w - offset_x) / p(0, 0)),
             static_cast<float>(-2.0 * w / (matrices.height * p(1, 1))),
             static_cast<float>((w - offset_y) / p(1, 1))};
    const bool unit = matrices.depth == NdcDepth::zero_to_one;
    const double least = unit ? 0.0 : -1.0, span = unit ? 1.0 : 2.0;
    // q = 1/z or z is slope * ndc.z + start.
    const double slope = perspective ? w / p(2, 3) : w * forward / p(2, 2);
    const double start = perspective ? -p(2, 2) * forward / p(2, 3) : -p(2, 3) * forward / p(2, 2);
    const double per_d = slope * span, at_0 = slope * least + start;
    // Nearer is a larger 1/z, a smaller z.
    out.invert_depth = perspective ? per_d < 0.0 : per_d > 0.0;
    v.depth = {static_cast<float>(out.invert_depth ? -per_d : per_d), 0.0f, 0.0f,
               static_cast<float>(out.invert_depth ? at_0 + per_d : at_0)};
    set_rotation(out, view, forward);
    return out;
}

}  // namespace kilolux
