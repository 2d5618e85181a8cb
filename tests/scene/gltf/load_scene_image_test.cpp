// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_seeds.h"

namespace kilolux {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// A file whose material shows images[0], which the test adds.
GltfBuilder file_with_image(const json& image) {
    GltfBuilder file = triangle_file();
    file.add("images", image);
    file.add("textures", {{"source", 0}});
    file.add("materials", {{"emissiveTexture", {{"index", 0}}}});
    return file;
}

Image image_from_view(const Blob& encoded) {
    GltfBuilder file = file_with_image(json::object());
    file.root["images"][0] = {{"bufferView", file.add_view(encoded)}, {"mimeType", "image/png"}};
    return load(file).images.at(0);
}

std::string error_of_view(const Blob& encoded) {
    GltfBuilder file = file_with_image(json::object());
    file.root["images"][0] = {{"bufferView", file.add_view(encoded)}, {"mimeType", "image/png"}};
    return load_error(file);
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(LoadSceneImage, KeepsTheColourBehindAlpha) {
    const Blob pixels = {200, 100, 50, 64, 9, 8, 7, 0, 1, 2, 3, 255, 255, 255, 255, 1};
    const Image image = image_from_view(encode_image("png", 2, 4, pixels));
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.rgba, pixels);
}

TEST(LoadSceneImage, NormalMapsKeep16BitsWhereNothingElseReadsTheirImage) {
    const std::vector<std::uint16_t> pixels = {32776, 32768, 65535, 1, 258, 40000};
    GltfBuilder file = triangle_file();
    const int map = file.add_texture(encode_deep_image("png", 2, 3, pixels), "image/png");
    file.add("materials", {{"normalTexture", {{"index", map}}}});
    const Image image = load(file).images.at(0);
    EXPECT_TRUE(image.rgba.empty());
    EXPECT_EQ(image.rgba16,
              (std::vector<std::uint16_t>{32776, 32768, 65535, 65535, 1, 258, 40000, 65535}));
    EXPECT_EQ(image.bytes(), 16u);
    file.add("materials", {{"emissiveTexture", {{"index", map}}}});
    const Image shared = load(file).images.at(0);
    EXPECT_TRUE(shared.rgba16.empty());
    EXPECT_EQ(shared.rgba, (Blob{128, 128, 255, 255, 0, 1, 156, 255}));
}

TEST(LoadSceneImage, ExpandsGreyAndRgb) {
    EXPECT_EQ(image_from_view(encode_image("png", 2, 1, {7, 9})).rgba,
              (Blob{7, 7, 7, 255, 9, 9, 9, 255}));
    EXPECT_EQ(image_from_view(encode_image("png", 1, 2, {7, 9})).rgba, (Blob{7, 7, 7, 9}));
    EXPECT_EQ(image_from_view(encode_image("png", 1, 3, {7, 8, 9})).rgba, (Blob{7, 8, 9, 255}));
}

TEST(LoadSceneImage, ReadsJpegByItsBytesWhateverItsNameSays) {
    const Blob grey(3 * 64, 128);
    const Image image = image_from_view(encode_image("jpeg", 8, 3, grey));
    ASSERT_EQ(image.rgba.size(), 4u * 64u);
    EXPECT_NEAR(image.rgba[0], 128, 2);
    EXPECT_EQ(image.rgba[3], 255);
}

TEST(LoadSceneImage, ReadsWebpThroughItsExtension) {
    GltfBuilder file = file_with_image({{"uri", "fallback, not there.png"}});
    const int webp = file.add(
        "images", {{"bufferView", file.add_view(webp_image())}, {"mimeType", "image/webp"}});
    file.root["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", webp}}}};
    file.root["extensionsUsed"] = {"EXT_texture_webp"};
    file.root["extensionsRequired"] = {"EXT_texture_webp"};
    const Image image = load(file).images.at(0);
    ASSERT_EQ(image.rgba.size(), 4u * 16u);
    EXPECT_EQ(Blob(image.rgba.begin(), image.rgba.begin() + 4), (Blob{200, 100, 50, 64}));
}

