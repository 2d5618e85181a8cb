// SPDX-License-Identifier: Apache-2.0
// The lights of a command line, and the lines that describe them.
#include <gtest/gtest.h>

#include "host/render/renderer.h"
#include "host/scene/export/export_scene.h"
#include "present/cli/option_builder.h"
#include "present/cli/option_values.h"
#include "present/cli/scene_choice.h"
#include "present/image/image_file.h"
#include "tests/support/box_scene.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

// Files of an object, a room, and an object with a light.
class RigTest : public testing::Test {
 protected:
    RigTest() {
        write("object.glb", box_scene(glm::dvec3(2.0)));
        write("room.glb", box_scene(glm::dvec3(4.0), true));
        Scene own = box_scene(glm::dvec3(2.0));
        own.lights.resize(1);
        own.lights[0].range = 9.0f;
        write("own.glb", own);
    }

    void write(const char* name, const Scene& scene) {
        for (const ExportedFile& part : export_scene(scene, folder_ / name).files) {
            write_text(folder_ / part.name, std::string(part.bytes.begin(), part.bytes.end()));
        }
    }

    // "generated+own", and the ambient light where it is not the default.
    std::string lights(const std::string& scene, const std::string& more = "") {
        CLI::App app;
        SharedOptions options;
        add_options(app, options);
        const std::string words =
            (scene.find('.') == std::string::npos ? scene : (folder_ / scene).string());
        app.parse(words + " -q " + more);
        begin_command(options);
        const Scene opened = open_scene(options);
        std::string out = std::to_string(options.settings.lights.count) + "+" +
                          std::to_string(opened.lights.size());
        if (options.settings.ambient != 0.02f) out += " " + text_of(options.settings.ambient);
        return out;
    }

    TemporaryFolder folder_;
};

TEST_F(RigTest, TheSceneDecidesUnlessTheCommandLineDoes) {
    EXPECT_EQ(lights("grid"), "5000+0");
    EXPECT_EQ(lights("room.glb"), "5000+0");
    EXPECT_EQ(lights("object.glb"), "0+5 0.2");
    EXPECT_EQ(lights("own.glb"), "0+1");
    EXPECT_EQ(lights("object.glb", "--lights 70"), "70+0") << "lights asked for are the rig";
    EXPECT_EQ(lights("object.glb", "--light-radius 2"), "5000+0");
    EXPECT_EQ(lights("object.glb", "--lights 0"), "0+0");
    EXPECT_EQ(lights("grid", "--lights 0"), "0+12") << "its emissive surfaces";
    EXPECT_EQ(lights("own.glb", "--lights 70"), "70+1");
}

TEST_F(RigTest, ARigAskedForIsTheRigAndTheFilesLightsCount) {
    EXPECT_EQ(lights("own.glb", "--rig studio"), "0+6 0.2");
    EXPECT_EQ(lights("own.glb", "--rig studio --ambient 0.02"), "0+6");
    EXPECT_EQ(lights("own.glb", "--rig studio --lights 70"), "70+6 0.2");
    EXPECT_EQ(lights("object.glb", "--rig headlight"), "0+1");
    EXPECT_EQ(lights("object.glb", "--rig swarm"), "5000+0");
    EXPECT_EQ(lights("grid", "--rig none"), "0+12") << "its emissive surfaces";
    EXPECT_EQ(message_of<UsageError>([&] { lights("grid", "--rig swarm --lights 0"); }),
              "--rig swarm: needs lights, and --lights is 0");
}

// The command that the window copies must give the same lights.
TEST_F(RigTest, ASwarmIsNamedWhereTheSceneWouldNotChooseIt) {
    const auto chosen = [&](const std::string& scene, const std::string& more) {
        CLI::App app;
        SharedOptions options;
        add_options(app, options);
        app.parse(scene + " -q " + more);
        open_scene(options);
        return options.rig;
    };
    const std::string object = (folder_ / "object.glb").string();
    EXPECT_EQ(chosen("grid", "--rig swarm"), Rig::automatic);
    EXPECT_EQ(chosen((folder_ / "room.glb").string(), ""), Rig::automatic);
    EXPECT_EQ(chosen(object, "--rig swarm"), Rig::swarm);
    EXPECT_EQ(chosen(object, "--lights 5000"), Rig::swarm);
    EXPECT_EQ(chosen("grid", "--environment sky --rig swarm"), Rig::swarm);
}

