// SPDX-License-Identifier: Apache-2.0
// Jittered samples: an even pattern, exact means, AOVs through the pixels' centres.
#include <cmath>
#include <cstring>

#include "host/picture/sample_pattern.h"
#include "tests/support/render_fixture.h"

namespace kilolux {
namespace {

TEST(SamplePattern, BeginsAtTheCentreAndStaysInThePixel) {
    EXPECT_EQ(sample_offset(0), glm::dvec2(0.0));
    for (std::uint32_t i = 0; i < 65536; ++i) {
        const glm::dvec2 p = sample_offset(i);
        ASSERT_TRUE(p.x >= -0.5 && p.x < 0.5 && p.y >= -0.5 && p.y < 0.5) << i;
    }
}

TEST(SamplePattern, AnyCountIsEvenlySpread) {
    for (const std::uint32_t count : {256u, 1000u, 4096u}) {
        // Share of the samples left of and below a corner against its area, in quarters.
        double worst = 0.0;
        for (int qx = 1; qx <= 4; ++qx) {
            for (int qy = 1; qy <= 4; ++qy) {
                int inside = 0;
                for (std::uint32_t i = 0; i < count; ++i) {
                    const glm::dvec2 p = sample_offset(i) + 0.5;
                    inside += p.x < qx / 4.0 && p.y < qy / 4.0;
                }
                worst =
                    std::max(worst, std::abs(inside / static_cast<double>(count) - qx * qy / 16.0));
            }
        }
        // Random points are off by 0.4 / sqrt(count); these by about 1 / count.
        EXPECT_LT(worst, 5.0 / count) << count << " samples";
    }
}

TEST(Samples, RadianceIsTheMeanOfJitteredPictures) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 36, 100);
    Renderer single(scene, settings);
    std::vector<double> sum(3u * 64 * 36);
    for (std::uint32_t i = 0; i < 4; ++i) {
        Camera camera = first_camera(scene);
        camera.jitter = sample_offset(i);
        const Frame frame = single.render(camera, 0.5);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += frame.radiance[k];
    }
    settings.samples = 4;
    const Frame mean = render_once(scene, settings, 0.5);
    for (std::size_t k = 0; k < sum.size(); ++k) {
        // The sum's order may change float64's last bit, and so float32's at a tie.
        ASSERT_NEAR(mean.radiance[k], sum[k] / 4, 1e-7 * sum[k]) << k;
    }
    EXPECT_NE(mean.radiance, single.render(first_camera(scene), 0.5).radiance);
}

TEST(Samples, AovsAndCountsAreThoseOfTheCentre) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 36, 100);
    settings.want.aovs = {"depth", "position", "normal", "light-count", "cluster"};
    const Frame one = render_once(scene, settings);
    settings.samples = 3;
    const Frame three = render_once(scene, settings);
    for (std::size_t i = 0; i < one.aovs.size(); ++i) {
        EXPECT_EQ(one.aovs[i].values, three.aovs[i].values) << one.aovs[i].name;
        EXPECT_EQ(one.aovs[i].ids, three.aovs[i].ids) << one.aovs[i].name;
    }
    EXPECT_EQ(one.stats.refined_pairs, three.stats.refined_pairs);
    EXPECT_EQ(one.stats.stages.size() + 1, three.stats.stages.size());  // sum_samples
}

// A picture refined sample by sample ends with the bits of the one made at once, and any change
// begins it anew.
TEST(Samples, RefinedPicturesHaveTheBitsOfWholeOnes) {
    const Scene scene = make_generated_scene("grid");
    RenderSettings settings = small_settings(64, 36, 100);
    const auto whole = [&](const Camera& camera, int samples) {
        RenderSettings s = settings;
        s.samples = samples;
        return Renderer(scene, s).render(camera, 0.5).display;
    };
    settings.samples = 5;
    Renderer renderer(scene, settings);
    const std::size_t stride = display_stride(64);
    std::vector<uint> pixels(stride * 36);
    const auto refined = [&](const Camera& camera, int samples) {
        renderer.render_to(pixels, camera, 0.5, samples);
        std::vector<std::uint8_t> out(4u * 64 * 36);
        for (std::size_t y = 0; y < 36; ++y) {
            std::memcpy(&out[4 * 64 * y], &pixels[y * stride], 4 * 64);
        }
        return out;
    };
    const Camera camera = first_camera(scene);
    Camera other = camera;
    other.position.y += 0.25;
    EXPECT_EQ(refined(camera, 1), whole(camera, 1));
    EXPECT_EQ(refined(camera, 2), whole(camera, 2));
    EXPECT_EQ(refined(camera, 4), whole(camera, 4));
    EXPECT_EQ(refined(camera, 5), whole(camera, 5));
    EXPECT_EQ(refined(camera, 3), whole(camera, 3)) << "fewer begin anew";
    EXPECT_EQ(refined(other, 4), whole(other, 4)) << "another camera begins anew";
    EXPECT_EQ(renderer.render(other, 0.5).display, whole(other, 5)) << "a whole one leaves no sum";
    EXPECT_EQ(refined(other, 5), whole(other, 5));
    settings.exposure = 1.0f;
    renderer.change(settings);
    EXPECT_EQ(refined(other, 2), whole(other, 2)) << "other settings begin anew";
}

TEST(Samples, EveryRendererJitters) {
    const Scene scene = make_generated_scene("grid");
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward_plus}) {
        RenderSettings settings = small_settings(64, 36, 100);
        settings.renderer = kind;
        const Frame one = render_once(scene, settings);
        settings.samples = 4;
        EXPECT_NE(one.radiance, render_once(scene, settings).radiance);
    }
}

}  // namespace
}  // namespace kilolux
