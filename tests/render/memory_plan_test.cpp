// SPDX-License-Identifier: Apache-2.0
#include "host/render/plan/memory_plan.h"

#include <gtest/gtest.h>

#include <initializer_list>

#include "host/stages/lists/mask_tiles.h"
#include "host/stages/surfaces/bin_triangles.h"
#include "host/stages/surfaces/raster_triangles.h"
#include "raster/gl_context.h"
#include "raster/solid_pass.h"
#include "tests/support/messages.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

DeviceInfo cpu() {
    DeviceInfo device;
    device.is_cpu = true;
    device.max_allocation_bytes = std::uint64_t{1} << 30;
    return device;
}

MemoryPlan plan(const Scene& scene, RenderSettings settings) {
    settings.max_memory_bytes = std::uint64_t{1} << 30;
    const std::uint64_t lights = settings.lights.count + scene.lights.size();
    return plan_memory(scene, settings, make_scene_plan(scene, settings, lights), cpu());
}

TEST(MemoryPlan, DeviceBuffersHoldTheScenesOwnLightsToo) {
    Scene scene = make_generated_scene("plain");
    const MemoryPlan generated = plan(scene, small_settings(64, 64, 100'000));
    scene.lights.assign(100'000, SceneLight{});
    const MemoryPlan own = plan(scene, small_settings(64, 64, 0));
    EXPECT_EQ(own.device_bytes, generated.device_bytes);
}

// 2^18 pixels, with a third more for mip levels.
TEST(MemoryPlan, ImagesOf16BitsTakeTwice) {
    Scene scene = make_generated_scene("plain");
    const std::uint64_t none = plan(scene, small_settings(64, 64, 0)).bytes;
    constexpr std::size_t kSamples = std::size_t{4} << 18;
    scene.images.push_back({"narrow", 512, 512, std::vector<std::uint8_t>(kSamples)});
    const std::uint64_t narrow = plan(scene, small_settings(64, 64, 0)).bytes - none;
    EXPECT_GE(narrow, kSamples * 4 / 3);
    scene.images[0] = {"wide", 512, 512, {}, std::vector<std::uint16_t>(kSamples)};
    EXPECT_EQ(plan(scene, small_settings(64, 64, 0)).bytes - none, 2 * narrow);
}

TEST(MemoryPlan, DeviceBuffersHoldTheWholePictureOfBloom) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(1024, 1024, 100);
    const MemoryPlan without = plan(scene, settings);
    settings.bloom = 0.5f;
    const MemoryPlan with = plan(scene, settings);
    EXPECT_EQ(with.device_bytes + with.held_bytes, without.device_bytes + without.held_bytes);
    EXPECT_GE(with.bytes, without.bytes);
}

// What lists may take and what finished pictures may take is not given twice.
TEST(MemoryPlan, FinishedPicturesHaveAPartOfTheirOwn) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(64, 64, 100);
    const ScenePlan scene_plan = make_scene_plan(scene, settings, settings.lights.count);
    settings.max_memory_bytes = std::uint64_t{1} << 30;
    const MemoryPlan large = plan_memory(scene, settings, scene_plan, cpu());
    EXPECT_GT(large.held_bytes, 64u * 64 * 16);
    constexpr std::uint64_t kMore = std::uint64_t{1} << 28;
    settings.max_memory_bytes += kMore;
    const MemoryPlan larger = plan_memory(scene, settings, scene_plan, cpu());
    EXPECT_EQ(larger.device_bytes + larger.held_bytes,
              large.device_bytes + large.held_bytes + kMore);
    settings.max_memory_bytes = large.bytes;
    EXPECT_EQ(plan_memory(scene, settings, scene_plan, cpu()).held_bytes, 0u);
}

// Automatic geometry may draw in OpenCL; a difference to deferred-all has the scene on the device
// twice.
TEST(MemoryPlan, CountsWhatAutomaticGeometryAndTheDifferenceTake) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 64, 100);
    settings.geometry = Geometry::ids;
    const MemoryPlan ids = plan(scene, settings);
    settings.geometry = Geometry::automatic;
    EXPECT_EQ(plan(scene, settings).bytes - ids.bytes,
              BinTriangles::kTriangleBytes * triangle_count(scene));
    settings.geometry = Geometry::ids;
    settings.want.view = ViewKind::albedo;
    const MemoryPlan view = plan(scene, settings);
    settings.want.view = ViewKind::difference;
    settings.lights.count = 100'100;
    const MemoryPlan more = plan(scene, settings);
    settings.lights.count = 100;
    const MemoryPlan difference = plan(scene, settings);
    settings.want.view = ViewKind::albedo;
    settings.lights.count = 100'100;
    EXPECT_GT(difference.bytes, view.bytes);
    EXPECT_EQ(more.bytes - difference.bytes, 2 * (plan(scene, settings).bytes - view.bytes));
    const auto wider = [&](ViewKind shown, int width) {
        settings.want.view = shown;
        settings.width = width;
        return plan(scene, settings).bytes;
    };
    settings.lights.count = 100;
    EXPECT_GT(wider(ViewKind::difference, 4096) - wider(ViewKind::difference, 64),
              wider(ViewKind::albedo, 4096) - wider(ViewKind::albedo, 64));
}

std::uint64_t texel_bits(GLuint texture, std::initializer_list<GLenum> parts) {
    std::uint64_t bits = 0;
    for (const GLenum part : parts) {
        GLint some = 0;
        glGetTextureLevelParameteriv(texture, 0, part, &some);
        bits += static_cast<std::uint64_t>(some);
    }
    return bits;
}

