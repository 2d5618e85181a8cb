// SPDX-License-Identifier: Apache-2.0
// Orthographic, off-centre and infinite cameras, and pictures of odd sizes.
#include <algorithm>

#include "host/certify/cases.h"
#include "host/certify/scene_case.h"
#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"
#include "host/render/plan/grid_request.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/generated/scenes.h"
#include "host/stages/picture/tonemap.h"
#include "kernels/shared/tone_curve.h"

namespace kilolux {
namespace {

// Cases 6, orthographic, and 7, off-centre.

Camera parallel_camera(double near, double far) {
    Camera camera;
    camera.orthographic = true;
    camera.y_extent = 20.0;
    camera.z_near = near;
    camera.z_far = far;
    return camera;
}

LightingCase camera_case(const Camera& camera, const DepthOf& depth,
                         const RandomLightOptions& mix) {
    LightingCase input;
    const View view = view_of(camera, 97, 65);
    input.image = make_synthetic(view, {}, depth);
    input.lights = random_lights(view, mix);
    return input;
}

// Distance of reconstructed positions, projected in double, from their pixels' centres, as a share
// of the picture's size.
Worst position_error(const Camera& camera, const LightingCase& input, const DeviceResult& result) {
    const View& view = input.image.view;
    const glm::dmat4 clip =
        clip_from_view(camera, static_cast<int>(view.width), static_cast<int>(view.height));
    return worst_of_drawn(input, [&](uint x, uint y) {
        const glm::dvec3 p = result.planes.vector(SURFACE_POSITION, x, y);
        const glm::dvec4 c = clip * glm::dvec4(p, 1.0);
        const double off_x = (c.x / c.w + 1.0) * 0.5 - (x + 0.5) / view.width;
        const double off_y = (1.0 - c.y / c.w) * 0.5 - (y + 0.5) / view.height;
        return std::max(std::abs(off_x), std::abs(off_y));
    });
}

ViewShape oblique_shape() {
    ViewShape shape = square_pixels(97, 65);
    shape.oblique_x = 0.3;
    shape.oblique_y = -0.05;
    return shape;
}

// 1/z is a sum of four terms, each rounded. Where they cancel, z loses as many digits: the error is
// in units of 4 u times the sum's condition.
Worst oblique_depth_error(const LightingCase& input, const DeviceResult& result,
                          const DepthOf& depth) {
    const View& view = input.image.view;
    return worst_of_drawn(input, [&](uint x, uint y) {
        const double z = depth(x, y);
        const double d = depth01_of(view, x, y, z);
        const double terms = std::abs(d * view.depth.x) + std::abs((x + 0.5) * view.depth.y) +
                             std::abs((y + 0.5) * view.depth.z) + std::abs(view.depth.w);
        const double found = result.planes.at(SURFACE_DEPTH, x, y);
        return std::abs(found / z - 1.0) / (4 * kUlp * std::max(terms * z, 1.0));
    });
}

// Case 8, infinite-far.

void render_background(const Gpu& gpu, Findings& findings) {
    const Scene scene = make_generated_scene("plain");
    Camera camera = camera_of(scene.cameras.front());
    camera.z_far = std::numeric_limits<double>::infinity();
    // The camera looks horizontally, so that background is in the picture.
    const glm::dvec3 ahead = glm::dvec3(1, 0, 1) * -camera.world_from_view[2];
    camera.world_from_view =
        look_at(camera.position, camera.position + ahead, {0, 1, 0}, camera.y_fov).world_from_view;
    RenderSettings settings = scene_settings(gpu, 48, 32);
    settings.lights.count = 20;
    settings.want.aovs = {"depth", "position", "normal"};
    settings.tone_curve = ToneCurve::none;
    const Frame frame = Renderer(scene, settings).render(camera, 0.0);
    std::uint64_t background = 0;
    std::uint64_t wrong = 0;
    std::uint64_t not_finite = count_invalid(frame.radiance);
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
    findings.none("NaN or Inf drawn by OpenGL", not_finite, frame.radiance.size());
    findings.none("background not the clear colour", wrong, 3 * background);
    findings.at_least("background pixels", background, 100);
    findings.at_least("surface pixels", frame.aovs[0].values.size() - background, 100);
}

// Case 9, odd-sizes: writes and reads past the end of a buffer.

constexpr uint kGuard = 0x7fc12345u;  // a NaN

// Fills a stage's output buffer, which an earlier, taller picture made larger, with the guard.
void fill_guard(const Gpu& gpu, const cl::Buffer& buffer, std::size_t floats) {
    gpu.queue.enqueueFillBuffer(buffer, kGuard, 0, floats * sizeof(float));
}

std::uint64_t guards_in(const std::vector<uint>& words, std::size_t first, std::size_t last) {
    return static_cast<std::uint64_t>(std::count(words.begin() + static_cast<std::ptrdiff_t>(first),
                                                 words.begin() + static_cast<std::ptrdiff_t>(last),
                                                 kGuard));
}

// The first `written` of the buffer's `room` floats must be written, and no other.
void check_guards(Findings& findings, const Gpu& gpu, const cl::Buffer& buffer, std::size_t written,
                  std::size_t room) {
    const auto words = download<uint>(gpu, buffer, room);
    findings.none("output not written", guards_in(words, 0, written), written);
    const std::uint64_t after = room - written;
    findings.none("written past the end", after - guards_in(words, written, room), after);
}

// Lights the case again with NaN on both sides of the G-buffer, which no kernel may read.
void check_reads(Findings& findings, const Gpu& gpu, const LightingCase& input,
                 const DeviceResult& result) {
    const View& view = input.image.view;
    constexpr std::size_t kAlign = 4096;  // more than any device's CL_DEVICE_MEM_BASE_ADDR_ALIGN
    const std::size_t bytes = input.image.bytes.size();
    const std::vector<uint> guards((bytes + 2 * kAlign) / sizeof(uint), kGuard);
    cl::Buffer whole = new_buffer(gpu, guards);
    const cl_buffer_region region{kAlign, bytes};
    GBuffer gbuffer{whole.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region),
                    input.image.layout, view};
    gpu.queue.enqueueWriteBuffer(gbuffer.bytes, CL_TRUE, 0, bytes, input.image.bytes.data());
    const Tuning tuning = default_tuning(gpu.info);
    DeferredLighting lighting(gpu, tuning, input.features);
    StageTimer timer;
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    // A taller picture first, so that the buffers are larger than this picture needs.
    LightingCase large = input;
    View tall = view;
    tall.height += 64;
    large.image = make_synthetic(tall, input.features, no_depth());
    large.lights.clear();
    const std::size_t room = std::size_t{3} * tall.stride * tall.height;
    fill_guard(gpu, lighting.light(upload(gpu, large), timer).planes, room);
    const Radiance radiance =
        lighting.light({gbuffer, upload_lights(gpu, input.lights), result.grid}, timer);
    check_guards(findings, gpu, radiance.planes, size, room);
    check_same_bits(findings, "bits changed by what surrounds the buffers", download(gpu, radiance),
                    result.listed);
    Tonemap tonemap(gpu, tuning, TONE_CURVE_NEUTRAL);
    fill_guard(gpu, tonemap.enqueue({new_buffer(gpu, std::vector<float>(room)), tall}, 0.0f, timer),
               room / 3);
    check_guards(findings, gpu, tonemap.enqueue(radiance, 0.0f, timer), size / 3, room / 3);
}

}  // namespace

