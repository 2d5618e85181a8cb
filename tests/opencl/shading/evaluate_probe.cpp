// SPDX-License-Identifier: Apache-2.0
#include "tests/opencl/shading/evaluate_probe.h"

#include "host/certify/synthetic/run_probe.h"
#include "host/gpu/buffer.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

constexpr std::string_view kEvaluateHeaders[] = {"kernels/device/lanes.h",
                                                 "kernels/shared/evaluate.h"};
constexpr std::string_view kEvaluateProbe = R"(
kernel void probe(global const float* in, uint count, global const ShadeLight* lights, uint light_count,
                  global const DirectionalLight* directional, uint directional_count, float ambient,
                  uint orthographic, global float* out) {
    uint i = get_global_id(0) * VW;
#define VALUE(row) lane_load(in + (row) * count + i)
    Surface s;
    s.position = fv3(VALUE(0), VALUE(1), VALUE(2));
    s.normal = fv3(VALUE(3), VALUE(4), VALUE(5));
    s.albedo = fv3(VALUE(6), VALUE(7), VALUE(8));
    s.emissive = fv3(VALUE(9), VALUE(10), VALUE(11));
    s.roughness = VALUE(12);
    s.metallic = VALUE(13);
    s.occlusion = VALUE(14);
#if HAS_SPECULAR
    s.specular = fv3(VALUE(15), VALUE(16), VALUE(17));
    s.specular_f90 = VALUE(18);
#endif
#if HAS_CLEARCOAT
    s.coat = VALUE(19);
    s.coat_roughness = VALUE(20);
    s.coat_normal = fv3(VALUE(21), VALUE(22), VALUE(23));
#endif
#if HAS_SHEEN
    s.sheen = fv3(VALUE(24), VALUE(25), VALUE(26));
    s.sheen_roughness = VALUE(27);
#endif
#if HAS_ANISOTROPY
    s.tangent = fv3(VALUE(28), VALUE(29), VALUE(30));
    s.anisotropy = VALUE(31);
#endif
    ShadingPoint p = make_shading_point(s, orthographic != 0);
    LightSum sum = zero_sum();
    for (uint k = 0; k < directional_count; ++k) sum = evaluate_directional(sum, p, directional[k]);
    for (uint first = 0; first < light_count; first += 1u << SUM_BLOCK_LOG2) {
        LightSum block = zero_sum();
        for (uint k = first; k < min(first + (1u << SUM_BLOCK_LOG2), light_count); ++k) block = evaluate(block, p, lights[k]);
        sum = add_sums(sum, block);
    }
    FV3 color = finish_shading(s, p, sum, ambient);
    lane_store(color.x, out + i);
    lane_store(color.y, out + count + i);
    lane_store(color.z, out + 2 * count + i);
}
)";
constexpr std::string_view kPowProbe = R"(
kernel void probe(global const float* cos2, global const float* sin2, global const float* n,
                  global float* out) {
    uint i = get_global_id(0) * VW;
    FV unit = fv(4.0f);
    lane_store(pow_of_cos2(unit * lane_load(cos2 + i), unit * lane_load(sin2 + i), unit,
                            lane_load(n + i)),
                out + i);
}
)";

std::vector<float> rows_of(const SurfaceD& s) {
    const double values[] = {s.position.x,     s.position.y,    s.position.z,    s.normal.x,
                             s.normal.y,       s.normal.z,      s.albedo.x,      s.albedo.y,
                             s.albedo.z,       s.emissive.x,    s.emissive.y,    s.emissive.z,
                             s.roughness,      s.metallic,      s.occlusion,     s.specular.x,
                             s.specular.y,     s.specular.z,    s.specular_f90,  s.coat,
                             s.coat_roughness, s.coat_normal.x, s.coat_normal.y, s.coat_normal.z,
                             s.sheen.x,        s.sheen.y,       s.sheen.z,       s.sheen_roughness,
                             s.tangent.x,      s.tangent.y,     s.tangent.z,     s.anisotropy};
    std::vector<float> rows;
    for (const double value : values) rows.push_back(static_cast<float>(value));
    return rows;
}

SurfaceD surface_of(const std::vector<float>& r) {
    return {{r[0], r[1], r[2]},
            {r[3], r[4], r[5]},
            {r[6], r[7], r[8]},
            {r[9], r[10], r[11]},
            r[12],
            r[13],
            r[14],
            {r[15], r[16], r[17]},
            r[18],
            r[19],
            r[20],
            {r[21], r[22], r[23]},
            {r[24], r[25], r[26]},
            r[27],
            {r[28], r[29], r[30]},
            r[31]};
}

template <typename T>
std::vector<T> copy_of(std::span<const T> values) {
    return {values.begin(), values.end()};
}

}  // namespace

ProbeResult probe_evaluate(const std::vector<SurfaceD>& surfaces, const Lighting& lighting,
                           int lanes) {
    const Gpu gpu = test_gpu(lanes);
    const std::size_t count = round_up(surfaces.size(), 16);
    ProbeResult result;
    std::vector<float> in(32 * count, 0.5f);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const std::vector<float> rows = rows_of(surfaces[i]);
        for (std::size_t row = 0; row < rows.size(); ++row) in[row * count + i] = rows[row];
        result.surfaces.push_back(surface_of(rows));
    }
    const BuildOptions options = BuildOptions()
                                     .define("SHADING", lighting.shading)
                                     .define("HAS_METALLIC", 1)
                                     .define("HAS_SPECULAR", 1)
                                     .define("HAS_CLEARCOAT", lighting.clearcoat ? 1 : 0)
                                     .define("HAS_SHEEN", lighting.sheen ? 1 : 0)
                                     .define("HAS_ANISOTROPY", lighting.anisotropy ? 1 : 0)
                                     .define("HAS_SPOT_LIGHTS", 1);
    const auto found =
        run_probe<float>(gpu, {kEvaluateHeaders, kEvaluateProbe, options}, count / lanes_of(gpu),
                         3 * count, in, static_cast<uint>(count), copy_of(lighting.lights),
                         static_cast<uint>(lighting.lights.size()), copy_of(lighting.directional),
                         static_cast<uint>(lighting.directional.size()),
                         static_cast<float>(lighting.ambient), lighting.orthographic ? 1u : 0u);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        result.radiance.push_back({found[i], found[count + i], found[2 * count + i]});
    }
    return result;
}

std::vector<float> probe_pow_of_cos2(const std::vector<float>& sin2, const std::vector<float>& n,
                                     int lanes) {
    const Gpu gpu = test_gpu(lanes);
    const std::size_t count = round_up(sin2.size(), 16);
    std::vector<float> padded_sin2 = sin2;
    std::vector<float> padded_n = n;
    padded_sin2.resize(count, 0.0f);
    padded_n.resize(count, 0.0f);
    std::vector<float> cos2;
    cos2.reserve(count);
    for (const float s : padded_sin2) cos2.push_back(static_cast<float>(1.0 - double{s}));
    auto powers = run_probe<float>(gpu, {kEvaluateHeaders, kPowProbe}, count / lanes_of(gpu), count,
                                   cos2, padded_sin2, padded_n);
    powers.resize(sin2.size());
    return powers;
}

}  // namespace kilolux
