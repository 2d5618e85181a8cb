// SPDX-License-Identifier: Apache-2.0
// The panel's choice of the lights of emissive surfaces: the window shows what `kilolux render
// --emissive-lights` makes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/lit_hall.h"
#include "tests/support/messages.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

// A room with a lamp that glows and, if asked for, a light.
Scene glowing_room(bool with_light) {
    Scene scene = box_scene({6.0, 3.0, 6.0}, true);
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].emissive = {9.0f, 6.0f, 3.0f};
    scene.meshes.push_back(box_mesh(glm::dvec3(0.5)));
    scene.meshes[1].material = 1;
    glm::dmat4 place(1.0);
    place[3] = {0.4, 0.8, 0.0, 1.0};
    scene.instances.push_back({1, place});
    if (with_light) {
        SceneLight light;
        light.position = {-1.0, 0.5, 1.0};
        light.range = 5.0f;
        scene.lights.push_back(light);
    }
    SceneCamera camera;
    camera.world_from_camera[3] = {0.0, 0.0, 2.8, 1.0};
    camera.y_fov = 1.2;
    scene.cameras.push_back(camera);
    return scene;
}

class EmissiveLightsOfTheWindow : public testing::Test {
 protected:
    ChildResult view(const Script& script, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"view",     room_.string(), "--resolution", "700,420",
                                          "--rig",    "none",         "--samples",    "1",
                                          "--script", script.write()};
        words.insert(words.end(), more.begin(), more.end());
        return view_in_display(
            {"--chdir=" + folder_.path().string(), "XDG_CONFIG_HOME=" + folder_.path().string()},
            words);
    }
    void play_with(const Script& script, std::vector<std::string> more = {}) const {
        more.emplace_back("-q");
        const ChildResult result = view(script, more);
        ASSERT_EQ(result.code, 0) << result.err << result.out;
        EXPECT_EQ(result.err, "");
    }
    ScenePart shown(const std::string& name) const { return scene_part(folder_ / (name + ".png")); }
    // The screenshot shows what the command line renders.
    void expect(const std::string& name, std::vector<std::string> options) const {
        options.insert(options.end(), {"--rig", "none"});
        EXPECT_EQ(shown(name).values,
                  rendered(folder_ / "rendered.png", options, room_.string()).values)
            << name;
    }
    nlohmann::json kept() const {
        return nlohmann::json::parse(text_of_file(folder_ / "kilolux" / "view.json"));
    }
    void write_room(bool with_light) const { write_scene(glowing_room(with_light), room_); }

    TemporaryFolder folder_;
    fs::path room_ = folder_ / "room.gltf";
};

TEST_F(EmissiveLightsOfTheWindow, AreThoseOfTheChoice) {
    write_room(true);
    Script script(folder_);
    script.shot("start");
    for (const char* name : {"on", "off", "auto"}) {
        script.line(std::string("choose emissive ") + name).line("away").shot(name);
    }
    // With a change of another light on its way.
    script.line("open scene lights").line("type light number 0").line("type light intensity 0");
    script.line("choose emissive on").line("type light number -1").line("away").shot("alone");
    script.line("click light reset all").line("key Shift+P 0").line("settle");
    play_with(script, {"--fresh"});
    expect("start", {});
    for (const char* name : {"on", "off", "auto"}) expect(name, {"--emissive-lights", name});
    EXPECT_GT(mean_difference(shown("off"), shown("on")), 0.01);
    EXPECT_EQ(mean_difference(shown("off"), shown("auto")), 0.0) << "the file has a light";
    const fs::path saved = folder_ / "kilolux-001.exr";
    ASSERT_TRUE(fs::exists(saved));
    using std::string_literals::operator""s;
    // An attribute of a header: name, type, length, value.
    const std::string note = "kilolux:emissive-lights\0string\0\2\0\0\0on"s;
    EXPECT_TRUE(contains(text_of_file(saved), note));
    Scene dark = glowing_room(true);
    dark.lights[0].intensity = glm::vec3(0.0f);
    write_scene(dark, room_);
    expect("alone", {"--emissive-lights", "on"});
}

// Automatic ones go and come with shadows and generated lights.
TEST_F(EmissiveLightsOfTheWindow, FollowTheOtherSettings) {
    write_room(false);
    Script script(folder_);
    script.shot("start").line("choose shadows exact").line("away").shot("exact");
    script.line("choose shadows sampled").line("away").shot("sampled");
    script.line("type lights 20").line("away").shot("generated");
    script.line("choose emissive on").line("away").shot("both");
    play_with(script, {"--fresh"});
    expect("start", {"--emissive-lights", "on"});
    expect("exact", {"--emissive-lights", "off", "--shadows", "exact"});
    expect("sampled", {"--emissive-lights", "on", "--shadows", "sampled"});
    expect("generated", {"--shadows", "sampled", "--lights", "20"});
    expect("both", {"--shadows", "sampled", "--lights", "20", "--emissive-lights", "on"});
    EXPECT_GT(mean_difference(shown("generated"), shown("both")), 1e-3);
}

TEST_F(EmissiveLightsOfTheWindow, RefuseWhatHasNoLightOfThem) {
    write_room(true);
    const auto refusal = [&](const std::string& before, const std::string& step) {
        Script script(folder_);
        script.line(before).line("settle").line(step);
        const ChildResult result = view(script, {"--fresh"});
        EXPECT_EQ(result.code, 1) << step;
        return result.err;
    };
    for (const char* choice : {"shadows exact", "shading blinn-phong"}) {
        const std::string disabled = std::string("disabled: ") + choice;
        const std::string choose = std::string("choose ") + choice, on = "choose emissive on";
        EXPECT_TRUE(contains(refusal(on, choose), disabled)) << choice;
        EXPECT_TRUE(contains(refusal(choose, on), disabled)) << choice;
    }
    // Where nothing glows, there is nothing to choose.
    Scene scene = glowing_room(true);
    scene.materials[1].emissive = {};
    write_scene(scene, room_);
    EXPECT_TRUE(contains(refusal("away", "choose emissive on"), "emissive"));
}

TEST_F(EmissiveLightsOfTheWindow, AreKept) {
    write_room(true);
    Script first(folder_);
    play_with(first.line("settle").line("choose emissive on").line("settle"));
    EXPECT_EQ(kept().at("emissive-lights"), "on");
    Script again(folder_);
    play_with(again.shot("again"));
    expect("again", {"--emissive-lights", "on"});
    Script given(folder_);
    play_with(given.shot("given"), {"--emissive-lights", "off"});
    expect("given", {"--emissive-lights", "off"});
    EXPECT_EQ(kept().at("emissive-lights"), "on") << "the command line's is for one run";
    Script excluded(folder_);
    const ChildResult result = view(excluded.shot("excluded"), {"--shadows", "exact"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "--emissive-lights: not the kept value")) << result.err;
    expect("excluded", {"--shadows", "exact"});
    EXPECT_EQ(kept().at("emissive-lights"), "on") << "for other settings";
}

}  // namespace
}  // namespace kilolux