TEST_F(RigTest, MetalGetsAStudiosRoomWhereItCanBeSeen) {
    Scene metal = box_scene(glm::dvec3(2.0));
    metal.materials[0].metallic = 1.0f;
    write("metal.glb", metal);
    EXPECT_EQ(lights("metal.glb"), "0+5 0.2") << "a command that has no reflections";
    const auto chosen = [&](const std::string& more) {
        CLI::App app;
        SharedOptions options;
        options.shows_environment = true;
        add_options(app, options);
        app.parse((folder_ / "metal.glb").string() + " -q " + more);
        AnimatedScene scene = open_animated_scene(options);
        const std::string line = light_scene(options, scene);
        return std::tuple(options.maps != nullptr, options.shown_background != nullptr,
                          contains(line, "most of the surface is metal"),
                          scene.scene().lights.size());
    };
    EXPECT_EQ(chosen(""), std::tuple(true, false, true, 0u));
    EXPECT_EQ(chosen("--background 1,1,1"), std::tuple(true, true, true, 0u));
    EXPECT_EQ(chosen("--rig studio"), std::tuple(false, false, false, 5u)) << "asked for";
    EXPECT_EQ(chosen("--renderer forward"), std::tuple(false, false, false, 5u));
    EXPECT_EQ(chosen("--environment sky --reflections"), std::tuple(true, true, false, 0u));
    EXPECT_EQ(chosen("--environment sky --environment-lights 3"),
              std::tuple(false, true, false, 3u));
}

TEST_F(RigTest, ManyFarLightsWithoutARangeTakeATree) {
    Scene scene = box_scene({80.0, 4.0, 400.0});
    for (int i = 0; i < 129; ++i) {
        SceneLight light;
        light.position = {i % 8 * 10.0 - 35.0, 20.0, i / 8 * 24.0 - 190.0};
        scene.lights.push_back(light);
    }
    write("many.glb", scene);
    std::string warning;
    const auto chosen = [&](const std::string& more, const char* file = "many.glb") {
        CLI::App app;
        SharedOptions options;
        options.compares_renderers = file != std::string("many.glb");
        add_options(app, options);
        app.parse((folder_ / file).string() + " -q " + more);
        testing::internal::CaptureStderr();
        open_scene(options);
        warning = testing::internal::GetCapturedStderr();
        return options.settings.tails;
    };
    EXPECT_EQ(chosen(""), Tails::tree);
    EXPECT_EQ(chosen("--tails bounded"), Tails::bounded);
    EXPECT_EQ(chosen("--range-budget 1e-9"), Tails::automatic);
    EXPECT_FALSE(contains(warning, "cut up to about")) << warning;
    EXPECT_EQ(chosen("--shadows exact"), Tails::bounded) << "a tree casts no shadows";
    write("measured.glb", scene);
    EXPECT_EQ(chosen("", "measured.glb"), Tails::bounded);
    EXPECT_EQ(warning, "");
}

TEST_F(RigTest, TheViewDecidesCameraAndRig) {
    std::string reason;
    const auto seen = [&](const std::string& scene, const std::string& more) {
        CLI::App app;
        SharedOptions options;
        add_options(app, options);
        app.parse((folder_ / scene).string() + " -q " + more);
        AnimatedScene opened = open_animated_scene(options);
        const std::string line = light_scene(options, opened);
        const Camera camera = choose_camera(options, opened.scene());
        const Box box = bounds(opened.scene());
        const bool inside = glm::all(glm::greaterThan(camera.position, box.min)) &&
                            glm::all(glm::lessThan(camera.position, box.max));
        reason = line.substr(0, line.find('\n'));
        return std::pair(inside, line.substr(0, line.find(':')));
    };
    using Seen = std::pair<bool, std::string>;
    EXPECT_EQ(seen("room.glb", ""), Seen(true, "view    inside (automatic)"));
    EXPECT_TRUE(contains(reason, " % of what it shows outside are backs of its walls")) << reason;
    EXPECT_EQ(seen("object.glb", ""), Seen(false, "view    outside (automatic)"));
    EXPECT_EQ(reason, "view    outside (automatic): surfaces face 0 % of what a point within sees");
    EXPECT_EQ(seen("room.glb", "--view outside"),
              Seen(false, "view    outside (--view)\nrig     studio (automatic)"));
    EXPECT_EQ(seen("object.glb", "--view inside"),
              Seen(true, "view    inside (--view)\nrig     swarm (automatic)"));
}

// A file with a camera has no line of the view.
TEST_F(RigTest, AnAutomaticRigSaysWhy) {
    Scene scene = box_scene({6.0, 3.0, 8.0}, true);
    scene.cameras.emplace_back();
    write("seen_room.glb", scene);
    const auto line = [&](const std::string& more) {
        CLI::App app;
        SharedOptions options;
        add_options(app, options);
        app.parse((folder_ / "seen_room.glb").string() + " -q " + more);
        AnimatedScene opened = open_animated_scene(options);
        return light_scene(options, opened);
    };
    EXPECT_TRUE(contains(line(""), "rig     swarm (automatic): 5000 generated")) << line("");
    EXPECT_TRUE(contains(line(""), ", as the scene is an interior: ")) << line("");
    EXPECT_FALSE(contains(line("--rig studio"), "as the scene is"));
    EXPECT_FALSE(contains(line("--lights 5"), "as the scene is"));
}

