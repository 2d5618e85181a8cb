// SPDX-License-Identifier: Apache-2.0
// Shadows that are kept have the bits of those that are cast, in all forms of the kernel. Also runs
// under oclgrind.
#include "host/stages/shadows/keep_shadows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/stages/shadows/cast_shadows.h"
#include "tests/opencl/shadows/casters.h"

namespace kilolux {
namespace {

constexpr std::uint32_t kLights = 12;

class KeptFrame {
 public:
    KeptFrame(int lanes, int group) : gpu_(test_gpu(lanes)), tuning_(default_tuning(gpu_.info)) {
        tuning_.shadow_group = group;
        features_.shading = SHADING_LAMBERT;
        features_.spot_lights = features_.directional_lights = features_.shadows = true;
        ViewShape shape;
        shape.width = shape.height = 17;
        view_ = make_view(shape);
        grid_ = make_cluster_grid({2, 2, 1, 1.0f, 30.0f}, view_.width, view_.height);
        gbuffer_ =
            upload_gbuffer(gpu_, make_synthetic(view_, features_, noise_depth(2.0, 50.0, 0.6, 8)));
        gbuffer_.version = 1;
        input_ = {random_casters(gpu_), unmoved_view(), origins_of(gpu_, features_, gbuffer_)};
        RandomLightOptions mix;
        mix.count = kLights;
        mix.range_max = 30;
        mix.spots = 0.3;
        lights_ = random_lights(view_, mix);
        keep_.emplace(gpu_, tuning_, features_, "cast_shadows");
    }

    struct Cast {
        std::vector<uint> words;
        ShadowCounts counts{};
    };

    // Of lights in another order, one of which and a directional one have moved; with the bits of
    // the first lights, where they are kept.
    Cast cast_others(bool keeps) {
        if (keeps) {
            make(lights_, {{{0, 0, 1, 0}, {1, 1, 1, 0}}, {{0, 1, 0, 0}, {1, 1, 1, 0}}}, {}, false,
                 true);
        }
        std::vector<Light> others = lights_;
        others[5].position_range.x += 0.5f;
        std::ranges::rotate(others, others.begin() + 4);
        std::vector<uint> index_before;
        for (uint i = 0; i < kLights; ++i) index_before.push_back((i + 4) % kLights);
        return make(others, {{{0, 0, 1, 0}, {1, 1, 1, 0}}, {{1, 0, 0, 0}, {1, 1, 1, 0}}},
                    index_before, keeps, false);
    }

 private:
    Cast make(const std::vector<Light>& rows, const std::vector<DirectionalLight>& directional,
              const std::vector<uint>& index_before, bool keeps, bool saves) {
        LightInput lights = upload_lights(gpu_, rows, directional);
        if (!index_before.empty()) {
            lights.index_before = {new_buffer(gpu_, index_before), index_before.size()};
        }
        StageTimer timer;
        LightLists stages(gpu_, tuning_, features_);
        const ListedLights lists = stages.run(lights, gbuffer_, grid_, timer);
        CastShadows cast(gpu_, tuning_, features_, {}, true);
        ShadowTargets to{cast.reserve(lists.lights, lists.clusters, timer)};
        const LitPixels lit = lists.at(gbuffer_);
        gpu_.queue.enqueueFillBuffer(to.words.words.buffer(), cl_uint{0}, 0,
                                     cast.words() * sizeof(uint));
        if (keeps) to.kept = keep_->enqueue(lit, to.words, timer);
        cast.enqueue(input_, lit, to, timer);
        if (saves) keep_->save(lit, {to.words, cast.words()}, stages.counts(), timer);
        gpu_.queue.finish();
        return {download(gpu_, to.words.words, cast.words()), cast.counts()};
    }

    Gpu gpu_;
    Tuning tuning_;
    KernelFeatures features_;
    View view_{};
    ClusterGrid grid_{};
    GBuffer gbuffer_;
    ShadowInput input_;
    std::vector<Light> lights_;
    std::optional<KeepShadows> keep_;
};

void expect_kept(int lanes, int group) {
    const KeptFrame::Cast kept = KeptFrame(lanes, group).cast_others(true);
    const KeptFrame::Cast cast = KeptFrame(lanes, group).cast_others(false);
    EXPECT_EQ(kept.words, cast.words);
    EXPECT_GT(kept.counts.rays, 0u) << "one point and one directional light have moved";
    EXPECT_LT(kept.counts.rays, cast.counts.rays / 2);
}

TEST(EveryKernel, KeptShadows) { expect_kept(4, 1); }
TEST(EveryKernel, KeptShadowsByGroup) { expect_kept(1, 32); }
TEST(EveryKernel, KeptShadowsByBundle) { expect_kept(4, 0); }

}  // namespace
}  // namespace kilolux
