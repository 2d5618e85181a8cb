// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "host/base/system/parallel.h"
#include "host/scene/animated_scene.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using Threads = tbb::global_control;

// Threads that loading uses while the result lives, the calling one among them.
Threads limit_threads(std::size_t count) {
    return Threads(Threads::max_allowed_parallelism, count);
}

// Meshes that need tangents, with images of all sizes and formats.
GltfBuilder large_file() {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> byte(0, 255);
    GltfBuilder file = quad_with_normal_map();
    const nlohmann::json mesh = file.root["meshes"][0];
    const nlohmann::json material = file.root["materials"][0];
    for (int i = 0; i < 24; ++i) {
        const int channels = 1 + i % 4;
        const int width = 3 + 11 * (i % 5);
        Blob pixels(static_cast<std::size_t>(width * channels * (1 + 29 * (i % 7))));
        for (unsigned char& value : pixels) value = static_cast<unsigned char>(byte(random));
        const bool jpeg = channels == 3 && i % 8 == 2;
        const Blob encoded = encode_image(jpeg ? "jpeg" : "png", width, channels, pixels);
        nlohmann::json own = material;
        own["emissiveTexture"] = {{"index", file.add_texture(encoded, "image/png")}};
        nlohmann::json copy = mesh;
        copy["primitives"][0]["material"] = file.add("materials", own);
        file.add_node({{"mesh", file.add("meshes", copy)}});
    }
    return file;
}

void expect_same(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.images.size(), b.images.size());
    for (std::size_t i = 0; i < a.images.size(); ++i) {
        EXPECT_EQ(a.images[i].width, b.images[i].width) << "images[" << i << "]";
        EXPECT_EQ(a.images[i].rgba, b.images[i].rgba) << "images[" << i << "]";
    }
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions) << "meshes[" << i << "]";
        EXPECT_EQ(a.meshes[i].tangents, b.meshes[i].tangents) << "meshes[" << i << "]";
        EXPECT_EQ(a.meshes[i].indices, b.meshes[i].indices) << "meshes[" << i << "]";
        EXPECT_EQ(a.meshes[i].material, b.meshes[i].material) << "meshes[" << i << "]";
    }
}

TEST(LoadSceneParallel, GivesTheSameSceneOnAnyNumberOfThreads) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "scene.glb";
    write_file(file, large_file().glb());
    const auto loaded = [&](std::size_t count) {
        const Threads threads = limit_threads(count);
        return load_scene(file);
    };
    const Scene alone = loaded(1);
    ASSERT_EQ(alone.images.size(), 25u);
    for (const std::size_t count : {2u, 4u, 16u}) {
        SCOPED_TRACE(std::to_string(count) + " threads");
        expect_same(alone, loaded(count));
    }
}

TEST(LoadSceneParallel, NamesTheFirstBrokenImageOnAnyNumberOfThreads) {
    GltfBuilder file = large_file();
    for (const std::size_t image : {9u, 17u, 20u}) file.root["images"][image]["bufferView"] = 0;
    const std::string alone = [&] {
        const Threads threads = limit_threads(1);
        return load_error(file);
    }();
    EXPECT_NE(alone.find("images[9]: is of no image format"), std::string::npos) << alone;
    for (int repeat = 0; repeat < 8; ++repeat) {
        const Threads threads = limit_threads(4);
        const std::string error = load_error(file);
        EXPECT_EQ(error.substr(error.rfind('/')), alone.substr(alone.rfind('/')));
    }
}

TEST(LoadSceneParallel, TellsEveryImageOnceAndInOrder) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", large_file().glb());
    const Threads threads = limit_threads(4);
    std::vector<std::size_t> counts;
    const AnimatedScene scene(folder.path() / "scene.glb", {},
                              [&](std::size_t done, std::size_t total) {
                                  counts.push_back(done);
                                  EXPECT_EQ(total, 25u);
                              });
    ASSERT_EQ(counts.size(), 26u);
    for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_EQ(counts[i], i);
}

TEST(LoadSceneParallel, DoesAllWorkBesideWhatFails) {
    const Threads threads = limit_threads(4);
    std::vector<int> done(100, 0);
    const auto work = [&](std::size_t i) {
        done[i] = 1;
        if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
    };
    try {
        parallel_each(done.size(), work);
        ADD_FAILURE() << "nothing thrown";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "7");
    }
    EXPECT_EQ(done, std::vector<int>(100, 1));
}

}  // namespace
}  // namespace kilolux
