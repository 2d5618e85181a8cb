// SPDX-License-Identifier: Apache-2.0
// Layers beside a picture's colour (arbitrary output variables).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/picture/decoded_surfaces.h"
#include "host/scene/camera.h"
#include "host/scene/lights/light_groups.h"

namespace kilolux {

/// A row of the table of AOVs.
struct AovKind {
    std::string name;                   // as `--aov` takes it
    std::vector<std::string> channels;  // of an EXR file
    std::string meaning;                // for --help, with the unit
    /// The layer's values or ids at every pixel. The surfaces have what it shows: check_settings()
    /// refuses settings that do not make it.
    void (*fill)(const DecodedSurfaces& surfaces, const Camera& camera, Layer& layer);
    /// The largest id that a picture lit by `lights` may have; null: any.
    std::uint64_t (*most_id)(const DecodedSurfaces& surfaces, std::uint64_t lights) = nullptr;
};
const std::vector<AovKind>& aov_kinds();

/// Most channels of an AOV.
std::size_t most_aov_channels();

/// One AOV. Throws UsageError for an unknown name.
Layer make_aov(std::string_view name, const DecodedSurfaces& surfaces, const Camera& camera);

/// The same of a strip of a picture lit by `lights`, with Layer::most_id.
Layer make_aov_of_strip(std::string_view name, const DecodedSurfaces& surfaces,
                        const Camera& camera, std::uint64_t lights);

/// The names of layers of groups' light begin so.
inline constexpr std::string_view kLightLayers = "light.";

/// The light of each group. A last layer is the picture minus all groups, so all layers add up to
/// the picture but for one rounding; it may be a little below 0, and NaN where the light is
/// infinite.
std::vector<Layer> make_light_layers(const DecodedSurfaces& surfaces,
                                     const std::vector<LightGroup>& groups);

}  // namespace kilolux