TEST(LoadSceneImage, KeepsTheColoursThatAlphaHides) {
    // Lossless, 2x2 pixels, and with loss, 16x16 equal ones of alpha 3: both by libwebp.
    const Blob lossless = {0x52, 0x49, 0x46, 0x46, 0x3a, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42,
                           0x50, 0x56, 0x50, 0x38, 0x4c, 0x2e, 0x00, 0x00, 0x00, 0x2f, 0x01,
                           0x40, 0x00, 0x10, 0x1f, 0x20, 0xa6, 0x21, 0xe6, 0xd2, 0x55, 0x7c,
                           0x69, 0x14, 0xb4, 0x6d, 0xc3, 0xf4, 0xed, 0xf0, 0x07, 0x34, 0x6a,
                           0x53, 0xd0, 0x36, 0x0a, 0x9c, 0xba, 0x17, 0x0c, 0xc0, 0x03, 0xff,
                           0x83, 0x57, 0x77, 0xed, 0xd7, 0x5d, 0xec, 0x42, 0x44, 0xff, 0x23};
    const Blob lossy = {
        0x52, 0x49, 0x46, 0x46, 0x66, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50,
        0x38, 0x58, 0x0a, 0x00, 0x00, 0x00, 0x10, 0x00, 0x00, 0x00, 0x0f, 0x00, 0x00, 0x0f,
        0x00, 0x00, 0x41, 0x4c, 0x50, 0x48, 0x0e, 0x00, 0x00, 0x00, 0x01, 0x07, 0xa0, 0x10,
        0x40, 0x00, 0x14, 0x34, 0x11, 0x11, 0x23, 0x22, 0xfa, 0x1f, 0x56, 0x50, 0x38, 0x20,
        0x32, 0x00, 0x00, 0x00, 0xd0, 0x01, 0x00, 0x9d, 0x01, 0x2a, 0x10, 0x00, 0x10, 0x00,
        0x00, 0xc0, 0x12, 0x25, 0xa0, 0x02, 0x74, 0xba, 0x01, 0xf8, 0x00, 0x03, 0xb0, 0x00,
        0xfe, 0xda, 0x26, 0xff, 0xee, 0xf3, 0x7e, 0xd3, 0xd7, 0xb4, 0xf5, 0xfd, 0x4c, 0xff,
        0xf8, 0xca, 0x9f, 0x20, 0x3f, 0xe3, 0x2a, 0x7f, 0xc5, 0xcc, 0x00, 0x00};
    GltfBuilder file = triangle_file();
    for (const Blob& webp : {lossless, lossy}) {
        const int texture = file.add_texture(webp, "image/webp");
        file.add("materials", {{"emissiveTexture", {{"index", texture}}}});
    }
    const Scene scene = load(file);
    EXPECT_EQ(scene.images.at(0).rgba,
              (Blob{200, 100, 50, 0, 10, 250, 30, 1, 7, 8, 9, 128, 255, 1, 2, 255}));
    EXPECT_EQ(Blob(scene.images.at(1).rgba.begin(), scene.images.at(1).rgba.begin() + 4),
              (Blob{201, 100, 50, 3}));
}

TEST(LoadSceneImage, TakesWebpWhereTheFileOffersBoth) {
    GltfBuilder file = triangle_file();
    const int texture = file.add_texture(encode_image("png", 1, 3, {1, 2, 3}), "image/png");
    file.add("materials", {{"emissiveTexture", {{"index", texture}}}});
    const int webp = file.add(
        "images", {{"bufferView", file.add_view(webp_image())}, {"mimeType", "image/webp"}});
    file.root["extensionsUsed"] = {"EXT_texture_webp"};
    EXPECT_EQ(load(file).images.at(0).width, 1) << "this texture does not use it";
    file.root["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", webp}}}};
    EXPECT_EQ(load(file).images.at(0).width, 4);
    EXPECT_EQ(load(file).images.size(), 1u) << "the PNG is not decoded";
    file.root["textures"][0].erase("source");
    EXPECT_EQ(load(file).images.at(0).width, 4);
    file.root["textures"][0].erase("extensions");
    EXPECT_FALSE(load(file).materials.at(0).emissive_texture.present()) << "no image at all";
}

