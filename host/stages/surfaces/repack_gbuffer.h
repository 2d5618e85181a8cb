// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "host/base/make_view.h"
#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kRepackGbufferStage = {"repack_gbuffer", StageGroup::surfaces};

/// The format of a pixel of another renderer's depth buffer: a float, or 24 bits, the lower
/// (Direct3D, Vulkan) or the upper (OpenGL's UNSIGNED_INT_24_8) of 32.
enum class DepthFormat { float32, lower_24, upper_24 };

/// 4x8 bits, (n + 1) / 2, the 4th unused; 2x16 bits, octahedral, (v + 1) / 2; 4 floats, the 4th
/// unused. Of any length but 0.
enum class NormalFormat { rgba8, octahedral16, float4 };

/// 4x8 bits, sRGB; 4 halves, linear Rec. 709. The 4th is the perceptual roughness.
enum class AlbedoFormat { srgb8, half4 };

/// How a G-buffer of another renderer is stored.
struct SourceFormat {
    DepthFormat depth = DepthFormat::float32;
    NormalFormat normal = NormalFormat::rgba8;
    AlbedoFormat albedo = AlbedoFormat::srgb8;
    bool world_normals = true;  // else in view space: x right, y up, z towards the viewer
    /// cl::Image2D in place of buffers: a channel of floats, and channels that read as the formats'
    /// values. Images of depth and stencil need an extension that few drivers have: their callers
    /// copy them to a buffer (clEnqueueCopyImageToBuffer).
    bool images = false;
};

/// A frame of another renderer: rows from the top. The caller owns it; it is read until the queue
/// has passed the repack.
struct SourceGBuffer {
    cl::Memory depth;                  // [height][pitch]
    cl::Memory normal;                 // [height][pitch]
    cl::Memory albedo;                 // [height][pitch]
    uint pitch = 0;                    // of buffers: pixels from a row to the next; 0: the width
    std::optional<float> roughness{};  // of all surfaces; without: the albedo's fourth channel
};

/// A packed G-buffer of another renderer's depth, normals and albedo. The way back is PackRadiance;
/// DecodeGBuffer gives what the packed planes hold as floats.
class RepackGBuffer {
 public:
    RepackGBuffer(const Gpu& gpu, const Tuning& tuning, const SourceFormat& format);

    /// Enqueues only. Throws Error for a source that is too small or has another kind.
    GBuffer enqueue(const SourceGBuffer& source, const MatrixView& view, StageTimer& timer);

 private:
    Tuning tuning_;
    SourceFormat format_;
    Kernel kernel_;
    GrowingArray<std::byte> gbuffer_;
};

}  // namespace kilolux
