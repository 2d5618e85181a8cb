// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace kilolux {

/// Makes triangles of a mesh of points (`corners` is 1) or segments (2) whose indices name each
/// one's vertices: an octahedron around a point, a three-sided prism around a segment.
///
/// glTF leaves the width open; OpenGL's is a pixel. A width in the scene instead makes points and
/// lines surfaces like all others: every camera, sample count and band, ray-traced references,
/// shadows, ids and layers see the same thing. Their mean over all views is `width`, in object
/// space: of a prism the width across (a convex outline's is its length / pi), of an octahedron the
/// root of the area (a convex body's is its surface / 4; Cauchy 1832). A prism's own width is
/// within 10 % of the mean. Segments of a strip are not joined.
///
/// Vertices keep their attributes. Those without normals get the solid's, which point outwards.
void make_solids(Mesh& mesh, int corners, double width);

/// Bytes of vertices and indices that a point or a segment becomes, at most.
std::uint64_t solid_bytes();

}  // namespace kilolux
