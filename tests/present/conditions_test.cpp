// SPDX-License-Identifier: Apache-2.0
#include "present/cli/conditions.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "host/base/error.h"
#include "present/commands/picture_files.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

std::string content_of(const std::filesystem::path& scene, const std::string& environment = "") {
    SharedOptions options;
    options.scene = scene.string();
    options.environment = environment;
    return scene_content(options);
}

TEST(SceneContent, ChangesWithEveryFileOfTheScene) {
    const TemporaryFolder folder;
    const std::string json =
        R"({"buffers":[{"uri":"a%20b.bin"},{"uri":"data:x"}],"images":[{"uri":"t.png"}],
            "extensions":{"EXT_lights_ies":{"lights":[{"uri":"lamp.ies"}]}}})";
    const auto word = [](std::size_t value) {
        const auto narrow = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&narrow), 4);
    };
    write_text(folder / "s.gltf", json);
    write_text(folder / "s.glb",
               "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json);
    constexpr const char* kFiles[] = {"a b.bin", "t.png", "lamp.ies", "sky.hdr"};
    const std::string sky = (folder / "sky.hdr").string();
    for (const char* scene : {"s.gltf", "s.glb"}) {
        for (const char* name : kFiles) write_text(folder / name, "1");
        std::set<std::string> seen = {content_of(folder / scene, sky)};
        EXPECT_EQ(content_of(folder / scene, sky), *seen.begin());
        for (const char* name : kFiles) {
            // Another byte, then another size.
            for (const char* text : {"2", "22"}) {
                write_text(folder / name, text);
                EXPECT_TRUE(seen.insert(content_of(folder / scene, sky)).second)
                    << scene << " " << name << " " << text;
            }
        }
    }
}

TEST(SceneContent, IsThatOfACopyElsewhere) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "copy");
    for (const char* place : {"", "copy"}) {
        write_text(folder.path() / place / "s.gltf", R"({"buffers":[{"uri":"a.bin"}]})");
        write_text(folder.path() / place / "a.bin", "12345");
    }
    EXPECT_EQ(content_of(folder / "s.gltf"), content_of(folder.path() / "copy" / "s.gltf"));
}

TEST(InputContent, ChangesWithEachFileThatAnOptionOfThePictureNames) {
    const TemporaryFolder folder;
    const std::string file = (folder / "input").string();
    std::set<std::string> seen;
    RenderOptions all;
    for (const Setting& row : settings_of(all)) {
        const bool changes_picture = row.text.effect.changes == Changes::picture;
        if (row.kind != SettingKind::input_file) {
            EXPECT_FALSE(changes_picture && row.text.form.starts_with("FILE")) << row.option();
            continue;
        }
        RenderOptions options;
        const std::vector<Setting> settings = settings_of(options);
        for (const Setting& setting : settings) {
            if (setting.option() == row.option()) setting.take(file);
        }
        const auto content_with = [&](const char* text) {
            write_text(file, text);
            return input_content(options.shared, settings);
        };
        EXPECT_EQ(content_with("1") != content_with("2"), changes_picture) << row.option();
        seen.insert(row.option());
    }
    EXPECT_EQ(seen,
              (std::set<std::string>{"SCENE", "--environment", "--camera-keys", "--reference"}));
}

// The loader's bound holds, with its message.
TEST(InputContent, ReadsNoMoreThanTheBoundOfMemory) {
    const TemporaryFolder folder;
    SharedOptions options;
    options.scene = (folder / "s.gltf").string();
    options.settings.max_memory_bytes = 1 << 20;
    const auto message_of_size = [&](std::size_t bytes) -> std::string {
        write_text(options.scene, R"({"asset":{"version":"2.0"}})" + std::string(bytes, ' '));
        try {
            scene_content(options);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message_of_size(1 << 19), "");
    EXPECT_EQ(message_of_size(3 << 20),
              options.scene +
                  ": needs 4 MiB of memory for buffers, images and meshes, 1 MiB of 1 "
                  "MiB are left (--max-memory)");
}

TEST(SceneContent, OfFilesWithoutEndAndDocumentsWithoutBottom) {
    const TemporaryFolder folder;
    write_text(folder / "s.gltf", R"({"buffers":[{"uri":"/dev/zero"}]})");
    EXPECT_NE(content_of(folder / "s.gltf"), "");
    constexpr std::size_t kLevels = 1'000'000;
    write_text(folder / "s.gltf", std::string(kLevels, '[') + std::string(kLevels, ']'));
    EXPECT_NE(content_of(folder / "s.gltf"), "");
    // Some writers do not encode URIs.
    write_text(folder / "s.gltf", R"({"buffers":[{"uri":"a%20b.bin"}]})");
    write_text(folder / "a%20b.bin", "1");
    const std::string before = content_of(folder / "s.gltf");
    write_text(folder / "a%20b.bin", "2");
    EXPECT_NE(content_of(folder / "s.gltf"), before);
}

TEST(SceneContent, OfWhatIsNoSceneFile) {
    const TemporaryFolder folder;
    EXPECT_EQ(content_of("atrium"), "atrium");
    for (const char* text : {"", "glTF", "[1]", R"({"buffers":[{"uri":3},1],"images":{"a":1}})"}) {
        write_text(folder / "s.gltf", text);
        EXPECT_NE(content_of(folder / "s.gltf"), "") << text;
    }
}

TEST(Conditions, DifferWhereEitherHasMore) {
    const nlohmann::ordered_json less = {{"a", 1}}, more = {{"a", 1}, {"b", "x"}};
    EXPECT_EQ(first_difference(less, less), "");
    EXPECT_EQ(first_difference(less, more), "b was missing, is \"x\"");
    EXPECT_EQ(first_difference(more, less), "b was \"x\", is missing");
}

}  // namespace
}  // namespace kilolux
