// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/gpu/kernel.h"
#include "host/gpu/stage_info.h"

namespace kilolux {

inline constexpr StageInfo kReflectEnvironmentStage = {"reflect_environment", StageGroup::picture};

/// Maps by which an environment lights surfaces, on the host.
struct ReflectionMapsView {
    std::span<const float> texels;  // RGB of all levels
    std::span<const uint4> levels;  // width, height, first texel: roughness from 0 to 1 in equal
                                    // steps, then irradiance / pi
    std::span<const float> table;   // [size][size][3]
    uint table_size = 0;

    std::size_t bytes() const {
        return texels.size_bytes() + levels.size_bytes() + table.size_bytes();
    }
};

/// The same on the device.
struct ReflectionBuffers {
    DeviceArray<float> texels;
    DeviceArray<uint4> levels;
    uint roughness_levels = 0;  // from 0 to 1
    DeviceArray<float> table;
    uint table_size = 0;

    void each(auto&& set) const {  // REFLECTION_ARGS
        set("texels", texels);
        set("levels", levels);
        set("roughness_levels", roughness_levels);
        set("table", table);
        set("table_size", table_size);
    }
};

/// Adds an environment's diffuse and specular light to lit surfaces.
class ReflectEnvironment {
 public:
    ReflectEnvironment(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features);

    /// Blocks.
    void set_maps(const ReflectionMapsView& maps);

    /// Adds to `radiance` where the G-buffer has surfaces. Enqueues only.
    void enqueue(const GBuffer& gbuffer, const Radiance& radiance, StageTimer& timer);

 private:
    Gpu gpu_;
    Tuning tuning_;
    Kernel kernel_;
    GrowingArray<float> texels_, table_;
    GrowingArray<uint4> levels_;
    ReflectionBuffers maps_;
};

}  // namespace kilolux