TEST(LoadSceneImage, ReadsFilesWithSpacesAndEscapes) {
    const TempFolder folder;
    const Blob png = encode_image("png", 1, 3, {1, 2, 3});
    std::filesystem::create_directory(folder.path() / "my maps");
    write_file(folder.path() / "my maps" / "a b.png", png);
    write_file(folder.path() / "100%25.png", png);
    for (const char* uri : {"my maps/a b.png", "my%20maps/a%20b.png",
                            "./my%20maps/../my maps/a b.png", "100%25.png"}) {
        write_file(folder.path() / "scene.gltf", file_with_image({{"uri", uri}}).gltf());
        EXPECT_EQ(load_error(folder.path() / "scene.gltf"), "") << uri;
    }
}

TEST(LoadSceneImage, ReadsDataUris) {
    // A 1x1 PNG of (255, 0, 0).
    const std::string png =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"
        "pLvAAAAAElFTkSuQmCC";
    const Scene scene = load(file_with_image({{"uri", "data:image/png;base64," + png}}));
    EXPECT_EQ(scene.images.at(0).rgba, (Blob{255, 0, 0, 255}));
    const std::string error =
        load_error(file_with_image({{"uri", "data:image/png;base64,iVB!w0KG"}}));
    EXPECT_TRUE(contains(error, "images[0]: data URI holds broken base64")) << error;
}

TEST(LoadSceneImage, NamesAMissingFile) {
    const std::string error = load_error(file_with_image({{"uri", "wood%20floor.png"}}));
    EXPECT_TRUE(contains(error, "images[0]: file 'wood%20floor.png': no such file")) << error;
}

TEST(LoadSceneImage, StaysInTheSceneFilesFolder) {
    const TempFolder folder;
    write_file(folder.path() / "outside.png", encode_image("png", 1, 3, {1, 2, 3}));
    std::filesystem::create_directory(folder.path() / "scene");
    const std::filesystem::path file = folder.path() / "scene" / "scene.gltf";
    const std::string absolute = (folder.path() / "outside.png").string();
    for (const std::string& uri :
         {std::string("../outside.png"), std::string("..%2Foutside.png"), absolute,
          std::string("x/../../outside.png"), std::string("%2E%2E/outside.png")}) {
        write_file(file, file_with_image({{"uri", uri}}).gltf());
        const std::string error = load_error(file);
        EXPECT_TRUE(contains(error, "leaves the scene file's folder")) << uri << ": " << error;
    }
    LoadOptions options;
    options.allow_outside_paths = true;
    for (const std::string& uri : {std::string("../outside.png"), absolute}) {
        write_file(file, file_with_image({{"uri", uri}}).gltf());
        EXPECT_EQ(load_error(file, options), "") << uri;
    }
}

TEST(LoadSceneImage, RefusesLinksOutOfTheSceneFilesFolder) {
    const TempFolder folder;
    const fs::path scenes = folder.path() / "scenes";
    fs::create_directories(scenes / "maps");
    fs::create_directory(folder.path() / "elsewhere");
    const Blob png = encode_image("png", 1, 3, {1, 2, 3});
    write_file(folder.path() / "elsewhere" / "a.png", png);
    write_file(scenes / "maps" / "a.png", png);
    fs::create_symlink("../elsewhere/a.png", scenes / "file link.png");
    fs::create_directory_symlink(folder.path() / "elsewhere", scenes / "folder link");
    fs::create_symlink("maps/a.png", scenes / "inner link.png");
    fs::create_symlink("nowhere.png", scenes / "broken.png");
    fs::create_directory_symlink(scenes, folder.path() / "linked scenes");
    const auto error_of = [&](const char* uri, const LoadOptions& options = {}) {
        write_file(scenes / "scene.gltf", file_with_image({{"uri", uri}}).gltf());
        return load_error(scenes / "scene.gltf", options);
    };
    LoadOptions outside;
    outside.allow_outside_paths = true;
    for (const char* uri :
         {"file%20link.png", "folder link/a.png", "maps/../folder%20link/a.png"}) {
        EXPECT_TRUE(contains(error_of(uri), "leaves the scene file's folder")) << uri;
        EXPECT_EQ(error_of(uri, outside), "") << uri;
    }
    EXPECT_EQ(error_of("inner link.png"), "");
    EXPECT_TRUE(contains(error_of("broken.png"), "no such file"));
    error_of("maps/a.png");
    EXPECT_EQ(load_error(folder.path() / "linked scenes" / "scene.gltf"), "")
        << "the folder itself";
}

