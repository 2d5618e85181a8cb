// SPDX-License-Identifier: Apache-2.0
// --crop and --tiles of `kilolux render`: the pixels of the whole picture, in files of their own.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "present/cli/sequence.h"
#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 70, kHeight = 50;

ChildResult render(const fs::path& output, std::vector<std::string> more) {
    std::vector<std::string> words = {
        "render", "grid",  "--resolution",      "70,50", "--lights",
        "60",     "--aov", "depth,light-count", "-o",    output.string()};
    if (output.extension() != ".exr") words.erase(words.begin() + 6, words.begin() + 8);
    words.insert(words.end(), more.begin(), more.end());
    return run_kilolux(words);
}

// The values of a part of an image.
std::vector<float> values_in(const FloatImage& image, const PixelRect& rect) {
    std::vector<float> out;
    const std::size_t channels = image.channels.size();
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
        const auto first = static_cast<std::ptrdiff_t>(channels) * (y * image.width + rect.x);
        out.insert(
            out.end(), image.values.begin() + first,
            image.values.begin() + first + static_cast<std::ptrdiff_t>(channels) * rect.width);
    }
    return out;
}

TEST(RenderCrop, TilesAreThePictureByShards) {
    const TemporaryFolder folder;
    const TileGrid grid{3, 2};
    for (const char* extension : {".exr", ".png", ".tif"}) {
        const fs::path tiles = folder / (std::string("t.#") + extension);
        const fs::path whole = folder / (std::string("whole") + extension);
        ASSERT_EQ(render(whole, {}).code, 0);
        const FloatImage picture = read_image(whole);
        for (const char* shard : {"0/2", "1/2"}) {
            const ChildResult result = render(tiles, {"--tiles", "3x2", "--shard", shard});
            ASSERT_EQ(result.code, 0) << result.err;
        }
        int pixels = 0;
        for (int i = 0; i < 6; ++i) {
            const PixelRect rect = tile_rect(grid, i, kWidth, kHeight);
            const fs::path file = numbered_file(tiles, i);
            const FloatImage tile = read_image(file);
            ASSERT_EQ(tile.width, rect.width);
            ASSERT_EQ(tile.height, rect.height);
            EXPECT_TRUE(tile.values == values_in(picture, rect)) << file;
            pixels += rect.width * rect.height;
            const std::unique_ptr<ImageReader> opened = open_image(file);
            const ImageLayout& layout = opened->layout();
            const bool has_window = file.extension() == ".exr";
            EXPECT_EQ(layout.full_width, has_window ? kWidth : 0);
            EXPECT_EQ(layout.full_height, has_window ? kHeight : 0);
            EXPECT_EQ(layout.x, has_window ? rect.x : 0);
            EXPECT_EQ(layout.y, has_window ? rect.y : 0);
        }
        EXPECT_EQ(pixels, kWidth * kHeight);
        std::vector<std::string> words = {"assemble", "-o",
                                          (folder / "joined").string() + extension};
        for (int i = 0; i < 6; ++i) words.push_back(numbered_file(tiles, 5 - i).string());
        const ChildResult joined = run_kilolux(words);
        EXPECT_EQ(joined.code, 0) << joined.err;
        EXPECT_TRUE(text_of_file(words[2]) == text_of_file(whole)) << extension;
        const ChildResult again =
            render(tiles, {"--tiles", "3x2", "--skip-existing", "--shard", "1/2"});
        EXPECT_TRUE(contains(again.err, "nothing to render: every file is there")) << again.err;
    }
}

// A shard's tiles, by their numbers and files; lights are those of the picture.
TEST(RenderCrop, StatsNameEachTile) {
    const TemporaryFolder folder;
    const fs::path stats = folder / "stats.json", tiles = folder / "t.#.png";
    ASSERT_EQ(render(tiles, {"--tiles", "2x2", "--shard", "1/2", "--stats", stats.string()}).code,
              0);
    const nlohmann::json document = nlohmann::json::parse(text_of_file(stats));
    ASSERT_EQ(document.at("frames").size(), 2u);
    for (int i = 0; i < 2; ++i) {
        const nlohmann::json& frame = document.at("frames").at(static_cast<std::size_t>(i));
        EXPECT_EQ(frame.at("frame"), 2 * i + 1);
        EXPECT_EQ(frame.at("file"), numbered_file(tiles, 2 * i + 1).string());
        EXPECT_EQ(frame.at("lights").at("given"), document.at("lights").at("given"));
        EXPECT_GT(frame.at("frame_ms"), 0.0);
    }
}

