// SPDX-License-Identifier: Apache-2.0
// Lists: long, empty, with wide indices, and equal on every run.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/gpu/buffer.h"
#include "host/gpu/memory/list_size.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/renderer.h"

namespace kilolux {
namespace {

LightingCase one_cluster_case(uint light_count) {
    LightingCase input = noise_case({5, 1}, noise_depth(2.0, 2.05, 0, 1));
    input.features.light_index_bits = light_count <= 65536 ? 16 : 32;
    input.request = {1, 1, 1, 1.0f, 1.0f, 0.0f};
    input.request.fine_per_octave = 1;
    Random random(16);
    for (uint i = 0; i < light_count; ++i) {
        input.lights.push_back(
            point_light(random.point(3.0), 100.0, {random.unit(), random.unit(), 1.0}));
    }
    return input;
}

void check_full_list(Findings& findings, const DeviceResult& result, uint light_count) {
    std::uint64_t wrong = result.lists.clusters.size() == 1 ? 0 : 1;
    for (const ActiveCluster& c : result.lists.clusters) {
        const auto list = result.lists.refined_of(c);
        wrong += list.size() == light_count ? 0 : 1;
        for (uint i = 0; i < list.size(); ++i) wrong += list[i] == i ? 0 : 1;
    }
    findings.none("entries missing or out of order", wrong, light_count,
                  fmt::format("{} lights", light_count));
}

// The device, and a part of it with one compute unit, as a machine with one thread. Only the device
// if it cannot be divided.
std::vector<Gpu> gpus_by_threads(const Gpu& gpu) {
    std::vector<Gpu> gpus = {gpu};
    if (!gpu.info.is_cpu || gpu.info.compute_units < 2) return gpus;
    constexpr std::array<cl_device_partition_property, 4> kOneUnit = {
        CL_DEVICE_PARTITION_BY_COUNTS, 1, CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    cl::Device device = gpu.device;
    std::vector<cl::Device> parts;
    try {
        device.createSubDevices(kOneUnit.data(), &parts);
    } catch (const cl::Error&) {
        return gpus;
    }
    if (parts.empty()) return gpus;
    // One reference is kept for ever: PoCL 3.1 frees a sub-device with its last handle, while a
    // worker thread may still have to release the last event of its queue.
    clRetainDevice(parts.front()());
    gpus.emplace_back(parts.front(), gpu.info.lane_width);
    return gpus;
}

// Adds the lists and the picture of each of `runs` runs, as text.
void add_pictures(std::set<std::string>& pictures, const Gpu& gpu, const LightingCase& input,
                  const Tuning& tuning, int runs) {
    const LightingInput uploaded = upload(gpu, input);
    DeferredLighting lighting(gpu, tuning, input.features);
    StageTimer timer;
    for (int run = 0; run < runs; ++run) {
        const std::vector<float> values = download(gpu, lighting.light(uploaded, timer));
        std::string text = fingerprint(download_lists(gpu, input.features, lighting.lists()));
        text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
        pictures.insert(std::move(text));
    }
}

std::vector<Tuning> local_sizes(const Gpu& gpu) {
    std::vector<Tuning> all(3, default_tuning(gpu.info));
    all[1].cull_group = 4;
    all[1].refine_group = 3;
    all[1].shade_rows = 4;
    all[1].tile_group = all[1].light_group = 16;
    all[1].cull_chunks = 3;
    all[2].cull_group = all[2].refine_group = 64;
    all[2].shade_stage = 32;
    all[2].prefix_group = 16;
    all[2].prefix_per_item = 3;
    all[2].cull_chunks = 37;
    return all;
}

uint most_slices_in_a_tile(const HostLists& lists) {
    uint most = 0;
    for (std::size_t t = 0; t + 1 < lists.cluster_offsets.size(); ++t) {
        most = std::max(most, lists.cluster_offsets[t + 1] - lists.cluster_offsets[t]);
    }
    return most;
}

// A refined list is a part of its coarse list, which bounds what depth noise can cost.
std::uint64_t longer_than_coarse(const LightingCase& input, const DeviceResult& result) {
    const uint tiles_x = fine_tiles_x(input.image.view);
    std::uint64_t longer = 0;
    for (uint tile = 0; tile + 1 < result.lists.cluster_offsets.size(); ++tile) {
        for (uint i = result.lists.cluster_offsets[tile];
             i < result.lists.cluster_offsets[tile + 1]; ++i) {
            const ActiveCluster& c = result.lists.clusters[i];
            const uint coarse =
                cluster_index(result.grid, tile % tiles_x * FINE_TILE / result.grid.tile_width,
                              tile / tiles_x * FINE_TILE / result.grid.tile_height,
                              c.slice >> result.grid.fine_slice_bits);
            longer += c.list_count > result.lists.coarse_of(coarse).size() ? 1 : 0;
        }
    }
    return longer;
}

std::string error_of(const std::function<void()>& body) {
    try {
        body();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void check_nothing(Findings& findings, const Gpu& gpu, const LightingCase& input) {
    const DeviceResult result = check_lists(findings, gpu, input, 0);
    findings.none("pixels not black", count_lit(result.listed), result.listed.size());
}

}  // namespace

void try_long_lists(const Gpu& gpu, Findings& findings) {
    for (const uint count : {1u, 255u, 256u, 257u, 65535u, 65536u, 100000u}) {
        const LightingCase input = one_cluster_case(count);
        const DeviceResult result = light_on_device(gpu, input);
        check_full_list(findings, result, count);
        check_exact(findings, input, result);
    }
}

void try_repeated_runs(const Gpu& gpu, Findings& findings) {
    LightingCase input = noise_case({49, 33}, noise_depth(0.3, 60.0, 0.1, 4));
    input.lights = random_lights(input.image.view, {.count = 1500});
    std::set<std::string> pictures;
    std::uint64_t runs = 0;
    const std::vector<Gpu> gpus = gpus_by_threads(gpu);
    for (const Gpu& threads : gpus) {
        for (const Tuning& tuning : local_sizes(gpu)) {
            add_pictures(pictures, threads, input, tuning, 20);
            runs += 20;
        }
    }
    findings.none("lists and pictures beside the first", pictures.size() - 1, runs);
    findings.report("thread counts tried", static_cast<double>(gpus.size()));
}

void try_depth_noise(const Gpu& gpu, Findings& findings) {
    uint most = 0;
    for (const DepthOf& depth : {noise_depth(0.3, 60.0, 0.1, 4), checkerboard_depth(0.4, 55.0)}) {
        LightingCase input = noise_case({97, 65}, depth);
        input.lights = random_lights(input.image.view, {.count = 1500});
        const DeviceResult result = check_lists(findings, gpu, input);
        findings.none("lists longer than their coarse lists", longer_than_coarse(input, result),
                      result.lists.clusters.size());
        most = std::max(most, most_slices_in_a_tile(result.lists));
    }
    findings.report("most slices in a tile", most);
    findings.at_least("slices in a tile", most, 9);
}

void try_nothing(const Gpu& gpu, Findings& findings) {
    const ViewShape shape{33, 17};
    const DepthOf depth = noise_depth(0.5, 20.0, 0.1, 4);
    LightingCase input = noise_case(shape, depth);
    check_nothing(findings, gpu, input);  // no light
    input.lights = {point_light({0, 0, 1e6}, 10.0)};
    check_nothing(findings, gpu, input);  // one, out of reach
    input.lights.assign(100, point_light({1e4, 0, 0}, 1.0));
    check_nothing(findings, gpu, input);  // all beside the picture
    input.lights.assign(100, point_light({0, 0, 0}, 100.0));
    input.image = make_synthetic(make_view(shape), {}, no_depth());
    check_nothing(findings, gpu, input);  // all background, no active cluster
    input.lights.clear();
    check_nothing(findings, gpu, input);  // and no light either
    const Scene empty;
    const Frame frame =
        Renderer(empty, scene_settings(gpu, 33, 17)).render(frame_box(bounds(empty)), 0.0);
    findings.none("an empty scene's pixels not black", count_lit(frame.radiance),
                  frame.radiance.size());
}

void try_wide_indices(const Gpu& gpu, Findings& findings) {
    const Scene scene;
    const auto bits = [&](std::uint64_t lights) {
        return make_scene_plan(scene, {}, lights).kernels.light_index_bits;
    };
    findings.require(
        "16-bit indices up to 65536 lights, 32 beyond",
        bits(65535) == 16 && bits(65536) == 16 && bits(65537) == 32 && bits(70000) == 32);
    LightingCase input = noise_case({17, 9}, noise_depth(0.5, 20.0, 0, 4));
    input.features.light_index_bits = bits(70000);
    input.lights =
        random_lights(input.image.view, {.count = 70000, .z_far = 20.0, .range_max = 0.5});
    check_lists(findings, gpu, input);
    // Offsets are 32 bits: 2^31 entries fit, 2^32 do not, and more than the device has is refused.
    findings.require("2^31 entries fit 32-bit offsets",
                     checked_list_size(std::uint64_t{1} << 31, "lists", "entries") == 0x80000000u);
    const std::string too_many =
        error_of([] { checked_list_size(std::uint64_t{1} << 32, "lists", "entries"); });
    findings.require("2^32 entries are an error with the number",
                     too_many.find("4294967296") != std::string::npos, too_many);
    GrowingBuffer buffer(gpu, "lists");
    const std::string no_room = error_of([&] { buffer.reserve(std::size_t{1} << 46); });
    findings.require("no memory is an error with the need",
                     no_room.find("67108864 MiB") != std::string::npos, no_room);
}

}  // namespace kilolux
