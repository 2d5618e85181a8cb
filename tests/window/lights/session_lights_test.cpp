// SPDX-License-Identifier: Apache-2.0
// The scene's own lights in the window: the panel selects and changes them, under Xvfb.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "host/scene/lights/light_aim.h"
#include "host/scene/lights/light_generator.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/photometry/photometry_file.h"
#include "present/cli/camera_choice.h"
#include "present/window/overlay/light_outlines.h"
#include "tests/support/ies_text.h"
#include "tests/support/lit_hall.h"
#include "tests/window/scripted_window.h"

namespace kilolux {
namespace {

enum Number { kRectangle, kDisk, kSphere, kPoint };  // of the room's lights

SceneLight light_at(LightType type, const glm::dvec3& position) {
    SceneLight light;
    light.type = type;
    light.position = position;
    light.direction = {0.0, -1.0, 0.0};
    light.intensity = glm::vec3(1.5f);
    light.width = 1.0f;
    light.height = 0.5f;
    light.radius = 0.25f;
    light.range = 6.0f;
    return light;
}

// A room, seen along -Z, with a light of each kind that files have.
Scene lit_room(bool with_area_lights = true) {
    Scene scene = box_scene({6.0, 3.0, 6.0}, true);
    if (with_area_lights) {
        scene.lights = {light_at(LightType::rectangle, {-1.5, 1.0, -1.0}),
                        light_at(LightType::disk, {1.5, 1.0, -1.0}),
                        light_at(LightType::sphere, {0.0, -0.5, -1.5})};
        scene.lights[kRectangle].width = 1.5f;  // the file holds its width / height
    }
    scene.lights.push_back(light_at(LightType::point, {0.0, 0.8, 1.0}));
    SceneCamera camera;
    camera.world_from_camera[3] = {0.0, 0.0, 2.8, 1.0};
    camera.y_fov = 1.2;
    scene.cameras.push_back(camera);
    return scene;
}

class LightsOfTheWindow : public testing::Test {
 protected:
    ChildResult view(const Script& script, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {
            "view",  room_.string(), "--fresh",   "-q", "--resolution", "700,420",
            "--rig", "none",         "--samples", "1",  "--script"};
        words.push_back(script.write());
        words.insert(words.end(), more.begin(), more.end());
        return view_in_display({"--chdir=" + folder_.path().string()}, words);
    }
    void play_with(const Script& script, const std::vector<std::string>& more = {}) const {
        const ChildResult result = view(script, more);
        ASSERT_EQ(result.code, 0) << result.err << result.out;
        EXPECT_EQ(result.err, "");
    }
    // The screenshot shows what the command line renders of the room with the change.
    void expect(const std::string& name, const std::function<void(Scene&)>& change,
                Scene scene = lit_room()) const {
        change(scene);
        const fs::path file = folder_ / "changed" / "room.gltf";
        fs::create_directories(file.parent_path());
        write_scene(scene, file);
        EXPECT_EQ(scene_part(folder_ / (name + ".png")).values,
                  rendered(folder_ / "rendered.png", {"--rig", "none"}, file.string()).values)
            << name;
    }
    double difference(const char* a, const char* b) const {
        return mean_difference(scene_part(folder_ / (std::string(a) + ".png")),
                               scene_part(folder_ / (std::string(b) + ".png")));
    }

