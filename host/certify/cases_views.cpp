// SPDX-License-Identifier: Apache-2.0
// Cameras that are not plain, and pictures of awkward sizes.
#include <algorithm>
#include <array>
#include <bit>

#include "host/certify/cases.h"
#include "host/certify/shot.h"
#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"
#include "host/render/grid_request.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/generated/scenes.h"
#include "host/stages/shade.h"
#include "host/stages/tonemap.h"
#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

constexpr double kUlp = 0x1p-24;  // u: half a unit in the last place of 1
constexpr double kR1Limit = 1e-5;

// --- 6, 7 ---

Camera parallel_camera(double near, double far) {
    Camera camera;
    camera.orthographic = true;
    camera.y_extent = 20.0;
    camera.z_near = near;
    camera.z_far = far;
    return camera;
}

Shot camera_shot(const Camera& camera, const DepthOf& depth, const LightMix& mix) {
    Shot shot;
    const View view = view_of(camera, 97, 65);
    shot.image = make_synthetic(view, {}, depth);
    shot.lights = random_lights(view, mix);
    return shot;
}

// Error of reconstructed positions against the camera's projection in double, relative to the
// distance that they are computed from.
Worst position_error(const Camera& camera, const Shot& shot, const Exposure& exposure) {
    const View& view = shot.image.view;
    const glm::dmat4 clip =
        clip_from_view(camera, static_cast<int>(view.width), static_cast<int>(view.height));
    Worst worst;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            if (!is_drawn(shot, x, y)) continue;
            const Vec3d p = exposure.planes.vector(SURFACE_POSITION, x, y);
            const glm::dvec4 c = clip * glm::dvec4(p.x, p.y, p.z, 1.0);
            const glm::dvec2 pixel((c.x / c.w + 1.0) * 0.5 * view.width,
                                   (1.0 - c.y / c.w) * 0.5 * view.height);
            const double off = std::max(std::abs(pixel.x - (x + 0.5)) / view.width,
                                        std::abs(pixel.y - (y + 0.5)) / view.height);
            worst.see(off, [&] { return at_pixel(x, y); });
        }
    }
    return worst;
}

ViewShape oblique_shape() {
    ViewShape shape{97, 65};
    shape.half_y = shape.half_x * 65 / 97;
    shape.oblique_x = 0.3;
    shape.oblique_y = -0.05;
    return shape;
}

// 1/z is a sum of four terms, each rounded; where they cancel, z loses as many digits. In units of
// 4 u times that condition.
Worst oblique_depth_error(const Shot& shot, const Exposure& exposure, const DepthOf& depth) {
    const View& view = shot.image.view;
    Worst worst;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            if (!is_drawn(shot, x, y)) continue;
            const double z = depth(x, y);
            const double d = depth01_of(view, x, y, z);
            const double terms = std::abs(d * view.depth.x) + std::abs((x + 0.5) * view.depth.y) +
                                 std::abs((y + 0.5) * view.depth.z) + std::abs(view.depth.w);
            const double found = exposure.planes.at(SURFACE_DEPTH, x, y);
            worst.see(std::abs(found / z - 1.0) / (4 * kUlp * std::max(terms * z, 1.0)),
                      [&] { return at_pixel(x, y); });
        }
    }
    return worst;
}

// --- 8 ---

