// SPDX-License-Identifier: Apache-2.0
// Conversions between numpy's arrays and the renderer's types. The Python layer has checked types;
// values and sizes are checked here.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/measure/metrics/rgb_image.h"
#include "host/picture/frame.h"
#include "host/scene/scene.h"

// A list of lights is an object of its own, not a Python list.
PYBIND11_MAKE_OPAQUE(std::vector<kilolux::SceneLight>)

namespace kilolux {

template <typename T>
using Array = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// An array that owns `values`, without a copy.
template <typename T>
pybind11::array_t<T> array_of(std::vector<T> values, std::vector<pybind11::ssize_t> shape) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    const T* first = kept->data();
    pybind11::capsule owner(kept.release(),
                            [](void* p) { delete static_cast<std::vector<T>*>(p); });
    return pybind11::array_t<T>(std::move(shape), first, owner);
}

/// The arrays of a frame by name, views of its memory: "display", "radiance", and "aovs", a dict.
pybind11::dict frame_arrays(const std::shared_ptr<Frame>& frame);

/// A picture of shape (height, width, 3). Throws Error that names `what` for another shape.
RgbImage rgb_image_of(const Array<double>& picture, const std::string& what);

/// Lights of a kind from arrays of `count` rows: "position", "direction" and "side" [count, 3] [m],
/// "intensity" [count, 3] [cd] or [lx], "two_sided" and each of kLightNumbers by its name [count].
std::vector<SceneLight> lights_of(const std::string& kind,
                                  const std::map<std::string, Array<double>>& arrays);

/// A mesh from arrays: positions and normals [n, 3], texcoords [n, 2] or empty, colors [n, 4] or
/// empty, indices [m, 3]. Throws Error for sizes that differ, indices out of range and values that
/// are not finite.
struct MeshArrays {
    std::string name;
    Array<float> positions, normals, texcoords, colors;
    Array<std::int64_t> indices;
};
Mesh mesh_of(const MeshArrays& arrays);

/// An image of shape (height, width, 4).
Image image_of(const std::string& name, const Array<std::uint8_t>& pixels);

}  // namespace kilolux