    TemporaryFolder folder_;
    fs::path room_ = [this] {
        fs::path file = folder_ / "room.gltf";
        write_scene(lit_room(), file);
        return file;
    }();
};

// What the panel changes is what a file with that number shows.
TEST_F(LightsOfTheWindow, ShowTheirChanges) {
    Script script(folder_);
    const auto shot = [&](const std::string& name) {
        script.line("type light number -1").line("away").shot(name);
    };
    script.line("open scene lights");
    shot("start");
    script.line("type light number 0").line("type light width 0.75");
    script.line("type light y 0.5").line("click light two-sided");
    shot("rectangle");
    script.line("type light number 1").line("type light height 1.25");
    script.line("type light intensity 3").line("click light range none");
    shot("disk");
    script.line("type light number 1").line("click light next").line("type light radius 0.125");
    shot("sphere");
    script.line("type light number 1").line("click light reset");
    shot("reset");
    script.line("click light reset all");
    shot("all");
    play_with(script);
    expect("start", [](Scene&) {});
    const auto rectangle = [](Scene& scene) {
        scene.lights[kRectangle].width = 0.75f;
        scene.lights[kRectangle].position.y = 0.5;
        scene.lights[kRectangle].two_sided = true;
    };
    expect("rectangle", rectangle);
    const auto disk = [&](Scene& scene) {
        rectangle(scene);
        scene.lights[kDisk].height = 1.25f;
        scene.lights[kDisk].intensity = glm::vec3(3.0f);
        scene.lights[kDisk].range = 0.0f;
    };
    expect("disk", disk);
    const auto sphere = [&](Scene& scene) { scene.lights[kSphere].radius = 0.125f; };
    expect("reset", [&](Scene& scene) { rectangle(scene), sphere(scene); });
    EXPECT_GT(difference("start", "rectangle"), 1e-3);
    EXPECT_GT(difference("rectangle", "disk"), 1e-3);
    EXPECT_GT(difference("disk", "sphere"), 1e-6);
    EXPECT_EQ(difference("start", "all"), 0.0);
}

// The room with a light of each other kind that has a direction, straight down.
Scene aimed_room() {
    Scene scene = lit_room();
    scene.lights[kRectangle].side = {0.6, 0.0, 0.8};
    scene.lights.push_back(light_at(LightType::spot, {0.5, 1.2, 0.5}));
    scene.lights.push_back(light_at(LightType::directional, {0.0, 0.0, 0.0}));
    scene.lights.push_back(light_at(LightType::point, {-1.0, 0.2, 0.5}));
    scene.lights.back().profile = 0;
    scene.aimed_profiles.push_back({0, false});
    scene.webs.push_back(read_photometric_web(ies_text(uneven_ies()), "web"));
    return scene;
}

// The azimuth of a light that points straight down counts once it is raised.
TEST_F(LightsOfTheWindow, PointWhereTheirAnglesSay) {
    const Scene scene = aimed_room();
    write_scene(scene, room_);
    Script script(folder_);
    const auto shot = [&](const std::string& name) {
        script.line("type light number -1").line("away").shot(name);
    };
    script.line("open scene lights");
    shot("start");
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (!is_aimed_light(scene.lights[i])) continue;
        script.line("type light number " + std::to_string(i)).line("type light azimuth 395");
        script.line("slide light elevation -25");
        shot(std::to_string(i));
        script.line("type light number " + std::to_string(i)).line("click light reset");
    }
    script.line("type light number 0").line("type light roll 90");
    shot("rolled");
    script.line("type light number 0").line("click light reset");
    shot("reset");
    play_with(script);
    const auto no_change = [](Scene&) {};
    expect("start", no_change, scene);
    expect("reset", no_change, scene);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (!is_aimed_light(scene.lights[i])) continue;
        const std::string name = std::to_string(i);
        const double roll = aim_of(scene.lights[i]).roll;
        expect(
            name,
            [&](Scene& s) {
                set_aim(s.lights[i], {35.0, -25.0, roll});
            },
            scene);
        EXPECT_GT(difference("start", name.c_str()), 1e-4) << i;
    }
    expect(
        "rolled",
        [&](Scene& s) {
            set_aim(s.lights[0], {0.0, -90.0, 90.0});
        },
        scene);
    EXPECT_GT(difference("start", "rolled"), 1e-5);
}

// Others have no angles, and only flat lights and photometric webs a roll.
TEST_F(LightsOfTheWindow, HaveTheAnglesOfTheirKind) {
    const Scene scene = aimed_room();
    write_scene(scene, room_);
    const auto has = [&](std::size_t light, const char* angle) {
        Script script(folder_);
        script.line("open scene lights").line("type light number " + std::to_string(light));
        script.line(std::string("type light ") + angle + " 10");
        return view(script).code == 0;
    };
    for (const std::size_t light : {1u, 3u, 4u, 6u}) {
        EXPECT_EQ(has(light, "azimuth"), is_aimed_light(scene.lights[light])) << light;
        EXPECT_EQ(has(light, "roll"), has_roll(scene.lights[light])) << light;
    }
}

