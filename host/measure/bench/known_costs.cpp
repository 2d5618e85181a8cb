// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/known_costs.h"

#include <algorithm>
#include <cstdio>

#include "host/gpu/device_cache.h"

namespace kilolux {
namespace {

constexpr CacheKind kKind{"costs", 1};
constexpr std::size_t kMostValues = 900;  // what a cache entry has room for

// Names the picture by all that its costs depend on: 64 bits of FNV-1a in hexadecimal digits.
std::string picture_key(const Scene& scene, const RenderSettings& s) {
    std::string text = scene.name;
    const auto add = [&text](double value) {
        text += ' ';
        text += std::to_string(value);
    };
    for (const double value :
         {static_cast<double>(triangle_count(scene)), static_cast<double>(scene.lights.size()),
          static_cast<double>(s.lights.count), s.lights.radius, static_cast<double>(s.width),
          static_cast<double>(s.height), static_cast<double>(s.gbuffer),
          static_cast<double>(s.shading), static_cast<double>(s.renderer),
          static_cast<double>(s.kernels.lanes), static_cast<double>(s.grid.tiles_x),
          static_cast<double>(s.grid.tiles_y), static_cast<double>(s.grid.slices_per_octave)}) {
        add(value);
    }
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
    return digits;
}

void read_times(const CacheValues& kept, const std::string& key, FeatureCost& cost) {
    const std::string name = cost.feature + "." + key;
    const auto ms = kept.find(name + ".ms");
    const auto noise = kept.find(name + ".noise");
    const auto percent = kept.find(name + ".percent");
    if (ms == kept.end() || noise == kept.end() || percent == kept.end()) return;
    cost.measured = true;
    cost.ms = ms->second;
    cost.noise_ms = noise->second;
    cost.percent = percent->second;
    cost.why.clear();
}

}  // namespace

std::vector<FeatureCost> known_feature_costs(const DeviceInfo& device, const Scene& scene,
                                             const RenderSettings& settings) {
    const CacheValues kept = read_device_cache(device, kKind).value_or(CacheValues{});
    const std::string key = picture_key(scene, settings);
    const ScenePlan plan =
        make_scene_plan(scene, settings, settings.lights.count + scene.lights.size());
    std::vector<FeatureCost> costs;
    for (const std::string& feature : absent_features(plan)) {
        FeatureCost cost = unmeasured_cost(plan, feature);
        if (is_forceable(feature)) read_times(kept, key, cost);
        costs.push_back(std::move(cost));
    }
    return costs;
}

void keep_feature_costs(const DeviceInfo& device, const Scene& scene,
                        const RenderSettings& settings, const std::vector<FeatureCost>& costs) {
    CacheValues kept = read_device_cache(device, kKind).value_or(CacheValues{});
    if (kept.size() + 3 * costs.size() > kMostValues) kept.clear();
    const std::string key = picture_key(scene, settings);
    for (const FeatureCost& cost : costs) {
        if (!cost.measured) continue;
        const std::string name = cost.feature + "." + key;
        kept[name + ".ms"] = cost.ms;
        kept[name + ".noise"] = cost.noise_ms;
        kept[name + ".percent"] = cost.percent;
    }
    write_device_cache(device, kKind, kept);
}

}  // namespace kilolux