void try_orthographic(const Gpu& gpu, Findings& findings) {
    for (const double near : {0.0, -50.0}) {
        const Camera camera = parallel_camera(near, 90.0);
        LightingCase input = camera_case(
            camera, noise_depth(near, 89.0, 0.1, 4),
            {.count = 900, .z_near = near, .z_far = 90.0, .range_min = 2.0, .range_max = 12.0});
        const Box box{glm::dvec3(-30, -20, -90), glm::dvec3(30, 20, -near)};
        input.request = grid_request({}, camera, box, 0.0f);
        const DeviceResult result = check_lists(findings, gpu, input, 500);
        findings.at_most("|d|/max(r,E) against R1", error_against_r1(input, result), 1e-5);
        findings.at_most("position off its pixel / width", position_error(camera, input, result),
                         4 * kUlp);
    }
}

void try_off_centre(const Gpu& gpu, Findings& findings) {
    const RandomLightOptions mix{.count = 600};
    const DepthOf depth = noise_depth(0.2, 60.0, 0.1, 4);
    for (const glm::dvec2 shear : {glm::dvec2(0.5, -0.5), glm::dvec2(-0.5, 0.5), glm::dvec2(0)}) {
        Camera camera;
        camera.shear = shear;
        if (shear.x >= 0) camera.jitter = {0.5, -0.5};
        const LightingCase input = camera_case(camera, depth, mix);
        const DeviceResult result = check_lists(findings, gpu, input);
        findings.at_most("position off its pixel / width", position_error(camera, input, result),
                         4 * kUlp);
    }
    const DepthOf near_depth = noise_depth(0.2, 3.0, 0.1, 4);
    LightingCase input = noise_case(oblique_shape(), near_depth);
    input.lights = random_lights(input.image.view, mix);
    const DeviceResult result = check_lists(findings, gpu, input);
    findings.at_most("oblique: error of z / its bound",
                     oblique_depth_error(input, result, near_depth), 1.0);
}

void try_infinite_far(const Gpu& gpu, Findings& findings) {
    for (const double far : {std::numeric_limits<double>::infinity(), 1e300, 1e30}) {
        Camera camera;
        camera.z_far = far;
        LightingCase input = camera_case(camera, noise_depth(0.2, 1e5, 0.4, 4),
                                         {.count = 300, .z_far = 5e4, .range_max = 1e4});
        input.request.z_last = 1e5f;
        input.ambient = 0.1f;
        const DeviceResult result = check_lists(findings, gpu, input);
        findings.at_most("position off its pixel / width", position_error(camera, input, result),
                         4 * kUlp);
    }
    render_background(gpu, findings);
}

void try_odd_sizes(const Gpu& gpu, Findings& findings) {
    struct Size {
        uint width, height, lights;
    };
    for (const Size& size : {Size{1, 1, 200}, Size{17, 31, 200}, Size{16, 16, 200},
                             Size{1919, 1079, 12}, Size{8192, 1, 200}}) {
        LightingCase input = noise_case(square_pixels(size.width, size.height),
                                        slanted_depth(0.5, 40.0, size.width));
        input.lights = random_lights(input.image.view, {.count = size.lights});
        const DeviceResult result = check_lists(findings, gpu, input, 0);
        check_reads(findings, gpu, input, result);
    }
}

}  // namespace kilolux