// The host holds a mesh twice, with the attributes that it has.
TEST(MemoryPlan, CountsTheAttributesThatMeshesHave) {
    Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(64, 64, 0);
    settings.geometry = Geometry::planes;
    const std::uint64_t without = plan(scene, settings).bytes;
    scene.meshes[0].colors.resize(1000);
    EXPECT_EQ(plan(scene, settings).bytes - without, 2 * 1000 * sizeof(glm::vec4));
}

// OpenGL's targets of the ids, which drawing in OpenCL lacks.
TEST(MemoryPlan, CountsTheTargetsOfIds) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(64, 48, 0);
    settings.geometry = Geometry::ids;
    settings.max_memory_bytes = std::uint64_t{1} << 30;
    const auto planned = [&](bool draws_in_opencl) {
        return plan_memory(scene, settings, make_scene_plan(scene, settings, 0), cpu(),
                           draws_in_opencl)
            .bytes;
    };
    const GlContext context = GlContext::headless();
    const GpuScene gpu_scene(scene, 1, GpuSceneUse::covered);
    IdsPass ids(gpu_scene);
    ids.draw(first_camera(scene), settings.width, settings.height);
    const std::uint64_t bits =
        texel_bits(ids.targets().color_texture(0), {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE,
                                                    GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE}) +
        texel_bits(ids.targets().depth_texture(), {GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE});
    EXPECT_EQ(planned(false) - planned(true), 64u * 48u * bits / 8);
}

// A band has the ids that its surfaces are resolved from, and with --samples auto those that are
// left of them.
TEST(MemoryPlan, CountsTheIdsOfBands) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(64, 48, 0);
    settings.max_memory_bytes = std::uint64_t{1} << 30;
    const auto rows_of_64 = [&](Geometry geometry) {
        settings.geometry = geometry;
        const auto planned = [&](int height) {
            settings.height = height;
            return plan_memory(scene, settings, make_scene_plan(scene, settings, 0), cpu(), true)
                .bytes;
        };
        return planned(128) - planned(64);
    };
    constexpr std::uint64_t kPixels = 64 * 64;
    EXPECT_EQ(rows_of_64(Geometry::compute) - rows_of_64(Geometry::planes),
              kPixels * RasterTriangles::kPixelBytes);
    settings.auto_samples.on = true;
    EXPECT_EQ(rows_of_64(Geometry::compute) - rows_of_64(Geometry::planes),
              kPixels * (RasterTriangles::kPixelBytes + MaskTiles::kPixelBytes));
}

// Each takes its part; messages say what is divided.
TEST(MemoryPlan, RenderersShareTheMemory) {
    const Scene scene = make_generated_scene("plain");
    RenderSettings settings = small_settings(64, 64, 100);
    const auto made = [&] {
        return plan_memory(scene, settings, make_scene_plan(scene, settings, 100), cpu());
    };
    settings.max_memory_bytes = std::uint64_t{1} << 29;
    const MemoryPlan half = made();
    settings.max_memory_bytes = std::uint64_t{1} << 30;
    settings.memory_shares = 2;
    const MemoryPlan share = made();
    EXPECT_EQ(share.device_bytes, half.device_bytes);
    EXPECT_EQ(share.held_bytes, half.held_bytes);
    DeviceInfo gpu = cpu();
    gpu.is_cpu = false;
    gpu.memory_bytes = std::uint64_t{8} << 30;
    settings.device_shares = 2;
    const ScenePlan plan = make_scene_plan(scene, settings, 100);
    EXPECT_EQ(plan_memory(scene, settings, plan, gpu).device_bytes, gpu.memory_bytes / 2);
    settings.memory_shares = 8;
    const std::string refused = message_of<Error>(made);
    EXPECT_TRUE(refused.ends_with(" MiB; 8 renderers share 1024 MiB (--max-memory)")) << refused;
}

TEST(MemoryPlan, TheMessageCountsTheScenesOwnLightsToo) {
    Scene scene = make_generated_scene("plain");
    scene.lights.assign(5, SceneLight{});
    RenderSettings settings = small_settings(64, 64, 2);
    settings.max_memory_bytes = std::uint64_t{1} << 20;
    const auto refused = [&] {
        return message_of<Error>(
            [&] { plan_memory(scene, settings, make_scene_plan(scene, settings, 7), cpu()); });
    };
    EXPECT_TRUE(refused().starts_with("memory: 64x64 pixels with 7 lights need at least "))
        << refused();
    settings.lights.count = 0;
    scene.lights.resize(1);
    EXPECT_TRUE(refused().starts_with("memory: 64x64 pixels with 1 light need at least "))
        << refused();
}

// The message blames lights only where the program fits without them.
TEST(MemoryPlan, TheProgramAloneMayBeTooLarge) {
    RenderSettings settings = small_settings(64, 64, 5000);
    const auto refused = [&](std::uint64_t lights, std::uint64_t mebibytes) {
        settings.max_memory_bytes = mebibytes << 20;
        return message_of<Error>([&] { check_light_memory(lights, settings); });
    };
    for (const std::uint64_t lights : {0u, 1u, 5000u}) {
        EXPECT_EQ(refused(lights, 1),
                  "memory: the program with its drivers needs at least 256 MiB; --max-memory is 1 "
                  "MiB");
    }
    EXPECT_EQ(
        refused(1, 256),
        "memory: the program and 1 generated light need at least 257 MiB; --max-memory is 256 "
        "MiB");
    EXPECT_TRUE(refused(1'000'000, 257)
                    .starts_with("memory: the program and 1000000 generated lights need at least "))
        << refused(1'000'000, 257);
    settings.max_memory_bytes = 1 << 30;
    EXPECT_NO_THROW(check_light_memory(5000, settings));
}

}  // namespace
}  // namespace kilolux
