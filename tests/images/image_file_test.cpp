// SPDX-License-Identifier: Apache-2.0
// Image files that are written: what their types hold.
#include <gtest/gtest.h>
#include <cmath>

#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/images/file_frames.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

TEST(ImageFile, TheSameFrameGivesTheSameBytes) {
    const Frame frame = make_layered_frame();
    ImageNotes notes;
    notes.strings = {{"scene", "atrium"}};
    const std::vector<std::string> names = {"a.exr", "a.hdr", "a.png", "a.jpg", "a.tif"};
    std::vector<std::vector<unsigned char>> firsts;
    for (const std::string& name : names) {
        const auto first = encode_image(name, frame, notes, {});
        EXPECT_GT(first.size(), 100u) << name;
        firsts.push_back(first);
    }
    // A file that held the time of writing would differ after this pause.
    const timespec pause{1, 100'000'000};
    nanosleep(&pause, nullptr);
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(firsts[i], encode_image(names[i], frame, notes, {})) << names[i];
    }
}

TEST(ImageFile, LosslessDisplayFormatsKeepCodes) {
    const TemporaryFolder folder;
    const Frame frame = make_frame();
    for (const char* name : {"a.png", "a.tif", "a.TIFF"}) {
        write_image(folder / name, frame);
        const FloatImage image = read_image(folder / name);
        ASSERT_EQ(image.channels.size(), 3u) << name;
        for (std::size_t i = 0; i < kFilePixels; ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_EQ(std::lround(image.values[3 * i + c] * 255.0f), frame.display[4 * i + c])
                    << name << " pixel " << i << " channel " << c;
            }
        }
    }
}

TEST(ImageFile, JpegIsCloseAndHdrKeepsItsEightBits) {
    const TemporaryFolder folder;
    Frame frame = make_frame();
    frame.display.assign(frame.display.size(), 200);
    frame.radiance.assign(frame.radiance.size(), 12.7f);
    write_image(folder / "a.jpg", frame);
    write_image(folder / "a.hdr", frame);
    for (const float v : read_image(folder / "a.jpg").values) EXPECT_NEAR(v * 255.0f, 200.0f, 2.0f);
    for (const float v : read_image(folder / "a.hdr").values) EXPECT_NEAR(v, 12.7f, 12.7f / 128.0f);
}

TEST(ImageFile, MeaningComesFromTheExtension) {
    EXPECT_EQ(image_meaning("x/y.EXR"), ImageMeaning::linear);
    EXPECT_EQ(image_meaning("y.hdr"), ImageMeaning::linear);
    for (const char* name : {"a.png", "a.jpg", "a.jpeg", "a.tif", "a.tiff", "a.PNG"}) {
        EXPECT_EQ(image_meaning(name), ImageMeaning::display) << name;
    }
    EXPECT_TRUE(holds_layers("a.exr"));
    EXPECT_FALSE(holds_layers("a.hdr"));
    EXPECT_EQ(message_of<UsageError>([] { image_meaning("a.pgn"); }),
              "a.pgn: image type '.pgn' is none of .exr, .hdr, .png, .jpg, .jpeg, .tif, .tiff; did "
              "you mean '.png'?");
    EXPECT_THROW(image_meaning("png"), UsageError);
}

TEST(ImageFile, OneLineForWhatCannotBeReadOrWritten) {
    const TemporaryFolder folder;
    const Frame frame = make_frame();
    const auto lost = message_of<Error>([&] { write_image(folder / "no/a.exr", frame); });
    EXPECT_TRUE(contains(lost, "no/a.exr: cannot write")) << lost;
    write_text(folder / "a.exr", "this is no image");
    const auto broken = message_of<Error>([&] { read_image(folder / "a.exr"); });
    EXPECT_TRUE(contains(broken, "a.exr: cannot read the image: ")) << broken;
    EXPECT_FALSE(contains(broken, "\n")) << broken;
    EXPECT_THROW(read_image(folder / "none.exr"), Error);
    Frame twice = make_layered_frame();
    twice.aovs.push_back(twice.aovs[0]);
    EXPECT_TRUE(contains(message_of<Error>([&] { encode_image("a.exr", twice, {}, {}); }), "'Z'"));
    Frame short_layer = make_layered_frame();
    short_layer.aovs[0].values.pop_back();
    EXPECT_THROW(encode_image("a.exr", short_layer, {}, {}), Error);
}

}  // namespace
}  // namespace kilolux
