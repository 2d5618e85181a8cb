// SPDX-License-Identifier: Apache-2.0
// LoadOptions::max_memory_bytes bounds buffers, images and meshes together, a worker's failed
// allocation reaches the caller as an exception, and a frame of an animation allocates little.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "host/scene/animated_scene.h"
#include "host/scene/generated/scenes.h"
#include "tests/support/gltf_seeds.h"

namespace {

constexpr std::size_t kNever = static_cast<std::size_t>(-1);
std::atomic<std::size_t> refused_from = kNever;  // [byte]; allocations of this size and more fail

}  // namespace

// The compiler inlines these and then takes malloc() and delete for a mismatched pair.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

// Replaces every allocation of this test program, so that those of any thread can fail.
void* operator new(std::size_t bytes) {
    void* memory = bytes >= refused_from.load() ? nullptr : std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
// std::stable_sort's; the sanitizer's own would not fit operator delete below.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    return bytes >= refused_from.load() ? nullptr : std::malloc(bytes > 0 ? bytes : 1);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace kilolux {
namespace {

std::string error_with(const GltfBuilder& file, std::uint64_t bytes) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", file.glb());
    LoadOptions options;
    options.max_memory_bytes = bytes;
    return load_error(folder.path() / "scene.glb", options);
}

// A file of `images` images of 256x256 pixels: 256 KiB each once decoded, little encoded.
GltfBuilder file_with_images(int images) {
    GltfBuilder file = triangle_file();
    const Blob png = encode_image("png", 256, 3, Blob(std::size_t{3} * 256 * 256, 77));
    for (int i = 0; i < images; ++i) {
        file.add("materials",
                 {{"emissiveTexture", {{"index", file.add_texture(png, "image/png")}}}});
    }
    return file;
}

TEST(LoadSceneMemory, BoundsImagesTogether) {
    EXPECT_EQ(error_with(file_with_images(4), 2 << 20), "");
    const std::string error = error_with(file_with_images(40), 2 << 20);
    EXPECT_NE(error.find("scene.glb: images["), std::string::npos) << error;
    EXPECT_NE(error.find("needs 1 MiB of memory, 0 MiB of 2 MiB for buffers, images and meshes are "
                         "left (--max-memory)"),
              std::string::npos)
        << error;
    EXPECT_EQ(error_with(file_with_images(40), 0), "") << "half of what is available";
}

TEST(LoadSceneMemory, BoundsBuffersBeforeTheyAreRead) {
    GltfBuilder file = triangle_file();
    file.add_view(Blob(3 << 20));
    EXPECT_EQ(error_with(file, 4 << 20), "");
    const std::string error = error_with(file, 2 << 20);
    EXPECT_NE(error.find("scene.glb: needs 4 MiB of memory"), std::string::npos) << error;
}

TEST(LoadSceneMemory, BoundsMeshes) {
    GltfBuilder file = triangle_file();
    file.primitive()["attributes"].erase("NORMAL");
    std::vector<float> points(90000);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<float>(i % 7);
    file.primitive()["attributes"]["POSITION"] = file.add_floats("VEC3", points);
    EXPECT_EQ(error_with(file, 64 << 20), "");
    const std::string error = error_with(file, 2 << 20);
    EXPECT_NE(error.find("meshes[0].primitives[0]: needs"), std::string::npos) << error;
}

// A moving mesh's charge is given back before it is made anew.
TEST(LoadSceneMemory, ManyTimesFitWhereOneDoes) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", every_feature_file().glb());
    LoadOptions options;
    options.max_memory_bytes = 256 << 10;
    AnimatedScene scene(folder.path() / "scene.glb", options);
    for (int i = 1; i < 1000; ++i) scene.set_time(i / 500.0);
    EXPECT_EQ(scene_defect(scene.scene()), "");
}

// To decode them anew would need their room.
TEST(LoadSceneMemory, AFrameDecodesNoKeyTimesAnew) {
    constexpr std::size_t kKeys = 100000;
    std::vector<float> times(kKeys), path(3 * kKeys);
    for (std::size_t i = 0; i < kKeys; ++i) times[i] = path[3 * i] = static_cast<float>(i);
    GltfBuilder file = triangle_file();
    file.add(
        "animations",
        {{"samplers",
          {{{"input", file.add_floats("SCALAR", times)},
            {"output", file.add_floats("VEC3", path)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", file.glb());
    AnimatedScene scene(folder.path() / "scene.glb", {0.5});
    refused_from = kKeys * sizeof(float);
    EXPECT_NO_THROW(scene.set_time(99.5));
    refused_from = kNever;
    EXPECT_EQ(scene.scene().instances.at(0).world_from_object[3].x, 99.5);
}

TEST(LoadSceneMemory, WorkersThatGetNoMemoryThrowToTheCaller) {
    const TempFolder folder;
    write_file(folder.path() / "scene.glb", file_with_images(16).glb());
    const auto expect_bad_alloc = [](const auto& work) {
        refused_from = 64 << 10;
        EXPECT_THROW(work(), std::bad_alloc);
        refused_from = kNever;
    };
    expect_bad_alloc([] { make_generated_scene("atrium"); });
    expect_bad_alloc([&] { load_scene(folder.path() / "scene.glb"); });
    EXPECT_EQ(load_error(folder.path() / "scene.glb"), "");
}

}  // namespace
}  // namespace kilolux