TEST(LoadSceneImage, RefusesUrisThatAreNoFiles) {
    for (const char* uri :
         {"https://example.com/a.png", "file:///etc/passwd", ".", "", "a%00.png"}) {
        EXPECT_NE(load_error(file_with_image({{"uri", uri}})), "") << uri;
    }
}

TEST(LoadSceneImage, RefusesBrokenImages) {
    const Blob png = encode_image("png", 16, 3, Blob(3 * 256, 77));
    const Blob half(png.begin(), png.begin() + static_cast<std::ptrdiff_t>(png.size() / 2));
    EXPECT_TRUE(contains(error_of_view(half), "images[0]")) << error_of_view(half);
    const Blob noise = {1, 2, 3, 4, 5, 6, 7, 8};
    EXPECT_TRUE(contains(error_of_view(noise), "images[0]: is of no image format"));
}

// libpng prints messages of its own, which must not reach standard error.
TEST(LoadSceneImage, BrokenPngsSayNothingButTheirError) {
    const Blob good = encode_image("png", 5, 3, Blob(3 * 25, 77));
    std::size_t refused = 0;
    testing::internal::CaptureStderr();
    for (std::size_t i = 1; i < good.size(); ++i) {
        const Blob cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(i));
        Blob bent = good;
        bent[i] = static_cast<unsigned char>(bent[i] ^ 0x11u);
        for (const Blob& broken : {cut, bent}) {
            const std::string error = error_of_view(broken);
            refused += error.empty() ? 0 : 1;
            EXPECT_TRUE(error.empty() || contains(error, "images[0]: ")) << i << ": " << error;
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(refused, good.size());
}

TEST(LoadSceneImage, PassesWhatIsWrongBesideAPngsPixels) {
    const Blob good = encode_image("png", 2, 4, {200, 100, 50, 64, 9, 8, 7, 0});
    // After the header of 8 + 25 bytes: a gamma with a wrong checksum, and text that is none.
    Blob odd(good.begin(), good.begin() + 33);
    for (const char* type : {"gAMA", "zTXt"}) {
        odd.insert(odd.end(), {0, 0, 0, 4});
        odd.insert(odd.end(), type, type + 4);
        odd.insert(odd.end(), 8, 0xee);
    }
    odd.insert(odd.end(), good.begin() + 33, good.end() - 12);  // and no end
    testing::internal::CaptureStderr();
    EXPECT_EQ(image_from_view(odd).rgba, (Blob{200, 100, 50, 64, 9, 8, 7, 0}));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    Blob critical = odd;
    critical[33 + 4] = 'G';  // a chunk that decoders must know
    EXPECT_TRUE(
        contains(error_of_view(critical), "images[0]: chunk GAMA at byte 33 is of no type"));
    Blob bent = good;
    bent[20] ^= 1;
    EXPECT_TRUE(contains(error_of_view(bent), "images[0]: chunk IHDR at byte 8 is damaged"));
    const Blob cut(good.begin(), good.end() - 14);
    EXPECT_TRUE(contains(error_of_view(cut), "images[0]: is cut off in the chunk at byte "));
}

TEST(LoadSceneImage, RefusesAbsurdSizesBeforeDecoding) {
    // A PNG header alone: signature, IHDR with its checksum, 8-bit RGB.
    const auto header = [](unsigned char w1, unsigned char w2, const Blob& crc) {
        Blob png = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13, 'I', 'H', 'D',
                    'R',  0,   w1,  w2,  0,  0,  w1, w2, 0, 8, 2, 0,  0,   0};
        png.insert(png.end(), crc.begin(), crc.end());
        const Blob no_pixels = {0, 0, 0, 0, 'I', 'D', 'A', 'T', 0x35, 0xaf, 0x06, 0x1e,
                                0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
        png.insert(png.end(), no_pixels.begin(), no_pixels.end());
        return png;
    };
    const std::string large = error_of_view(header(0, 0x41, {0x41, 0x53, 0x53, 0xa7}));
    EXPECT_TRUE(contains(large, "16640x16640")) << large;
    const std::string packed = error_of_view(header(0, 0x40, {0x26, 0xaa, 0x87, 0xd3}));
    EXPECT_TRUE(contains(packed, "claims 16384x16384 pixels in")) << packed;
}

}  // namespace
}  // namespace kilolux
