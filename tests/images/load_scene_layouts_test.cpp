// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/support/gltf_builder.h"

// All rows of an image are read, for any layout of its file.

namespace kilolux {
namespace {

struct Stored {
    const char* format;
    int channels;
    int rows_per_strip = 0;  // of TIFF; 0: the writer's
    int tile = 0;            // side of a tile [pixel]; 0: rows
    int first_row = 0;       // of an EXR's data window
    OIIO::TypeDesc type = OIIO::TypeDesc::UINT8;
};

Blob encode(const Stored& how, int width, int height, const Blob& pixels) {
    Blob out;
    OIIO::Filesystem::IOVecOutput writer(out);
    const auto output = OIIO::ImageOutput::create(how.format);
    OIIO::ImageSpec spec(width, height, how.channels, how.type);
    spec.y = how.first_row;
    spec.tile_width = spec.tile_height = how.tile;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (how.rows_per_strip != 0) spec.attribute("tiff:RowsPerStrip", how.rows_per_strip);
    if (!output || !output->set_ioproxy(&writer) ||
        !output->open(std::string("image.") + how.format, spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) || !output->close()) {
        throw std::runtime_error(std::string("cannot encode ") + how.format);
    }
    return out;
}

Blob as_rgba(const Blob& pixels, std::size_t channels) {
    Blob out;
    for (std::size_t i = 0; i < pixels.size(); i += channels) {
        const std::size_t green = channels < 3 ? i : i + 1;
        const std::size_t blue = channels < 3 ? i : i + 2;
        const unsigned char alpha = channels % 2 == 0 ? pixels[i + channels - 1] : 255;
        out.insert(out.end(), {pixels[i], pixels[green], pixels[blue], alpha});
    }
    return out;
}

class LoadSceneLayouts : public testing::TestWithParam<Stored> {};

TEST_P(LoadSceneLayouts, AllArrive) {
    const Stored& how = GetParam();
    const auto channels = static_cast<std::size_t>(how.channels);
    std::mt19937 random(3);
    std::uniform_int_distribution<int> byte(0, 255);
    for (const int height : {1, 63, 64, 65, 131}) {
        constexpr int kLayoutWidth = 37;
        Blob pixels(static_cast<std::size_t>(kLayoutWidth * height) * channels);
        for (unsigned char& value : pixels) value = static_cast<unsigned char>(byte(random));
        GltfBuilder file = triangle_file();
        const int image = file.add_texture(encode(how, kLayoutWidth, height, pixels), "image/png");
        file.add("materials", {{"emissiveTexture", {{"index", image}}}});
        const Scene scene = load(file);
        EXPECT_EQ(scene.images.at(0).width, kLayoutWidth);
        EXPECT_EQ(scene.images.at(0).height, height);
        EXPECT_TRUE(scene.images.at(0).rgba == as_rgba(pixels, channels)) << height << " rows";
    }
}

INSTANTIATE_TEST_SUITE_P(Files, LoadSceneLayouts,
                         testing::Values(Stored{"png", 1}, Stored{"png", 2}, Stored{"png", 3},
                                         Stored{"png", 4}, Stored{"bmp", 3}, Stored{"tiff", 3},
                                         Stored{"tiff", 3, 1}, Stored{"tiff", 3, 7},
                                         Stored{"tiff", 4, 1000}, Stored{"tiff", 3, 0, 32},
                                         Stored{"openexr", 3, 0, 0, 0, OIIO::TypeDesc::FLOAT},
                                         Stored{"openexr", 3, 0, 32, 0, OIIO::TypeDesc::FLOAT},
                                         Stored{"openexr", 3, 0, 0, 40, OIIO::TypeDesc::FLOAT},
                                         Stored{"openexr", 3, 0, 0, -40, OIIO::TypeDesc::FLOAT}),
                         [](const auto& stored) {
                             const Stored& how = stored.param;
                             return std::string(how.format) + std::to_string(how.channels) +
                                    "Strip" + std::to_string(how.rows_per_strip) + "Tile" +
                                    std::to_string(how.tile) + "From" +
                                    (how.first_row < 0 ? "Above" : std::to_string(how.first_row));
                         });

}  // namespace
}  // namespace kilolux
