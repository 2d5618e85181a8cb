// SPDX-License-Identifier: Apache-2.0
// A View from the matrices that other renderers have.
#pragma once

#include <array>

#include "kernels/shared/view.h"

namespace kilolux {

/// Column vectors, column by column, as GLM, OpenGL and glTF store them: element (row, column) is
/// m[4 * column + row]. Row-major matrices of row vectors (DirectX) are the same numbers.
using Matrix4 = std::array<double, 16>;

/// Which depths normalised device coordinates have: Direct3D, Vulkan, Metal and glClipControl, or
/// OpenGL's own.
enum class NdcDepth { zero_to_one, minus_one_to_one };

/// Where a camera looks in its view space: a perspective projection says so itself.
enum class ViewHand { right, left };  // down -Z, down +Z

/// What a renderer draws with. Normalised +Y is up and row 0 of the picture on top: Vulkan's
/// projection before its flip of Y.
struct ViewMatrices {
    Matrix4 view;        // view space from world: rotation and translation, no scale
    Matrix4 projection;  // clip space from view; perspective or orthographic, reversed or not,
                         // finite or infinite, off-centre or jittered
    uint width = 0;      // of the picture [pixel]
    uint height = 0;
    NdcDepth depth = NdcDepth::zero_to_one;
    ViewHand orthographic_hand = ViewHand::right;
};

/// A View, and what goes with it.
struct MatrixView {
    View view{};
    std::array<double, 3> camera{};  // world [m]: rows of lights are relative to it
    /// PLANE_DEPTH holds 1 - d in place of the depth buffer's value d, so that nearer is larger and
    /// background is 0. False where depth is reversed: then it holds d.
    bool invert_depth = false;
};

/// Elements below 1e-4 count as 0 where they must be: products of float matrices will do. Throws
/// Error for a view that scales or shears, for a projection that is none of the above or flips Y,
/// and for a picture without pixels.
MatrixView make_view(const ViewMatrices& matrices);

}  // namespace kilolux
