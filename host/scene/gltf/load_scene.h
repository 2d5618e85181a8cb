// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace kilolux {

/// How wide points and lines are drawn.
struct LineWidth {
    double value = 0.002;  // of the scene's diagonal
    bool metres = false;   // `value` is in metres instead
    bool operator==(const LineWidth&) const = default;
};

struct LoadOptions {
    double time = 0.0;                 // [s] at which the file's animations are evaluated
    bool allow_outside_paths = false;  // URIs and links may leave the scene file's folder
    /// Bytes that the JSON, buffers, decoded images and decoded meshes may take together; 0: half
    /// of what is available. What a decoder needs meanwhile comes on top.
    std::uint64_t max_memory_bytes = 0;
    /// Animations that play, by name or index, or "all" or "none"; empty: the file's first.
    std::vector<std::string> clips{};
    std::string variant{};  // of KHR_materials_variants, by name or index; empty: the default
    bool strict = false;    // throw where the picture would lack something of the file
    LineWidth line_width{};
    double light_size = 0.0;  // radius of points without one [m]: they become spheres
    bool operator==(const LoadOptions&) const = default;
};

/// Receives how many of a file's images are decoded, which takes most of the loading time: first 0,
/// then after each. Never called by two threads at once.
using LoadProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Reads a glTF 2.0 file (.gltf or .glb) with its buffers and images.
///
/// Instances hold world transforms; meshes are triangle lists with normals, and tangents where a
/// normal map needs them. Throws Error with file, place and value seen for anything that is broken,
/// and for required extensions that it does not know. Warns of all other extensions that are left
/// out.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace kilolux
