// SPDX-License-Identifier: Apache-2.0
#include "present/cli/scene_fingerprint.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

TEST(SceneFingerprint, ChangesWithEveryFileOfTheScene) {
    const TemporaryFolder folder;
    const std::string json =
        R"({"buffers":[{"uri":"a%20b.bin"},{"uri":"data:x"}],"images":[{"uri":"t.png"}]})";
    write_text(folder / "s.gltf", json);
    write_text(folder / "a b.bin", "1");
    write_text(folder / "t.png", "1");
    const auto word = [](std::size_t value) {
        const auto narrow = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&narrow), 4);
    };
    write_text(folder / "s.glb",
               "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json);
    for (const char* scene : {"s.gltf", "s.glb"}) {
        const std::string path = (folder / scene).string();
        std::set<std::string> seen = {scene_fingerprint(path)};
        EXPECT_EQ(scene_fingerprint(path), *seen.begin());
        for (const char* name : {"a b.bin", "t.png"}) {
            write_text(folder / name, text_of_file(folder / name) + "2");
            EXPECT_TRUE(seen.insert(scene_fingerprint(path)).second) << scene << " " << name;
        }
    }
}

TEST(SceneFingerprint, OfWhatIsNoSceneFile) {
    const TemporaryFolder folder;
    EXPECT_EQ(scene_fingerprint("atrium"), "atrium");
    for (const char* text : {"", "glTF", "[1]", R"({"buffers":[{"uri":3},1],"images":{"a":1}})"}) {
        write_text(folder / "s.gltf", text);
        EXPECT_NE(scene_fingerprint((folder / "s.gltf").string()), "") << text;
    }
}

}  // namespace
}  // namespace kilolux