// Groups have faders; what they show is what the copied command renders.
TEST_F(LightsOfTheWindow, HaveGainsInGroups) {
    const std::vector<std::string> groups = {"--light-groups",
                                             "round=kind:sphere,flat=kind:rect+kind:disk"};
    Script script(folder_);
    script.line("open light groups").line("away").shot("start");
    script.line("type mix flat 0.5").line("type mix rest 2").line("away").shot("dimmed");
    script.line("click mix round mute").line("away").shot("mute");
    script.line("slide mix round 1").line("type mix flat 1").line("away").shot("again");
    script.line("click mix reset").line("away").shot("reset");
    play_with(script, groups);
    const auto expect_mix = [&](const char* name, const char* mix) {
        std::vector<std::string> options = {"--rig", "none"};
        if (mix != nullptr) {
            options.insert(options.end(), {"--light-mix", mix});
            options.insert(options.end(), groups.begin(), groups.end());
        }
        EXPECT_EQ(scene_part(folder_ / (std::string(name) + ".png")).values,
                  rendered(folder_ / "rendered.png", options, room_.string()).values)
            << name;
    };
    expect_mix("start", nullptr);
    expect_mix("dimmed", "flat=0.5,rest=2");
    expect_mix("mute", "flat=0.5,rest=2,round=0");
    expect_mix("again", "rest=2");
    EXPECT_GT(difference("start", "dimmed"), 1e-3);
    EXPECT_GT(difference("dimmed", "mute"), 1e-6);
    EXPECT_EQ(difference("start", "reset"), 0.0);
}

// Generated lights, and the file's points, are those of --light-size.
TEST_F(LightsOfTheWindow, GetASize) {
    write_scene(lit_room(false), room_);
    const std::string config = "XDG_CONFIG_HOME=" + folder_.path().string();
    const auto play_kept = [&](const Script& script) {
        const ChildResult result = view_in_display(
            {config}, {"view", room_.string(), "-q", "--resolution", "700,420", "--rig", "none",
                       "--lights", "20", "--samples", "1", "--script", script.write()});
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return;
    };
    Script first(folder_);
    first.shot("points").line("slide size 0.2").line("away").shot("spheres");
    play_kept(first);
    const auto kept = nlohmann::json::parse(text_of_file(folder_ / "kilolux" / "view.json"));
    EXPECT_EQ(kept.at("light-size"), 0.2);
    Script again(folder_);
    again.shot("kept").line("slide size 0").line("away").shot("back");
    play_kept(again);
    const auto expect_lights = [&](const std::string& name, const std::string& size) {
        EXPECT_EQ(
            scene_part(folder_ / (name + ".png")).values,
            rendered(folder_ / "rendered.png",
                     {"--rig", "none", "--lights", "20", "--light-size", size}, room_.string())
                .values)
            << name;
    };
    expect_lights("points", "0");
    expect_lights("spheres", "0.2");
    expect_lights("kept", "0.2");
    expect_lights("back", "0");
    EXPECT_GT(difference("points", "spheres"), 1e-5);
}

// The panel refuses beforehand what the renderer would.
TEST_F(LightsOfTheWindow, RefuseWhatHasNoLightOfThem) {
    const auto refusal = [&](const std::string& step, const std::vector<std::string>& more = {}) {
        Script script(folder_);
        script.line("settle").line(step);
        const ChildResult result = view(script, more);
        EXPECT_EQ(result.code, 1) << step;
        EXPECT_NE(result.err.find("script:2"), std::string::npos) << result.err;
        return result.err;
    };
    EXPECT_NE(refusal("choose shading blinn-phong").find("disabled: shading blinn-phong"),
              std::string::npos);
    EXPECT_NE(refusal("choose shadows exact").find("disabled: shadows exact"), std::string::npos);
    write_scene(lit_room(false), room_);
    EXPECT_NE(refusal("slide size 0.1", {"--shadows", "exact"}).find("disabled: shadows exact"),
              std::string::npos);
    Script script(folder_);
    script.line("choose shading blinn-phong").line("settle").line("choose shading pbr");
    script.line("slide size 0.1").line("settle");
    play_with(script);
}

// Values that are kept from other scenes do not hinder the window.
TEST_F(LightsOfTheWindow, KeptSettingsThatExcludeThemWait) {
    const auto opens = [&](const std::string& kept, const std::vector<std::string>& more) {
        fs::create_directories(folder_ / "kilolux");
        write_text(folder_ / "kilolux" / "view.json", R"({"version": 2, )" + kept + "}");
        std::vector<std::string> words = {"view",  room_.string(), "--resolution", "700,420",
                                          "--rig", "none",         "--exit-after", "1"};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result =
            view_in_display({"XDG_CONFIG_HOME=" + folder_.path().string()}, words);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.err.find("not the kept value"), std::string::npos) << result.err;
    };
    opens(R"("shadows": "exact")", {});
    opens(R"("shading": "blinn-phong")", {});
    EXPECT_EQ(nlohmann::json::parse(text_of_file(folder_ / "kilolux" / "view.json")).at("shading"),
              "blinn-phong")
        << "for other scenes";
    write_scene(lit_room(false), room_);
    opens(R"("light-size": 0.1)", {"--lights", "10", "--shadows", "exact"});
}

