// SPDX-License-Identifier: Apache-2.0
// LoadOptions::max_memory_bytes bounds buffers, images and meshes together, a worker's failed
// allocation reaches the caller as an exception, and a frame of an animation allocates little.
#include <gtest/gtest.h>
#include <malloc.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "host/scene/animated_scene.h"
#include "host/scene/generated/scenes.h"
#include "tests/support/gltf_seeds.h"

namespace {

constexpr std::size_t kNever = static_cast<std::size_t>(-1);
std::atomic<std::size_t> refused_from = kNever;  // [byte]; allocations of this size and more fail
std::atomic<std::int64_t> held = 0;              // [byte], by all that is allocated
std::atomic<std::int64_t> most_held = 0;         // since it was last set

// null where it fails
void* allocate(std::size_t bytes) {
    void* memory = bytes >= refused_from.load() ? nullptr : std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr) return nullptr;
    const auto size = static_cast<std::int64_t>(malloc_usable_size(memory) + sizeof(void*));
    const std::int64_t now = held += size;
    std::int64_t most = most_held.load();
    while (most < now && !most_held.compare_exchange_weak(most, now)) {
    }
    return memory;
}

void release(void* memory) {
    if (memory == nullptr) return;
    held -= static_cast<std::int64_t>(malloc_usable_size(memory) + sizeof(void*));
    std::free(memory);
}

}  // namespace

// The compiler inlines these and then takes malloc() and delete for a mismatched pair.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

// Replaces every allocation of this test program, so that those of any thread can fail and count.
void* operator new(std::size_t bytes) {
    void* memory = allocate(bytes);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
// std::stable_sort's; the sanitizer's own would not fit operator delete below.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }

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
    EXPECT_NE(error.find("needs 1 MiB of memory for buffers, images and meshes, 0 MiB of 2 MiB are "
                         "left (--max-memory)"),
              std::string::npos)
        << error;
    EXPECT_EQ(error_with(file_with_images(40), 0), "") << "half of what is available";
}

TEST(LoadSceneMemory, NormalMapsOf16BitsTakeTwice) {
    const std::vector<std::uint16_t> pixels(std::size_t{3} * 256 * 256, 257);
    const Blob png = encode_deep_image("png", 256, 3, pixels);
    for (const char* map : {"emissiveTexture", "normalTexture"}) {
        GltfBuilder file = triangle_file();
        for (int i = 0; i < 4; ++i) {
            file.add("materials", {{map, {{"index", file.add_texture(png, "image/png")}}}});
        }
        const std::string error = error_with(file, 2 << 20);
        EXPECT_EQ(error.find("scene.glb: images[") != std::string::npos,
                  map == std::string("normalTexture"))
            << map << ": " << error;
    }
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

struct Growth {
    std::int64_t bytes = 0;
    std::string error;
};

Growth growth_with(const std::filesystem::path& file, std::uint64_t max_memory_bytes) {
    LoadOptions options;
    options.max_memory_bytes = max_memory_bytes;
    const std::int64_t before = held.load();
    most_held = before;
    Growth out;
    out.error = load_error(file, options);
    out.bytes = most_held - before;
    return out;
}

// `count` times `element` with commas; '#' in it is the element's number.
std::string repeated(const std::string& element, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) {
        if (i > 0) out += ',';
        for (const char c : element) c == '#' ? out += std::to_string(i) : out += c;
    }
    return out;
}

std::string file_of(const std::string& members) {
    return R"({"asset":{"version":"2.0"},)" + members + "}";
}

struct Shape {
    const char* name;
    std::string text;
};

