// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What a setting of a report changes against the one asked for.
enum class SettingAxis {
    none,
    gbuffer,
    geometry,
    lanes,
    math,
    grid,
    renderer,
    shading,
    shadows,
    cut_off
};

/// Whether the settings of an axis are compared with R2, since they keep the lights' ranges, and
/// with R3: the cut-offs and the default.
constexpr bool keeps_ranges(SettingAxis axis) { return axis != SettingAxis::cut_off; }
constexpr bool compares_cut_offs(SettingAxis axis) {
    return axis == SettingAxis::cut_off || axis == SettingAxis::none;
}

/// "default" for none, else as --axes takes it.
const char* axis_name(SettingAxis axis);
/// All but "default".
std::vector<std::string> setting_axis_names();

/// One way to render the picture that was asked for, faster or more exactly.
struct ReportSetting {
    SettingAxis axis = SettingAxis::none;
    std::string name;     // "gbuffer half"; unique in a report
    std::string options;  // of the command line; empty for the one asked for
    RenderSettings settings;
};

/// The values of axes that report_settings() goes through.
struct SettingChoice {
    bool quick = false;  // fewer grids, lanes and cut-offs, and not `forward`
    // Of sampled shadows; none: 1, 4 and 16, and with lights that have a size the powers of two
    // up to 32.
    std::vector<int> shadow_rays{};
};

/// The setting asked for, "default", and then every one that differs from it in one axis.
/// Where it asks for shadows, the other settings cast them, too, but for the axis of shadows.
/// Forward renderers are left out then, since they cast none.
///
/// A cut-off is a radiance on a white surface from which range_of_light() derives the range of the
/// generated lights and of those whose file gives none.
std::vector<ReportSetting> report_settings(const Scene& scene, const RenderSettings& base,
                                           const DeviceInfo& device, const SettingChoice& choice);

/// The radiance on a white surface at which the generated lights are cut off (range_of_light());
/// without them that of the lights whose file gives no range; 0 where none is.
double cut_off_of(const Scene& scene, const RenderSettings& settings);

}  // namespace kilolux
