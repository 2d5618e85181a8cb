// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/tuning/tuning_store.h"

#include <bit>

#include "host/gpu/tuning/device_cache.h"
#include "host/gpu/tuning/shipped_tunings.h"
#include "kernels/shared/cluster_grid.h"

namespace kilolux {
namespace {

constexpr CacheKind kKind = {"tuning", 7};  // 7: shade_stage with any shade_rows, pbr_lanes

constexpr TuningParameter kParameters[] = {
    {"shade_rows", &Tuning::shade_rows},
    {"shade_stage", &Tuning::shade_stage},
    {"pbr_lanes", &Tuning::pbr_lanes},
    {"cull_group", &Tuning::cull_group},
    {"cull_chunks", &Tuning::cull_chunks},
    {"refine_group", &Tuning::refine_group},
    {"prefix_group", &Tuning::prefix_group},
    {"prefix_per_item", &Tuning::prefix_per_item},
    {"tile_group", &Tuning::tile_group},
    {"light_group", &Tuning::light_group},
    {"shade_prefetch", &Tuning::shade_prefetch},
    {"raster_group", &Tuning::raster_group},
    {"raster_tile_width", &Tuning::raster_tile_width},
    {"raster_tile_height", &Tuning::raster_tile_height},
    {"raster_lanes", &Tuning::raster_lanes},
    {"shadow_group", &Tuning::shadow_group},
    {"geometry", &Tuning::geometry},
};

// Bounded by the local memory that every device has (CL_DEVICE_LOCAL_MEM_SIZE >= 32 KiB): 512 * 52
// bytes.
constexpr int kMostStaged = 512;

bool is_power_of_two(int value) {
    return value > 0 && std::has_single_bit(static_cast<uint>(value));
}

// A value of an entry as an int; -1, which nothing accepts, if it is missing or none.
int int_of(const CacheValues& values, std::string_view key) {
    const auto found = values.find(key);
    if (found == values.end() || !(found->second >= 0.0 && found->second <= 1e9)) return -1;
    const int value = static_cast<int>(found->second);
    return value == found->second ? value : -1;
}

}  // namespace

std::span<const TuningParameter> tuning_parameters() { return kParameters; }

bool is_valid(const StoredTuning& stored, const DeviceInfo& device) {
    const Tuning& t = stored.tuning;
    const int largest_group = device.max_work_group;
    const auto is_group = [&](int group) {
        return is_power_of_two(group) && group <= largest_group;
    };
    if (!is_power_of_two(stored.lanes) || stored.lanes > FINE_TILE) return false;
    if (!is_power_of_two(t.shade_rows) || t.shade_rows > FINE_TILE) return false;
    if (FINE_TILE / stored.lanes * t.shade_rows > largest_group) return false;
    if (t.shade_stage != 0 && (!is_power_of_two(t.shade_stage) || t.shade_stage > kMostStaged))
        return false;
    if (t.pbr_lanes != 0 && (!is_power_of_two(t.pbr_lanes) || t.pbr_lanes > FINE_TILE))
        return false;
    if (t.shade_prefetch != 0 && t.shade_prefetch != 1) return false;
    if (t.geometry != 0 && t.geometry != 1) return false;
    constexpr int kMostTile = 128;
    for (const int edge : {t.raster_tile_width, t.raster_tile_height}) {
        if (!is_power_of_two(edge) || edge < FINE_TILE || edge > kMostTile) return false;
    }
    constexpr int kMostRasterGroup = 256;  // its items are numbered in bytes
    const bool by_group = t.raster_group >= 32 && t.raster_group <= kMostRasterGroup &&
                          t.raster_group <= t.raster_tile_width * t.raster_tile_height;
    if (!is_group(t.raster_group) || (t.raster_group > 1 && !by_group)) return false;
    const bool shares_shadows = t.shadow_group >= 32 && t.shadow_group <= FINE_TILE_PIXELS;
    if (!is_group(t.shadow_group) || (t.shadow_group > 1 && !shares_shadows)) return false;
    if (!is_power_of_two(t.raster_lanes) || t.raster_lanes > FINE_TILE) return false;
    if (t.cull_chunks < 1 || t.cull_chunks > 65536 || t.prefix_per_item < 1) return false;
    constexpr int kMostInTile = 256;  // their local memory is below 32 KiB
    if (t.refine_group > kMostInTile || t.tile_group > kMostInTile) return false;
    return is_group(t.cull_group) && is_group(t.refine_group) && is_group(t.prefix_group) &&
           is_group(t.tile_group) && is_group(t.light_group);
}

StoredTuning built_in_tuning(const DeviceInfo& device) {
    return {device.lane_width, default_tuning(device)};
}

std::optional<StoredTuning> stored_tuning(const DeviceInfo& device) {
    const auto values = read_device_cache(device, kKind);
    if (!values) return std::nullopt;
    StoredTuning stored;
    stored.lanes = int_of(*values, "lanes");
    for (const TuningParameter& field : kParameters)
        stored.tuning.*field.value = int_of(*values, field.name);
    if (!is_valid(stored, device)) return std::nullopt;
    return stored;
}

KnownTuning known_tuning(const DeviceInfo& device) {
    if (const auto forced = forced_tuning(device))
        return {*forced, TuningSource::shipped_for_device};
    if (const auto stored = stored_tuning(device)) return {*stored, TuningSource::measured};
    const StoredTuning built_in = built_in_tuning(device);
    if (const auto shipped = shipped_tuning(device, shipped_tunings())) {
        if (is_valid(shipped->tuning, device)) {
            return {shipped->tuning, shipped->same_device ? TuningSource::shipped_for_device
                                                          : TuningSource::shipped_for_class};
        }
    }
    return {built_in, TuningSource::built_in};
}

std::string text_of(TuningSource source) {
    constexpr const char* kTexts[] = {"measured here", "shipped for this device",
                                      "shipped for its class", "built in"};
    return kTexts[static_cast<int>(source)];
}

void store_tuning(const DeviceInfo& device, const StoredTuning& stored) {
    CacheValues values = {{"lanes", stored.lanes}};
    for (const TuningParameter& field : kParameters)
        values.emplace(field.name, stored.tuning.*field.value);
    write_device_cache(device, kKind, values);
}

}  // namespace kilolux
