// SPDX-License-Identifier: Apache-2.0
// Rounding to 8-bit sRGB codes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/formats/srgb.h"
#include "host/certify/cases.h"
#include "host/certify/opengl_beside.h"
#include "host/certify/scene_case.h"
#include "host/certify/synthetic/probe.h"
#include "host/stages/picture/tonemap.h"
#include "kernels/shared/tone_curve.h"
#include "raster/solid_pass.h"

namespace kilolux {
namespace {

// The linear value between a code and the next (IEC 61966-2-1).
double boundary_above(int code) { return srgb_to_linear((code + 0.5) / 255.0); }

// The code before it is rounded.
double exact_code(double linear) { return 255.0 * linear_to_srgb(std::clamp(linear, 0.0, 1.0)); }

struct SrgbValues {
    std::vector<float> linear;
    std::size_t boundary_count = 0;  // values at boundaries, which come first
};

SrgbValues srgb_values() {
    SrgbValues out;
    for (int code = 0; code < 255; ++code) {
        const auto middle = static_cast<float>(boundary_above(code));
        out.linear.push_back(std::nextafter(middle, 0.0f));
        out.linear.push_back(middle);
        out.linear.push_back(std::nextafter(middle, 1.0f));
    }
    out.boundary_count = out.linear.size();
    // The 256 codes, and values spread evenly over the curve.
    for (int code = 0; code < 256; ++code) {
        out.linear.push_back(static_cast<float>(srgb_to_linear(code / 255.0)));
    }
    Random random(21);
    while (out.linear.size() < 20000) {
        out.linear.push_back(static_cast<float>(srgb_to_linear(random.unit())));
    }
    return out;
}

std::vector<int> codes_of_tonemap(const Gpu& gpu, const std::vector<float>& linear) {
    View view{};
    view.width = static_cast<uint>(linear.size());
    view.height = 1;
    view.stride = static_cast<uint>(round_up(linear.size(), 16));
    std::vector<float> planes(std::size_t{3} * view.stride, 0.5f);
    for (std::size_t c = 0; c < 3; ++c) {
        std::copy(linear.begin(), linear.end(),
                  planes.begin() + static_cast<std::ptrdiff_t>(c * view.stride));
    }
    Tonemap stage(gpu, default_tuning(gpu.info), TONE_CURVE_NONE);
    StageTimer timer;
    const cl::Buffer display = stage.enqueue({new_buffer(gpu, planes), view}, 0.0f, timer);
    std::vector<int> codes;
    for (const uint rgba : download<uint>(gpu, display, view.width)) {
        codes.push_back(static_cast<int>(rgba & 255u));
    }
    return codes;
}

// The codes that OpenGL's framebuffer makes of quads, one per pixel, under an orthographic camera.
// The G-buffer's albedo plane is written that way.
std::vector<int> codes_of_opengl(const std::vector<float>& linear) {
    constexpr int kWidth = 160;
    const int height = static_cast<int>(linear.size() + kWidth - 1) / kWidth;
    Mesh mesh;
    for (std::size_t i = 0; i < linear.size(); ++i) {
        const auto x = static_cast<float>(i % kWidth);
        const auto y = static_cast<float>(height - 1) - static_cast<float>(i / kWidth);
        add_quad(mesh, {x, y}, 1.0f, {0, 0, 1});
        mesh.colors.insert(mesh.colors.end(), 4, {linear[i], linear[i], linear[i], 1.0f});
    }
    const Scene scene = quad_scene(std::move(mesh));
    const GpuScene gpu_scene(scene);
    GeometryPass pass(gpu_scene, {});
    pass.draw(quad_camera(kWidth, height), kWidth, height);
    const GBufferLayout layout = make_gbuffer_layout({}, kWidth, static_cast<uint>(height));
    const std::vector<std::byte> bytes = read_gbuffer(pass.targets(), layout, kWidth);
    const auto* albedo =
        reinterpret_cast<const uint*>(bytes.data() + layout.offset_bytes[PLANE_ALBEDO]);
    std::vector<int> codes;
    for (std::size_t i = 0; i < linear.size(); ++i)
        codes.push_back(static_cast<int>(albedo[i] & 255u));
    return codes;
}

}  // namespace

void try_srgb_rounding(const Gpu& gpu, Findings& findings) {
    const SrgbValues values = srgb_values();
    const std::vector<int> own = codes_of_tonemap(gpu, values.linear);
    const std::optional<GlContext> context = opengl_beside(findings);
    const std::vector<int> opengl = context ? codes_of_opengl(values.linear) : own;
    std::uint64_t wrong = 0;
    Worst off;
    Worst from_exact;
    for (std::size_t i = 0; i < own.size(); ++i) {
        wrong += own[i] != std::lround(exact_code(values.linear[i])) ? 1 : 0;
        const auto place = [&] { return fmt::format("{:f}", values.linear[i]); };
        off.add(std::abs(own[i] - opengl[i]), place);
        from_exact.add(std::abs(exact_code(values.linear[i]) - opengl[i]), place);
    }
    findings.none("own codes wrong", wrong, own.size());
    findings.at_most("OpenGL's codes off by", off, 1.0);
    // OpenGL does not bound the error e of the conversion before rounding (Direct3D allows 0.1
    // code, llvmpipe has 0.15), which moves a share of 2 e of all values over a boundary. So a
    // share of equal codes is no criterion: each value must get one of the two codes beside it.
    findings.at_most("OpenGL's codes from the exact value", from_exact, 1.0);
    std::uint64_t trips = 0;
    for (std::size_t code = 0; code < 256; ++code) {
        const std::size_t i = values.boundary_count + code;
        trips += own[i] != static_cast<int>(code) || opengl[i] != static_cast<int>(code) ? 1 : 0;
    }
    findings.none("codes that do not come back", trips, 256);
}

}  // namespace kilolux