std::vector<Shape> large_files() {
    constexpr int kCount = 6000;
    const auto array = [](const std::string& element, int times = 1) {
        return "[" + repeated(element, times * kCount) + "]";
    };
    const std::string numbers = array("1", 40);
    return {
        {"lights", file_of(R"("nodes":)" + array(R"({"translation":[1,2,#],"rotation":[0,0,0,1],
                 "extensions":{"KHR_lights_punctual":{"light":#}}})") +
                           R"(,"extensions":{"KHR_lights_punctual":{"lights":)" +
                           array(R"({"type":"point","intensity":#,"color":[1,0.5,0.25]})") + "}}")},
        {"empty nodes", file_of(R"("nodes":)" + array("{}", 4))},
        {"children", file_of(R"("nodes":[{"children":[)" + repeated("1", 40 * kCount) + "]},{}]")},
        {"accessors",
         file_of(R"("accessors":)" + array(R"({"componentType":5126,"count":#,"type":"SCALAR"})"))},
        {"samplers", file_of(R"("samplers":)" + array("{}", 4))},
        {"cameras", file_of(R"("cameras":)" + array(R"({"type":"perspective","perspective":
                            {"yfov":1,"znear":1}})"))},
        {"materials", file_of(R"("materials":)" + array(R"({"alphaCutoff":0.5})", 2))},
        {"long names",
         file_of(R"("nodes":)" + array("{\"name\":\"" + std::string(1000, 'n') + "\"}"))},
        {"numbers of an unknown extension",
         file_of(R"("extensions":{"X_y":{"z":)" + numbers + "}}")},
        {"extras", file_of(R"("extras":)" + array(R"({"a":1})", 4))},
        {"pairs in extras", file_of(R"("extras":)" + array("[1,2]", 10))},
        {"one text", file_of(R"("extras":")" + std::string(4 << 20, 'x') + "\"")},
        {"one text of escapes", file_of(R"("extras":")" + repeated("\\n", 20 * kCount) + "\"")},
        {"broken behind its numbers", file_of(R"("extras":)" + numbers + ",:::::::::")},
        {"data", file_of(R"("buffers":[{"byteLength":6000000,"uri":
                         "data:application/octet-stream;base64,)" +
                         std::string(8000000, 'A') + "\"}]")},
    };
}

// Parsed values take many times the memory of their text.
TEST(LoadSceneMemory, JsonIsChargedBeforeItIsParsed) {
    constexpr std::int64_t kOther = 1 << 20;  // messages, and what an almost empty file takes
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "scene.gltf";
    for (const Shape& shape : large_files()) {
        write_file(file, shape.text);
        const Growth free = growth_with(file, std::uint64_t{1} << 40);
        std::int64_t limit = 1 << 20;
        for (; limit < (1 << 30); limit += limit / 2) {
            const Growth bounded = growth_with(file, static_cast<std::uint64_t>(limit));
            EXPECT_LT(bounded.bytes, limit + kOther) << shape.name << " with " << limit;
            if (bounded.error == free.error) break;
            EXPECT_NE(bounded.error.find("--max-memory"), std::string::npos) << bounded.error;
        }
        EXPECT_LT(limit, 4 * free.bytes + kOther) << shape.name << " needs no more than that";
    }
}

// A data URI is decoded where it stands.
TEST(LoadSceneMemory, ADataUriIsThereOnce) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "scene.gltf";
    for (const Shape& shape : large_files()) {
        if (shape.name != std::string("data")) continue;
        write_file(file, shape.text);
        const Growth growth = growth_with(file, 9 << 20);
        EXPECT_EQ(growth.error, "");
        EXPECT_LT(growth.bytes, 9 << 20);
    }
}

// What several decoders borrow at a time is given back: an image that lacks it waits.
TEST(LoadSceneMemory, WhatFitsOnOneThreadFitsOnMany) {
    constexpr int kImages = 24;
    constexpr std::uint64_t kEncoded = 400 << 10;
    const TempFolder folder;
    GltfBuilder file = triangle_file();
    for (int i = 0; i < kImages; ++i) {
        const std::string name = std::to_string(i) + ".png";
        write_file(folder.path() / name,
                   encode_image("png", 64, 3, Blob(std::size_t{3} * 64 * 64)));
        std::filesystem::resize_file(folder.path() / name, kEncoded);
        const int image = file.add("images", {{"uri", name}});
        file.add("materials",
                 {{"emissiveTexture", {{"index", file.add("textures", {{"source", image}})}}}});
    }
    write_file(folder.path() / "scene.gltf", file.gltf());
    LoadOptions options;
    options.max_memory_bytes = kImages * 4 * 64 * 64 + kEncoded + (256 << 10);
    const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 16);
    for (const int threads : {1, 16}) {
        tbb::task_arena arena(threads);
        for (int i = 0; i < 5; ++i) {
            arena.execute([&] {
                EXPECT_EQ(load_error(folder.path() / "scene.gltf", options), "") << threads;
            });
        }
    }
    options.max_memory_bytes -= kEncoded;
    EXPECT_NE(load_error(folder.path() / "scene.gltf", options), "") << "no image fits";
}

}  // namespace
}  // namespace kilolux
