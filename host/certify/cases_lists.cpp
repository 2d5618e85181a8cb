// SPDX-License-Identifier: Apache-2.0
// Lists: long ones, none, wide indices, and the same ones on every run.
#include <algorithm>
#include <array>
#include <set>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "host/gpu/buffer.h"
#include "host/render/renderer.h"
#include "host/render/scene_plan.h"
#include "host/stages/prefix_sum.h"
#include "host/stages/shade.h"

namespace kilolux {
namespace {

Shot one_cluster_shot(uint light_count) {
    ViewShape shape{5, 1};
    Shot shot = noise_shot(shape, noise_depth(2.0, 2.05, 0, 1));
    shot.features.light_index_bits = light_count <= 65536 ? 16 : 32;
    shot.request = {1, 1, 1, 1.0f, 1.0f, 0.0f};
    shot.request.fine_per_octave = 1;
    Random random(16);
    for (uint i = 0; i < light_count; ++i) {
        shot.lights.push_back(
            point_light(random.point(3.0), 100.0, Vec3d{random.unit(), random.unit(), 1}));
    }
    return shot;
}

void check_full_list(Findings& findings, const Exposure& e, uint light_count) {
    std::uint64_t wrong = e.lists.clusters.size() == 1 ? 0 : 1;
    for (const ActiveCluster& c : e.lists.clusters) {
        const auto list = e.lists.refined_of(c);
        wrong += list.size() == light_count ? 0 : 1;
        for (uint i = 0; i < list.size(); ++i) wrong += list[i] == i ? 0 : 1;
    }
    findings.none("entries missing or out of order", wrong, light_count,
                  std::to_string(light_count) + " lights");
}

// A part of the device with one compute unit, as a machine with one thread would be; none if the
// device cannot be divided.
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
    // One reference is never given back: PoCL 3.1 frees a part of a device with the last handle to
    // it, while a worker thread may still have to release the last event of the part's queue.
    clRetainDevice(parts.front()());
    gpus.emplace_back(parts.front(), gpu.info.lane_width);
    return gpus;
}

// Lists and picture of `runs` runs.
void add_pictures(std::set<std::string>& pictures, const Gpu& gpu, const Shot& shot,
                  const Tuning& tuning, int runs) {
    const View& view = shot.image.view;
    const ClusterGrid grid = make_cluster_grid(shot.request, view.width, view.height);
    const GBuffer gbuffer = upload_gbuffer(gpu, shot.image);
    const LightInput lights = upload_lights(gpu, shot.lights);
    StageRun stages(gpu, tuning, shot.features);
    Shade shade(gpu, tuning, shot.features);
    for (int run = 0; run < runs; ++run) {
        const DeviceLists lists = stages.run(lights, gbuffer, grid);
        StageTimer timer;
        const Radiance radiance =
            shade.enqueue(gbuffer, lists.lights, grid, lists.clusters, lists.refined, timer);
        const auto values =
            download<float>(gpu, radiance.planes, std::size_t{3} * view.stride * view.height);
        std::string text = fingerprint(download_lists(gpu, shot.features, grid, lists));
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

// Refined lists are parts of their coarse lists: what depth noise can cost is bounded by those.
std::uint64_t longer_than_coarse(const Shot& shot, const Exposure& e) {
    const View& view = shot.image.view;
    const uint tiles_x = (view.width + FINE_TILE - 1) / FINE_TILE;
    std::uint64_t longer = 0;
    for (uint tile = 0; tile + 1 < e.lists.cluster_offsets.size(); ++tile) {
        for (uint i = e.lists.cluster_offsets[tile]; i < e.lists.cluster_offsets[tile + 1]; ++i) {
            const ActiveCluster& c = e.lists.clusters[i];
            const uint coarse = cluster_index(
                e.grid, tile % tiles_x * FINE_TILE / e.grid.tile_width,
                tile / tiles_x * FINE_TILE / e.grid.tile_height, c.slice >> e.grid.fine_slice_bits);
            longer += c.list_count > e.lists.coarse_of(coarse).size() ? 1 : 0;
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

void check_nothing(Findings& findings, const Gpu& gpu, const Shot& shot) {
    const Exposure e = expose(gpu, shot);
    check_none_missing(findings, shot, e);
    check_exact(findings, shot, e);
    std::uint64_t lit = 0;
    for (const float v : e.listed) lit += v != 0.0f ? 1 : 0;
    findings.none("pixels not black", lit, e.listed.size());
}

}  // namespace

void try_long_lists(const Gpu& gpu, Findings& findings) {
    for (const uint count : {1u, 255u, 256u, 257u, 65535u, 65536u, 100000u}) {
        const Shot shot = one_cluster_shot(count);
        const Exposure exposure = expose(gpu, shot);
        check_full_list(findings, exposure, count);
        check_exact(findings, shot, exposure);
    }
}

void try_repeated_runs(const Gpu& gpu, Findings& findings) {
    ViewShape shape{49, 33};
    Shot shot = noise_shot(shape, noise_depth(0.3, 60.0, 0.1, 4));
    LightMix mix;
    mix.count = 1500;
    shot.lights = random_lights(shot.image.view, mix);
    std::set<std::string> pictures;
    std::uint64_t runs = 0;
    const std::vector<Gpu> gpus = gpus_by_threads(gpu);
    for (const Gpu& threads : gpus) {
        for (const Tuning& tuning : local_sizes(gpu)) {
            add_pictures(pictures, threads, shot, tuning, 20);
            runs += 20;
        }
    }
    findings.none("lists and pictures beside the first", pictures.size() - 1, runs);
    findings.report("thread counts tried", static_cast<double>(gpus.size()));
}

void try_depth_noise(const Gpu& gpu, Findings& findings) {
    ViewShape shape{97, 65};
    LightMix mix;
    mix.count = 1500;
    uint most = 0;
    for (const DepthOf& depth : {noise_depth(0.3, 60.0, 0.1, 4), checkerboard_depth(0.4, 55.0)}) {
        Shot shot = noise_shot(shape, depth);
        shot.lights = random_lights(shot.image.view, mix);
        const Exposure e = expose(gpu, shot);
        findings.tried("pairs that reach", check_none_missing(findings, shot, e), 1000);
        check_exact(findings, shot, e);
        findings.none("lists longer than their coarse lists", longer_than_coarse(shot, e),
                      e.lists.clusters.size());
        most = std::max(most, most_slices_in_a_tile(e.lists));
    }
    findings.report("most slices in a tile", most);
    findings.tried("slices in a tile", most, 9);
}

void try_nothing(const Gpu& gpu, Findings& findings) {
    const ViewShape shape{33, 17};
    const DepthOf depth = noise_depth(0.5, 20.0, 0.1, 4);
    Shot shot = noise_shot(shape, depth);
    check_nothing(findings, gpu, shot);  // no light
    shot.lights = {point_light({0, 0, 1e6}, 10.0)};
    check_nothing(findings, gpu, shot);  // one, out of reach
    shot.lights.assign(100, point_light({1e4, 0, 0}, 1.0));
    check_nothing(findings, gpu, shot);  // all beside the picture
    shot.lights.assign(100, point_light({0, 0, 0}, 100.0));
    shot.image = make_synthetic(make_view(shape), {}, no_depth());
    check_nothing(findings, gpu, shot);  // all background, no active cluster
    shot.lights.clear();
    check_nothing(findings, gpu, shot);  // and no light either
    RenderSettings settings;
    settings.width = 33;
    settings.height = 17;
    settings.lights.count = 0;
    settings.kernels.lanes = gpu.info.lane_width;
    settings.device = gpu.info.name;
    const Scene empty;
    const Frame frame = Renderer(empty, settings).render(frame_box(bounds(empty)), 0.0);
    std::uint64_t lit = 0;
    for (const float v : frame.radiance) lit += v != 0.0f ? 1 : 0;
    findings.none("an empty scene's pixels not black", lit, frame.radiance.size());
}

void try_wide_indices(const Gpu& gpu, Findings& findings) {
    const Scene scene;
    const auto bits = [&](std::uint64_t lights) {
        return make_scene_plan(scene, {}, lights).kernels.light_index_bits;
    };
    findings.require(
        "16-bit indices up to 65536 lights, 32 beyond",
        bits(65535) == 16 && bits(65536) == 16 && bits(65537) == 32 && bits(70000) == 32);
    Shot shot = noise_shot({17, 9}, noise_depth(0.5, 20.0, 0, 4));
    shot.features.light_index_bits = bits(70000);
    LightMix mix;
    mix.count = 70000;
    mix.range_max = 0.5;
    mix.z_far = 20.0;
    shot.lights = random_lights(shot.image.view, mix);
    check_lists(findings, gpu, shot);
    // Offsets are 32 bits: 2^31 entries fit, 2^32 do not, and more than the device has is refused.
    findings.require("2^31 entries fit 32-bit offsets",
                     checked_list_size(std::uint64_t{1} << 31, "lists") == 0x80000000u);
    const std::string too_many =
        error_of([] { checked_list_size(std::uint64_t{1} << 32, "lists"); });
    findings.require("2^32 entries are an error with the number",
                     too_many.find("4294967296") != std::string::npos, too_many);
    GrowingBuffer buffer(gpu, "lists");
    const std::string no_room = error_of([&] { buffer.reserve(std::size_t{1} << 46); });
    findings.require("no memory is an error with the need",
                     no_room.find("67108864 MiB") != std::string::npos, no_room);
}

}  // namespace kilolux
