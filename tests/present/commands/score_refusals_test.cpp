// SPDX-License-Identifier: Apache-2.0
// What `kilolux score` refuses, a line each.
#include <gtest/gtest.h>

#include <limits>

#include "host/base/system/atomic_write.h"
#include "host/images/images.h"
#include "present/image/image_file.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

using Words = std::vector<std::string>;

class ScoreRefusals : public testing::Test {
 protected:
    ScoreRefusals() { write("reference.exr", {4, 2}); }
    std::string file(const std::string& name) { return (folder_ / name).string(); }
    void write(const std::string& name, std::pair<int, int> size, float value = 1.0f) {
        Frame frame;
        frame.width = size.first;
        frame.height = size.second;
        frame.radiance.assign(static_cast<std::size_t>(3 * size.first * size.second), value);
        frame.display.assign(static_cast<std::size_t>(4 * size.first * size.second), 9);
        frame.radiance[0] = 1.0f;
        write_image(file(name), frame);
    }
    void expect_refused(Words words, int code, const std::string& why) {
        words.insert(words.begin(), "score");
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, code) << why;
        EXPECT_EQ(result.out, "");
        EXPECT_TRUE(contains(result.err, why)) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    }
    TemporaryFolder folder_;
};

TEST_F(ScoreRefusals, PicturesThatCannotBeCompared) {
    const Words by_file{"--reference", file("reference.exr")};
    write("wide.exr", {5, 2});
    expect_refused({file("wide.exr"), by_file[0], by_file[1]}, 1,
                   "wide.exr: is 5x2 pixels, the reference ");
    write("nan.exr", {4, 2}, std::numeric_limits<float>::quiet_NaN());
    expect_refused({file("nan.exr"), by_file[0], by_file[1]}, 1,
                   "nan.exr: 8 pixels are NaN or infinite, the first one at 0,0");
    write("infinite.exr", {4, 2}, std::numeric_limits<float>::infinity());
    expect_refused({file("reference.exr"), "--reference", file("infinite.exr")}, 1,
                   "infinite.exr: 8 pixels are NaN or infinite");
    write("display.png", {4, 2});
    expect_refused({file("display.png"), by_file[0], by_file[1]}, 1,
                   "display.png: holds display values; score needs linear ones, .exr or .hdr");
    expect_refused({file("none.exr"), by_file[0], by_file[1]}, 1, "none.exr");
    const std::vector<float> values(8, 1.0f);
    ImageLayout grey{4, 2, {{"Y", SampleType::float32}}};
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    write_atomically(file("grey.exr"),
                     encode_pixels("grey.exr", "openexr", grey, {bytes, 4 * values.size()}, 4));
    expect_refused({file("grey.exr"), by_file[0], by_file[1]}, 1,
                   "grey.exr: has channels Y; score needs R, G and B");
}

// The frame is a part of a picture of 8x2 pixels; another one is in the primaries of ACES AP1.
TEST_F(ScoreRefusals, PicturesOfOtherThings) {
    Frame frame;
    frame.width = 4;
    frame.height = 2;
    frame.radiance.assign(24, 1.0f);
    ImageOptions options;
    options.crop = PixelRect{2, 0, 4, 2};
    options.full_width = 8;
    options.full_height = 2;
    write_image(file("part.exr"), frame, {}, options);
    expect_refused({file("part.exr"), "--reference", file("reference.exr")}, 1,
                   "part.exr: is 4x2 pixels of a picture of 8x2; score needs all of it");
    ImageLayout layout{4, 2, {}};
    for (const char* name : {"R", "G", "B"}) {
        layout.channels.push_back({name, SampleType::float32});
    }
    layout.attributes.emplace_back(
        "chromaticities",
        std::vector<float>{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f});
    const auto* bytes = reinterpret_cast<const unsigned char*>(frame.radiance.data());
    write_atomically(file("aces.exr"),
                     encode_pixels("aces.exr", "openexr", layout, {bytes, 4 * 24}, 12));
    expect_refused({file("aces.exr"), "--reference", file("reference.exr")}, 1,
                   "aces.exr: its primaries are 0.713 0.293 0.165 0.83 ");
}

TEST_F(ScoreRefusals, ReferencesWithoutLight) {
    ASSERT_EQ(run_kilolux({"export", "plain", "-o", file("dark.glb"), "--resolution", "64,32",
                           "--lights", "0", "--rig", "none", "-q"})
                  .code,
              0);
    expect_refused({file("reference.exr"), "--scene", file("dark.glb"), "-q"}, 1,
                   "dark.glb: has no lights; --lights N adds some");
    Frame black;
    black.width = 4;
    black.height = 2;
    black.radiance.assign(24, 0.0f);
    write_image(file("black.exr"), black);
    expect_refused({file("reference.exr"), "--reference", file("black.exr")}, 1,
                   "the reference is black: ");
}

TEST_F(ScoreRefusals, CommandLinesThatCannotBeObeyed) {
    const std::string picture = file("reference.exr");
    expect_refused({picture}, 2, "needs one of --scene SCENE and --reference FILE");
    expect_refused({picture, "--scene", "plain", "--reference", picture}, 2, "needs one of");
    expect_refused({picture, "--reference", picture, "--inverse-square"}, 2,
                   "--reference: is a picture, not a scene, so it does not go with --inverse");
    expect_refused({picture, "--scene", "plain", "--resolution", "4,2"}, 2, "--resolution: ");
    expect_refused({picture, "--scene", "plain", "--samples", "4"}, 2, "--samples: ");
}

// The camera of an exported scene has a shape.
TEST_F(ScoreRefusals, APictureOfAnotherShape) {
    const std::string scene = file("scene.glb");
    ASSERT_EQ(run_kilolux({"export", "plain", "-o", scene, "--resolution", "64,36", "-q"}).code, 0);
    write("square.exr", {40, 40});
    expect_refused({file("square.exr"), "--scene", scene, "-q"}, 1,
                   "square.exr: is 40x40 pixels; camera 0 of ");
}

}  // namespace
}  // namespace kilolux
