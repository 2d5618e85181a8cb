// SPDX-License-Identifier: Apache-2.0
// Lights a G-buffer of its own, a floor that runs to the horizon, with 2000 lights, in a context
// and queue of its own, and writes the picture: light_gbuffer PICTURE.ppm
#include <kilolux/kilolux.h>

#include <cmath>
#include <cstdio>
#include <fstream>

using namespace kilolux;

constexpr uint kWidth = 640, kHeight = 360;  // [pixel]
constexpr uint kStride = 640;                // a multiple of 16
constexpr uint kLights = 2000;
constexpr float kNear = 0.1f;         // [m]
constexpr float kEyeHeight = 1.5f;    // [m]
constexpr float kPixel = 1.0f / 360;  // of the image plane at distance 1

// At the origin, looking along -Z; 1/z = depth01 / near, as reversed infinite projections have it.
View make_view() {
    View view{};
    view.ray = {kPixel, -0.5f * kWidth * kPixel, -kPixel, 0.5f * kHeight * kPixel};
    view.depth = {1.0f / kNear, 0.0f, 0.0f, 0.0f};
    view.width = kWidth, view.height = kHeight, view.stride = kStride;
    view.view_from_world_x.x = view.view_from_world_y.y = view.view_from_world_z.z = 1.0f;
    return view;
}

std::vector<std::byte> draw_floor(const GBufferLayout& layout, const View& view) {
    std::vector<std::byte> bytes(gbuffer_bytes(layout, kStride, kHeight));
    const auto plane = [&](uint p) {
        return reinterpret_cast<uint*>(&bytes[layout.offset_bytes[p]]);
    };
    const FV3 up = octahedral_encode(fv3(0.0f, 1.0f, 0.0f));
    const auto unorm16 = [](float v) {
        return static_cast<uint>(std::lround((v * 0.5f + 0.5f) * 65535.0f));
    };
    for (uint y = kHeight / 2; y < kHeight; ++y) {
        const float z = kEyeHeight / -(view.ray.z * (static_cast<float>(y) + 0.5f) + view.ray.w);
        for (uint i = y * kStride; i < y * kStride + kWidth; ++i) {
            plane(KILOLUX_PLANE_DEPTH)[i] = float_bits(kNear / z);
            plane(KILOLUX_PLANE_NORMAL)[i] = unorm16(up.x) | unorm16(up.y) << 16;
            plane(KILOLUX_PLANE_ALBEDO)[i] = 0x80c8c8c8;  // roughness 128, sRGB 200
        }
    }
    return bytes;
}

std::vector<Light> make_lights() {  // relative to the camera
    std::vector<Light> lights;
    for (uint i = 0; i < kLights; ++i) {
        const float x = static_cast<float>(i % 50) - 24.5f, z = -2.0f - static_cast<float>(i / 50);
        const float red = 0.3f * static_cast<float>(i % 3),
                    blue = 0.3f * static_cast<float>(i % 7 == 0);
        lights.push_back(
            {{x, -kEyeHeight + 0.3f, z, 1.5f}, {red, 0.1f, blue, 1.0f}, {0, 0, 0, -1}});
    }
    return lights;
}

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: light_gbuffer PICTURE.ppm");
    const cl::Context context(choose_device(""));  // or the ones that the program has
    const cl::CommandQueue queue(context, cl::QueueProperties::Profiling);
    const Gpu gpu(context, queue);
    const View view = make_view();
    const GBufferLayout layout = make_gbuffer_layout({}, kStride, kHeight);
    std::vector<std::byte> floor = draw_floor(layout, view);
    std::vector<Light> rows = make_lights();
    const GBuffer gbuffer{cl::Buffer(context, CL_MEM_COPY_HOST_PTR, floor.size(), floor.data()),
                          layout, view};
    const LightInput input{
        cl::Buffer(context, CL_MEM_COPY_HOST_PTR, kLights * sizeof(Light), rows.data()), kLights};
    KernelFeatures features;
    features.shading = KILOLUX_SHADING_PBR;
    const Tuning tuning = known_tuning(gpu.info).tuning;
    const ClusterGrid grid = make_cluster_grid({.z_first = 1.0f, .z_last = 50.0f}, kWidth, kHeight);
    StageTimer timer;
    DeferredLighting lighting(gpu, tuning, features);
    const Radiance radiance = lighting.light({gbuffer, input, grid}, timer);
    Tonemap tonemap(gpu, tuning, KILOLUX_TONE_CURVE_NEUTRAL);
    const std::vector<uint> pixels = download(gpu, tonemap.enqueue(radiance, 0.0f, timer));
    std::ofstream file(argv[1], std::ios::binary);
    file << "P6 " << kWidth << " " << kHeight << " 255\n";
    for (const uint pixel : pixels) file.write(reinterpret_cast<const char*>(&pixel), 3);
    if (!file.flush()) throw Error(std::string(argv[1]) + ": cannot be written");
    for (const StageTimer::Time& stage : timer.take())
        std::printf("%-16s %8.3f ms\n", stage.stage.c_str(), stage.ms);
} catch (const std::exception& error) {
    std::fprintf(stderr, "light_gbuffer: %s\n", error.what());
    return 1;
}