TEST_F(RigTest, ExportSaysThatAmbientLightIsLost) {
    const auto warning = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"export", (folder_ / "object.glb").string(), "-q", "-o",
                                          (folder_ / "out.glb").string()};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return result.err;
    };
    EXPECT_EQ(warning({}),
              "kilolux: warning: ambient light of 0.2 of the rig studio is not written: glTF has "
              "none, other renderers show the scene darker\n");
    EXPECT_TRUE(
        contains(warning({"--rig", "none", "--ambient", "0.5"}), "ambient light of 0.5 is"));
    EXPECT_EQ(warning({"--rig", "headlight"}), "");
    EXPECT_EQ(warning({"--rig", "studio", "--ambient", "0"}), "");
}

TEST_F(RigTest, ReflectionsSayWhatTheyNeed) {
    EXPECT_EQ(message_of<UsageError>([&] { lights("grid", "--reflections"); }),
              "--reflections: only render and view show it");
    EXPECT_EQ(message_of<UsageError>([&] { lights("grid", "--background none"); }),
              "--background: only render and view show it");
    const auto refused = [](std::vector<std::string> more) {
        std::vector<std::string> words = {"render", "grid", "-o", "x.png", "--reflections"};
        words.insert(words.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 2);
        return result.err;
    };
    EXPECT_TRUE(contains(refused({}), "--reflections: needs --environment FILE|studio|sky"));
    EXPECT_TRUE(contains(refused({"--environment", "sky", "--renderer", "forward"}),
                         "--reflections: needs --renderer deferred or deferred-all"));
    EXPECT_TRUE(contains(refused({"--environment", "sky", "--max-error", "0.1"}),
                         "--max-error and --reflections exclude each other"));
}

TEST_F(RigTest, AnEnvironmentIsLightsOfItsOwn) {
    Frame white;
    white.width = 8;
    white.height = 4;
    white.radiance.assign(96, 0.5f);
    const std::string file = (folder_ / "white.hdr").string();
    write_image(file, white);
    EXPECT_EQ(lights("object.glb", "--environment " + file), "0+32 0");
    EXPECT_EQ(message_of<UsageError>([&] { lights("grid", "--environment skyy"); }),
              "--environment 'skyy' is no file, and none of studio, sky; did you mean 'sky'?");
    EXPECT_EQ(message_of<Error>([&] { lights("grid", "--environment none.hdr"); }),
              "none.hdr: no such environment file");
    EXPECT_EQ(lights("object.glb", "--environment-lights 5 --environment " + file), "0+5 0");
    EXPECT_EQ(lights("own.glb", "--rig studio --environment " + file), "0+38 0.2");
    EXPECT_TRUE(
        contains(message_of<Error>([&] { lights("grid", "--environment none.hdr"); }), "none.hdr"));
}

TEST_F(RigTest, TheProgramSaysItOnceAndNotQuietly) {
    const std::vector<std::string> words = {"render",       (folder_ / "object.glb").string(),
                                            "--resolution", "48,32",
                                            "-o",           (folder_ / "a.png").string()};
    const ChildResult said = run_kilolux(words);
    ASSERT_EQ(said.code, 0) << said.err;
    const std::string line =
        "rig     studio (automatic): 5 directional, 0 of the scene's own "
        "lights, ambient 0.2\n";
    EXPECT_TRUE(contains(said.err, line)) << said.err;
    std::vector<std::string> dark = words;
    dark.insert(dark.end(), {"--rig", "none"});
    EXPECT_TRUE(contains(run_kilolux(dark).err, "a.png: picture has no lights"));
    dark.emplace_back("-q");
    EXPECT_EQ(run_kilolux(dark).err, "");
}

// A headlight follows the camera in every renderer and at every position.
TEST_F(RigTest, AHeadlightFollowsTheCamera) {
    Scene scene = box_scene(glm::dvec3(2.0));
    scene.lights = rig_lights(Rig::headlight);
    RenderSettings settings;
    settings.width = 33;
    settings.height = 33;
    settings.lights.count = 0;
    settings.ambient = 0.0f;
    for (const RendererKind kind : {RendererKind::deferred, RendererKind::forward}) {
        settings.renderer = kind;
        Renderer renderer(scene, settings);
        double first = 0.0;
        for (const glm::dvec3 eye :
             {glm::dvec3(0, 0, 6), glm::dvec3(6, 0, 0), glm::dvec3(0, 0, -6)}) {
            const Frame frame = renderer.render(look_at(eye, {0, 0, 0}, {0, 1, 0}, 0.6), 0.0);
            const double middle = frame.radiance[3 * (16 * 33 + 16)];
            if (first == 0.0) first = middle;
            EXPECT_GT(middle, 0.2);
            EXPECT_NEAR(middle, first, 1e-5);
        }
    }
}

}  // namespace
}  // namespace kilolux