TEST_F(LightsOfTheWindow, KeepTheirColourWhileTheyAreDark) {
    Scene scene = lit_room(false);
    scene.lights[0].intensity = {1.5f, 0.75f, 0.375f};
    write_scene(scene, room_);
    Script script(folder_);
    script.line("open scene lights").line("type light number 0").line("away").shot("before");
    script.line("type light intensity 0").line("away").shot("dark");
    script.line("type light intensity 1.5").line("away").shot("after");
    play_with(script);
    EXPECT_GT(difference("before", "dark"), 0.0);
    EXPECT_EQ(difference("before", "after"), 0.0);
}

TEST_F(LightsOfTheWindow, HaveOutlines) {
    Script script(folder_);
    script.shot("none").line("open scene lights").line("click outlines").line("away");
    script.shot("all").line("click outlines").line("type light number 2").line("away");
    script.shot("selected").line("click light none").line("away").shot("again");
    play_with(script);
    const auto changed = [&](const char* name) {
        const ScenePart a = scene_part(folder_ / "none.png");
        const ScenePart b = scene_part(folder_ / (std::string(name) + ".png"));
        int count = 0;
        for (std::size_t i = 0; i < a.values.size(); i += 3) count += a.values[i] != b.values[i];
        return count;
    };
    EXPECT_EQ(changed("again"), 0);
    EXPECT_GT(changed("selected"), 150) << "a circle of about 60 pixels across";
    EXPECT_LT(changed("selected"), 2000);
    EXPECT_GT(changed("all"), changed("selected"));
}

// Where the outlines of the generated lights are in the picture of the room's camera: all of them
// are drawn, and little else.
TEST_F(LightsOfTheWindow, GeneratedOnesHaveOutlines) {
    Scene scene = lit_room(false);
    scene.lights.clear();
    write_scene(scene, room_);
    Script script(folder_);
    script.shot("none").line("click outlines").line("away").shot("all");
    script.line("slide size 0").line("away").shot("points").line("click outlines").line("away");
    script.shot("again");
    play_with(script, {"--lights", "20", "--light-size", "0.2"});
    EXPECT_EQ(difference("points", "again"), 0.0) << "points have none";
    constexpr int kWidth = 700 - kPanel, kHeight = 420 - kUnderlay;
    const ScenePart before = scene_part(folder_ / "none.png");
    const ScenePart after = scene_part(folder_ / "all.png");
    const auto is_changed = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) return false;
        const auto at = 3 * static_cast<std::size_t>(y * kWidth + x);
        return before.values[at] != after.values[at] ||
               before.values[at + 2] != after.values[at + 2];
    };
    const Camera camera = choose_camera({}, scene, kWidth / 420.0);
    const glm::dmat4 clip = clip_from_view(camera, kWidth, 420);
    int expected = 0, drawn = 0;
    LightOptions generated;
    generated.count = 20;
    generated.size = 0.2;
    for (const SceneLight& light : generate_lights(generated, scene, 0.0)) {
        for (const glm::dvec3& p : outline_of(light, camera)) {
            const glm::dvec3 view = glm::transpose(camera.world_from_view) * (p - camera.position);
            const glm::dvec4 at = clip * glm::dvec4(view, 1.0);
            const int x = static_cast<int>((0.5 + 0.5 * at.x / at.w) * kWidth);
            const int y = static_cast<int>((0.5 - 0.5 * at.y / at.w) * 420) - kUnderlay;
            if (at.w <= 0.0 || x < 2 || y < 2 || x > kWidth - 3 || y > kHeight - 3) continue;
            ++expected;
            bool is_drawn = false;
            for (int i = 0; i < 9; ++i) is_drawn |= is_changed(x - 1 + i % 3, y - 1 + i / 3);
            drawn += is_drawn;
        }
    }
    EXPECT_GT(expected, 100) << "most of the lights are in view";
    EXPECT_EQ(drawn, expected);
    int changed = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) changed += is_changed(i % kWidth, i / kWidth);
    EXPECT_LT(changed, 30 * expected) << "lines, not areas";
}

}  // namespace
}  // namespace kilolux
