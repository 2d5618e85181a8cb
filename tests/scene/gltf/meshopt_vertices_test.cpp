// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh/meshopt_vertices.h"

#include <gtest/gtest.h>

#include <bit>

#include "tests/support/gltf_compressed.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

constexpr std::size_t kCount = 37, kStride = 20;

// Per element a float, two shorts, four bytes, a constant and noise: each suits another mode.
Blob elements() {
    Blob out;
    std::uint32_t seed = kCount * 31 + kStride;
    const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) >> 8; };
    for (std::uint32_t i = 0; i < kCount; ++i) {
        std::uint32_t words[5] = {std::bit_cast<std::uint32_t>(0.25f * static_cast<float>(i)),
                                  (i * 300) | (60000 - i * 7) << 16, 0, 7, 0};
        for (std::uint32_t k = 0; k < 4; ++k) words[2] |= (i * (k + 1) & 255) << 8 * k;
        words[4] = random() * 256;
        words[4] += random() & 255;
        for (const std::uint32_t word : words) {
            for (int k = 0; k < 4; ++k) out.push_back(static_cast<unsigned char>(word >> 8 * k));
        }
    }
    return out;
}

// Levels 3 and 0 of the encoder of meshoptimizer 1.3: the first with all three channel modes and
// the control modes 0 to 3, the second with byte deltas alone.
const std::vector<Blob>& streams() {
    static const std::vector<Blob> all = {
        hex_bytes(
            "a1689755aaff0102010f1f0a0ffff8f8f4c4f4c4a060103018f81cf262e262f262e2623c1e1f007e0103"
            "010700585858585858585858585858585858585858585858585858585858585858585858585858152aaa"
            "aaaaaaaaaaaaaa8000000a0ddddddddddddddddddddddddddddddd1f000d0d0d0d0d152aaaaaaaaaaaaa"
            "aaaa8000000a044444444444444444444444444444441f0004040404040a066666666666666666666666"
            "666666661f0006060606060a088888888888888888888888888888881f00080808080800c4737e27d5c7"
            "0aec6032954c687c9800c1166702e4fd6456a5c3fbf8a0c68d15b85d4fd30018a0598af8d64e39176506"
            "94e8f0cef007d4a8dce7b76f5a4a4c779b731f9200dc06a82e00e5a18ff87d09c8f1bb16494a198cda5d"
            "d96ee542f5f36d5d2f05578d01f7fc5d52488b66005e8e6e5f3ca24b0bc862ebe8c450f3f658fd76d1d7"
            "7af9f3a760d0c969b5dab71eed98a600000000000060ea00000000070000008f2837b06201000000"),
        hex_bytes(
            "a15a5555aa550f00ffff80804040404020202020202020201010101010101010101010101010101f0010"
            "080808080006017c020200000100020f0058585858585858585858585858585858585858585858585858"
            "5858585858581f005858585858152aaeaaea0404aeaaeaae040404ab800000040a0ddddddddddddddddd"
            "dddddddddddddd1f000d0d0d0d0d0000400100000000152aaaaaaaaaaaaaaaaa8000000a044444444444"
            "444444444444444444441f0004040404040a066666666666666666666666666666661f0006060606060a"
            "088888888888888888888888888888881f0008080808080f00c4737e27d5c70aec6032954c687c9800c1"
            "166702e4fd6456a5c3fbf8a0c68d1f0015b85d4fd30f0018a0598af8d64e3917650694e8f0cef007d4a8"
            "dce7b76f5a4a4c779b731f921e00dc06a82e0f00e5a18ff87d09c8f1bb16494a198cda5dd96ee542f5f3"
            "6d5d2f05578d01f7fc1f005d52488b660f005e8e6e5f3ca24b0bc862ebe8c450f3f658fd76d1d77af9f3"
            "a760d0c969b5da1f00b71eed98a600000000000060ea00000000070000008f2837b00000000000")};
    return all;
}

TEST(MeshoptVertices, DecodeToWhatWasEncoded) {
    for (const Blob& stream : streams()) {
        EXPECT_TRUE(is_vertex_format_1(stream));
        Blob out(kCount * kStride);
        EXPECT_TRUE(decode_vertex_format_1(stream, kStride, out));
        EXPECT_EQ(out, elements());
    }
}

TEST(MeshoptVertices, RefuseStreamsThatAreCutOrHaveMore) {
    Blob out(kCount * kStride);
    for (const Blob& stream : streams()) {
        for (std::size_t size = 0; size < stream.size(); ++size) {
            EXPECT_FALSE(decode_vertex_format_1(ByteSpan(stream).first(size), kStride, out))
                << size;
        }
        Blob longer = stream;
        longer.insert(longer.end() - (kStride + kStride / 4), 0);
        EXPECT_FALSE(decode_vertex_format_1(longer, kStride, out));
        for (const int mode : {0x03, 0x10, 0x11, 0x0f}) {
            Blob other = stream;
            other.back() = static_cast<unsigned char>(mode);
            EXPECT_FALSE(decode_vertex_format_1(other, kStride, out)) << mode;
        }
    }
}

TEST(MeshoptVertices, ColoursOfAnyPrecisionComeBack) {
    // Six bits: luma, Co, Cg and alpha with the bit above it set; black, white, red.
    Blob six = {0, 0, 0, 32, 63, 0, 0, 63, 16, 31, 240, 48};
    undo_color_filter(six, 4);
    EXPECT_EQ(six, (Blob{0, 0, 0, 0, 255, 255, 255, 255, 255, 0, 4, 130}));
    Blob twelve = bytes_of<std::uint16_t>({4095, 0, 0, 4095, 100, 0, 0, 2048});
    undo_color_filter(twelve, 8);
    EXPECT_EQ(twelve, bytes_of<std::uint16_t>({65535, 65535, 65535, 65535, 1600, 1600, 1600, 0}));
}

TEST(LoadSceneMeshopt, ReadsTheKhronosForm) {
    const TempFolder folder;
    const GltfBuilder file = khr_meshopt_quad();
    write_file(folder.path() / "scene.glb", file.glb());
    const Scene scene = load_scene(folder.path() / "scene.glb");
    EXPECT_EQ(scene_defect(scene), "");
    EXPECT_EQ(triangle_count(scene), 2u);
    EXPECT_EQ(world_positions(scene)[2], glm::dvec3(1, 1, 0));
    EXPECT_EQ(scene.meshes[0].colors.at(2), glm::vec4(254, 1, 0, 128) / 255.0f);
    GltfBuilder wrong = file;
    wrong.root["bufferViews"][0]["extensions"]["KHR_meshopt_compression"]["filter"] = "COLOR";
    write_file(folder.path() / "scene.glb", wrong.glb());
    EXPECT_TRUE(
        contains(load_error(folder.path() / "scene.glb"),
                 "KHR_meshopt_compression: byteStride is 12, must be 4 or 8 for filter COLOR"));
}

}  // namespace
}  // namespace kilolux