void render_background(const Gpu& gpu, Findings& findings) {
    const Scene scene = make_generated_scene("plain");
    Camera camera = camera_of(scene.cameras.front());
    camera.z_far = std::numeric_limits<double>::infinity();
    // Level, so that the horizon is in the picture.
    const glm::dvec3 ahead = glm::dvec3(1, 0, 1) * -camera.world_from_view[2];
    camera.world_from_view =
        look_at(camera.position, camera.position + ahead, {0, 1, 0}, camera.y_fov).world_from_view;
    RenderSettings settings;
    settings.width = 48;
    settings.height = 32;
    settings.lights.count = 20;
    settings.kernels.lanes = gpu.info.lane_width;
    settings.device = gpu.info.name;
    settings.want.aovs = {"depth", "position", "normal"};
    settings.tone_curve = ToneCurve::none;
    const Frame frame = Renderer(scene, settings).render(camera, 0.0);
    std::uint64_t background = 0;
    std::uint64_t wrong = 0;
    std::uint64_t not_finite = 0;
    for (const Layer& layer : frame.aovs) {
        for (const float v : layer.values) not_finite += std::isfinite(v) ? 0 : 1;
    }
    for (std::size_t i = 0; i < frame.aovs[0].values.size(); ++i) {
        if (frame.aovs[0].values[i] != 0.0f) continue;
        ++background;
        for (std::size_t c = 0; c < 3; ++c) {
            wrong += frame.radiance[3 * i + c] != 0.0f || frame.display[4 * i + c] != 0;
        }
    }
    for (const float v : frame.radiance) not_finite += std::isfinite(v) ? 0 : 1;
    findings.none("NaN or Inf drawn by OpenGL", not_finite, frame.radiance.size());
    findings.none("background not the clear colour", wrong, 3 * background);
    findings.tried("background pixels", background, 100);
    findings.tried("drawn pixels", frame.aovs[0].values.size() - background, 100);
}

// --- 9: what is written past the end of a buffer, or read from there ---

constexpr uint kGuard = 0x7fc12345u;  // a NaN

// A stage's output buffer, made larger by an earlier picture and then filled with the guard.
void fill_guard(const Gpu& gpu, const cl::Buffer& buffer, std::size_t floats) {
    gpu.queue.enqueueFillBuffer(buffer, kGuard, 0, floats * sizeof(float));
}

std::uint64_t guards_in(const std::vector<uint>& words, std::size_t first, std::size_t last) {
    return static_cast<std::uint64_t>(std::count(words.begin() + static_cast<std::ptrdiff_t>(first),
                                                 words.begin() + static_cast<std::ptrdiff_t>(last),
                                                 kGuard));
}

// `written` floats of an output that has room for `room`: all of them and no other.
void check_guards(Findings& findings, const Gpu& gpu, const cl::Buffer& buffer, std::size_t written,
                  std::size_t room) {
    const auto words = download<uint>(gpu, buffer, room);
    findings.none("output not written", guards_in(words, 0, written), written);
    const std::uint64_t after = room - written;
    findings.none("written past the end", after - guards_in(words, written, room), after);
}

// The picture again with NaN all round the G-buffer: nobody may read it.
void check_reads(Findings& findings, const Gpu& gpu, const Shot& shot, const Exposure& exposure) {
    const View& view = shot.image.view;
    constexpr std::size_t kAlign = 4096;  // more than any device's CL_DEVICE_MEM_BASE_ADDR_ALIGN
    const std::size_t bytes = shot.image.bytes.size();
    const std::vector<uint> guards((bytes + 2 * kAlign) / sizeof(uint), kGuard);
    cl::Buffer whole = new_buffer(gpu, guards);
    const cl_buffer_region region{kAlign, bytes};
    GBuffer gbuffer{whole.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region),
                    shot.image.layout, view};
    gpu.queue.enqueueWriteBuffer(gbuffer.bytes, CL_TRUE, 0, bytes, shot.image.bytes.data());
    const Tuning tuning = default_tuning(gpu.info);
    StageRun stages(gpu, tuning, shot.features);
    Shade shade(gpu, tuning, shot.features);
    StageTimer timer;
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    // A taller picture first: its buffers are larger.
    View tall = view;
    tall.height += 64;
    const Synthetic large = make_synthetic(tall, shot.features, no_depth());
    const std::size_t room = std::size_t{3} * tall.stride * tall.height;
    const DeviceLists none = stages.run(upload_lights(gpu, {}), upload_gbuffer(gpu, large),
                                        make_cluster_grid(shot.request, tall.width, tall.height));
    fill_guard(gpu,
               shade
                   .enqueue(upload_gbuffer(gpu, large), none.lights, none.boxes.grid, none.clusters,
                            none.refined, timer)
                   .planes,
               room);
    const DeviceLists lists = stages.run(upload_lights(gpu, shot.lights), gbuffer, exposure.grid);
    const Radiance radiance =
        shade.enqueue(gbuffer, lists.lights, exposure.grid, lists.clusters, lists.refined, timer);
    check_guards(findings, gpu, radiance.planes, size, room);
    findings.at_most("bits changed by what surrounds the buffers",
                     different_bits(download<float>(gpu, radiance.planes, size), exposure.listed),
                     0.0);
    Tonemap tonemap(gpu, tuning, TONE_CURVE_NEUTRAL);
    fill_guard(gpu, tonemap.enqueue({new_buffer(gpu, std::vector<float>(room)), tall}, 0.0f, timer),
               room / 3);
    check_guards(findings, gpu, tonemap.enqueue(radiance, 0.0f, timer), size / 3, room / 3);
}

}  // namespace

