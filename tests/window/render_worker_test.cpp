// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/render_worker.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "host/base/error.h"
#include "host/scene/generated/scenes.h"
#include "present/cli/camera_choice.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

class RenderWorkerTest : public testing::Test {
 protected:
    RenderWorkerTest() {
        settings_.width = 96;
        settings_.height = 64;
        settings_.lights.count = 50;
    }
    PictureRequest request() {
        pixels_.assign(display_stride(settings_.width) * 64, 0);
        return {settings_, choose_camera({}, scene_), 0.0, pixels_};
    }
    RenderWorker worker() {
        return {scene_, settings_,
                [context = std::make_shared<std::optional<GlContext>>()](bool use) {
                    use ? void(context->emplace(GlContext::headless())) : context->reset();
                },
                [] {}};
    }

    Scene scene_ = make_generated_scene("plain");
    RenderSettings settings_;
    std::vector<uint> pixels_;
};

TEST(WaitingText, SaysHowLongAPictureTakesThatTakesLong) {
    EXPECT_EQ(waiting_text(RendererKind::forward, 1.9, 0.0), "");
    EXPECT_EQ(waiting_text(RendererKind::forward, 0.3, 1.9), "");
    EXPECT_EQ(waiting_text(RendererKind::forward, 2.4, 0.0), "forward: 2 s so far");
    EXPECT_EQ(waiting_text(RendererKind::deferred_all, 0.3, 61.2),
              "deferred-all: 0 s so far, about 61 s in all");
    EXPECT_EQ(waiting_text(RendererKind::forward, 70.0, 61.2),
              "forward: 70 s so far, about 70 s in all");
}

TEST_F(RenderWorkerTest, MakesThePictureOfTheRenderer) {
    RenderWorker worker = this->worker();
    const Picture picture = worker.render(request()).get();
    EXPECT_EQ(picture.frame.width, 96);
    EXPECT_EQ(picture.frame.stats.lights_used, 50u);
    EXPECT_GT(picture.device_bytes, 0u);
    EXPECT_FALSE(picture.device.name.empty());
    Renderer renderer(scene_, settings_);
    const Frame expected = renderer.render(choose_camera({}, scene_), 0.0);
    const std::size_t stride = display_stride(96);
    for (std::size_t y = 0; y < 64; ++y) {
        ASSERT_EQ(std::memcmp(&pixels_[y * stride], &expected.display[4 * 96 * y], 4 * 96), 0) << y;
    }
}

TEST_F(RenderWorkerTest, GoesOnAfterAPictureThatCannotBeMade) {
    RenderWorker worker = this->worker();
    worker.render(request()).get();
    PictureRequest refused = request();
    refused.settings.device = "no such device";
    EXPECT_THROW(worker.render(refused).get(), Error);
    EXPECT_EQ(worker.render(request()).get().frame.width, 96);
}

// In a window's worker, forward passes are drawn in parts: they can be cancelled between parts, and
// estimate the time of the whole.
TEST_F(RenderWorkerTest, APictureInPartsIsThatOfTheRenderer) {
    settings_.renderer = RendererKind::forward;
    settings_.lights.count = 5000;  // a pass of fewer may be drawn at once
    RenderWorker worker = this->worker();
    PictureRequest parts = request();
    parts.progress = std::make_shared<PictureProgress>();
    worker.render(parts).get();
    EXPECT_GT(parts.progress->estimate(), 0.0);
    EXPECT_GT(parts.progress->seconds(), 0.0);
    Renderer renderer(scene_, settings_);
    const Frame expected = renderer.render(choose_camera({}, scene_), 0.0);
    const std::size_t stride = display_stride(96);
    for (std::size_t y = 0; y < 64; ++y) {
        ASSERT_EQ(std::memcmp(&pixels_[y * stride], &expected.display[4 * 96 * y], 4 * 96), 0) << y;
    }
}

TEST_F(RenderWorkerTest, APictureThatIsGivenUpEndsAndTheNextIsWhole) {
    settings_.renderer = RendererKind::forward;
    RenderWorker worker = this->worker();
    worker.render(request()).get();
    const std::vector<uint> whole = pixels_;
    PictureRequest unwanted = request();
    unwanted.progress = std::make_shared<PictureProgress>();
    unwanted.progress->give_up();
    EXPECT_THROW(worker.render(unwanted).get(), Interrupted);
    worker.render(request()).get();
    EXPECT_EQ(pixels_, whole);
}

TEST_F(RenderWorkerTest, AProbeThatCannotBeIsAnswered) {
    settings_.band_rows = 16;
    RenderWorker worker = this->worker();
    worker.render(request()).get();
    EXPECT_THROW(worker.ask([](Renderer& r) { return r.probe(5, 5).lights.size(); }).get(), Error);
    EXPECT_EQ(worker.ask([](Renderer& r) { return r.settings().width; }).get(), 96);
}

TEST_F(RenderWorkerTest, TimesAreThoseOfThePictureAlone) {
    RenderWorker worker = this->worker();
    PictureRequest too_large = request();  // lists of 500 MiB
    too_large.settings.lights.count = 200'000;
    too_large.settings.lights.radius = 1e6;
    too_large.settings.max_memory_bytes = std::uint64_t{256} << 20;
    EXPECT_THROW(worker.render(too_large).get(), Error);
    PictureRequest next = request();
    next.settings.renderer = RendererKind::forward;
    for (const StageTime& stage : worker.render(next).get().frame.stats.stages) {
        EXPECT_NE(stage.name, "bin_pixels");
    }
}

TEST_F(RenderWorkerTest, SaysWhyTheRendererIsNotThere) {
    settings_.device = "no such device";
    RenderWorker worker = this->worker();
    EXPECT_TRUE(worker.stop(std::chrono::minutes(1)));
    EXPECT_THROW(worker.check_begun(), Error);
}

}  // namespace
}  // namespace kilolux