// The pixels of a crop are held until its file is written.
TEST(RenderCrop, WhatDoesNotFitIsRefusedBeforeItIsMade) {
    const TemporaryFolder folder;
    const std::vector<std::string> whole = {"--resolution", "65536,65536", "--max-memory", "1500M"};
    for (const std::vector<std::string>& part :
         {std::vector<std::string>{"--crop", "7,7,8192,8192"}, {"--tiles", "8x8"}}) {
        std::vector<std::string> words = {
            "/usr/bin/timeout",
            "60",
            program_file(),
            "render",
            "grid",
            "-o",
            (folder / (part[0] == "--tiles" ? "a.#.png" : "a.png")).string()};
        words.insert(words.end(), whole.begin(), whole.end());
        words.insert(words.end(), part.begin(), part.end());
        const ChildResult result = run_child(words);
        EXPECT_EQ(result.code, 1) << part[0];
        EXPECT_TRUE(contains(result.err, "memory: 65536x65536 pixels")) << result.err;
    }
}

// The same file, with the same notes.
TEST(RenderCrop, ATileIsACrop) {
    const TemporaryFolder folder;
    for (const char* extension : {".exr", ".png", ".tif"}) {
        const fs::path crop = folder / (std::string("crop") + extension);
        const fs::path tile = folder / (std::string("t.#") + extension);
        ASSERT_EQ(render(crop, {"--crop", "35,25,35,25"}).code, 0);
        ASSERT_EQ(render(tile, {"--tiles", "2x2", "--shard", "3/4"}).code, 0);
        EXPECT_EQ(text_of_file(numbered_file(tile, 3)), text_of_file(crop)) << extension;
    }
    const ChildResult other =
        render(folder / "crop.exr", {"--crop", "34,25,35,25", "--skip-existing"});
    EXPECT_EQ(other.code, 1);
    EXPECT_TRUE(contains(other.err, "holds another picture: its command")) << other.err;
}

TEST(RenderCrop, OnlyTilesOfOnePictureAreJoined) {
    const TemporaryFolder folder;
    const auto file = [&](const char* name) { return (folder / name).string(); };
    ASSERT_EQ(render(file("t.#.png"), {"--tiles", "2x2"}).code, 0);
    ASSERT_EQ(render(file("other.png"), {"--crop", "35,25,35,25", "--ambient", "1"}).code, 0);
    ASSERT_EQ(render(file("between.png"), {"--crop", "30,25,35,25"}).code, 0);
    ASSERT_EQ(render(file("whole.png"), {}).code, 0);
    ASSERT_EQ(render(file("f.#.png"), {"--crop", "35,25,35,25", "--frames", "1"}).code, 0);
    const struct {
        std::vector<const char*> tiles;
        const char* line;
    } cases[] = {
        {{"t.0.png", "t.1.png", "t.2.png", "other.png"}, "are of other pictures"},
        {{"t.0.png", "t.1.png", "t.2.png", "between.png"}, "the tiles before it end at 35,25"},
        {{"t.0.png", "t.1.png", "t.2.png"}, "is 35 pixels wide, the first 70"},
        {{"t.0.png", "t.1.png"}, "ends at 70,25; the picture has 70x50 pixels"},
        {{"t.1.png", "t.2.png", "t.3.png"}, "the tiles before it end at 0,0"},
        {{"t.0.png", "t.0.png"}, "the tiles before it end at 35,0"},
        {{"t.0.png", "t.1.png", "t.2.png", "f.1.png"}, "are of other pictures"},
        {{"whole.png"}, "has no note of a --crop"},
        {{"t.9.png"}, "t.9.png"}};
    for (const auto& c : cases) {
        std::vector<std::string> words = {"assemble", "-o", file("joined.png")};
        for (const char* tile : c.tiles) words.push_back(file(tile));
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_TRUE(contains(result.err, c.line)) << result.err;
        EXPECT_FALSE(fs::exists(file("joined.png")));
    }
    EXPECT_TRUE(contains(run_kilolux({"assemble", "-o", file("joined.exr"), file("t.0.png")}).err,
                         "without loss"));
}

TEST(RenderCrop, RefusesWhatIsNoPart) {
    const TemporaryFolder folder;
    const fs::path one = folder / "a.png", many = folder / "a.#.png";
    const struct {
        fs::path output;
        std::vector<std::string> words;
        const char* line;
    } cases[] = {
        {one, {"--crop", "40,0,31,50"}, "--crop: 40,0,31,50 is no part of a picture of 70x50"},
        {one, {"--crop", "40,0,0,50"}, "--crop: '40,0,0,50' is not X,Y,W,H"},
        {one, {"--tiles", "2x2"}, "has no #### for the tile numbers of --tiles"},
        {one, {"--tiles", "2"}, "--tiles: '2' is not CxR"},
        {many, {"--tiles", "2x2", "--frames", "0:3"}, "leave out --frames"},
        {many, {"--tiles", "2x2", "--crop", "0,0,5,5"}, "--tiles and --crop exclude each other"},
        {many, {"--tiles", "71x1"}, "is no part of a picture of 70x50"},
        {folder / "a.y4m", {"--tiles", "2x2"}, "--tiles: '"}};
    for (const auto& c : cases) {
        const ChildResult result = render(c.output, c.words);
        EXPECT_EQ(result.code, 2) << result.err;
        EXPECT_TRUE(contains(result.err, c.line)) << result.err;
    }
    EXPECT_TRUE(names_in(folder).empty());
}

}  // namespace
}  // namespace kilolux