void try_orthographic(const Gpu& gpu, Findings& findings) {
    for (const double near : {0.0, -50.0}) {
        const Camera camera = parallel_camera(near, 90.0);
        LightMix mix;
        mix.count = 900;
        mix.z_near = near;
        mix.z_far = 90.0;
        mix.range_min = 2.0;
        mix.range_max = 12.0;
        Shot shot = camera_shot(camera, noise_depth(near, 89.0, 0.1, 4), mix);
        const Box box{glm::dvec3(-30, -20, -90), glm::dvec3(30, 20, -near)};
        shot.request = grid_request({}, camera, box, 0.0f);
        check_lists(findings, gpu, shot, 500);
        const Exposure exposure = expose(gpu, shot);
        findings.at_most("|d|/max(r,E) against R1", error_against_r1(shot, exposure), kR1Limit);
        findings.at_most("position off its pixel / width", position_error(camera, shot, exposure),
                         4 * kUlp);
    }
}

void try_off_centre(const Gpu& gpu, Findings& findings) {
    LightMix mix;
    mix.count = 600;
    const DepthOf depth = noise_depth(0.2, 60.0, 0.1, 4);
    for (const glm::dvec2 shear : {glm::dvec2(0.5, -0.5), glm::dvec2(-0.5, 0.5), glm::dvec2(0)}) {
        Camera camera;
        camera.shear = shear;
        if (shear.x >= 0) camera.jitter = {0.5, -0.5};
        const Shot shot = camera_shot(camera, depth, mix);
        check_lists(findings, gpu, shot);
        findings.at_most("position off its pixel / width",
                         position_error(camera, shot, expose(gpu, shot)), 4 * kUlp);
    }
    const DepthOf near_depth = noise_depth(0.2, 3.0, 0.1, 4);
    Shot shot = noise_shot(oblique_shape(), near_depth);
    shot.lights = random_lights(shot.image.view, mix);
    check_lists(findings, gpu, shot);
    findings.at_most("oblique: error of z / its bound",
                     oblique_depth_error(shot, expose(gpu, shot), near_depth), 1.0);
}

void try_infinite_far(const Gpu& gpu, Findings& findings) {
    for (const double far : {std::numeric_limits<double>::infinity(), 1e300, 1e30}) {
        Camera camera;
        camera.z_far = far;
        LightMix mix;
        mix.count = 300;
        mix.z_far = 5e4;
        mix.range_max = 1e4;
        Shot shot = camera_shot(camera, noise_depth(0.2, 1e5, 0.4, 4), mix);
        shot.request.z_last = 1e5f;
        shot.ambient = 0.1f;
        check_lists(findings, gpu, shot);
        findings.at_most("position off its pixel / width",
                         position_error(camera, shot, expose(gpu, shot)), 4 * kUlp);
    }
    render_background(gpu, findings);
}

void try_odd_sizes(const Gpu& gpu, Findings& findings) {
    struct Size {
        uint width, height, lights;
    };
    for (const Size& size : {Size{1, 1, 200}, Size{17, 31, 200}, Size{16, 16, 200},
                             Size{1919, 1079, 12}, Size{8192, 1, 200}}) {
        ViewShape shape{size.width, size.height};
        shape.half_y = shape.half_x * size.height / size.width;
        Shot shot = noise_shot(shape, slanted_depth(0.5, 40.0, size.width));
        LightMix mix;
        mix.count = size.lights;
        shot.lights = random_lights(shot.image.view, mix);
        const Exposure exposure = expose(gpu, shot);
        check_none_missing(findings, shot, exposure);
        check_exact(findings, shot, exposure);
        check_reads(findings, gpu, shot, exposure);
    }
}

}  // namespace kilolux
