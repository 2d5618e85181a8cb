// SPDX-License-Identifier: Apache-2.0
// Tests that all code that reads the rows of settings reads all of them.
#include <gtest/gtest.h>
#include <wordexp.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "host/scene/generated/scenes.h"
#include "present/cli/option_builder.h"
#include "present/cli/scene_choice.h"
#include "present/commands/bench/bench_context.h"
#include "present/commands/bench/bench_options.h"
#include "present/commands/bench/bench_sweep.h"
#include "present/commands/made_picture.h"
#include "present/window/app/command_text.h"
#include "present/window/app/state_file.h"
#include "tests/support/option_examples.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

using Names = std::set<std::string>;

SharedOptions render_options() {
    SharedOptions options;
    options.takes_automatic_exposure = options.takes_automatic_samples = true;
    options.shows_environment = true;
    return options;
}

// The defaults: of the shared options, or of all that render takes.
template <typename Options>
Options initial() {
    if constexpr (std::is_same_v<Options, SharedOptions>) {
        return render_options();
    } else if constexpr (std::is_same_v<Options, BenchOptions>) {
        return {};
    } else {
        return {.shared = render_options(), .output = {}, .budget = {}};
    }
}

// The options that the command line makes of words.
template <typename Options = SharedOptions>
Options parsed(std::vector<std::string> words) {
    Options options = initial<Options>();
    CLI::App app;
    add_options(app, options);
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    return options;
}

template <typename Options = SharedOptions>
struct ChangedOption {
    std::string option, word, text;
    Options options;  // as the command line gives it
};

template <typename Options = SharedOptions>
std::vector<ChangedOption<Options>> changed_options() {
    Options defaults = initial<Options>();
    std::vector<ChangedOption<Options>> out;
    for (const Setting& setting : settings_of(defaults)) {
        const std::string text = other_value(setting);
        const bool positional = setting.option() == "SCENE";
        out.push_back({setting.option(), setting.word(), text,
                       parsed<Options>({positional ? text : setting.option() + "=" + text})});
    }
    return out;
}

template <typename Options>
std::map<std::string, std::string> texts_of(Options options) {
    std::map<std::string, std::string> out;
    for (const Setting& setting : settings_of(options)) out[setting.option()] = setting.show();
    return out;
}

// No result depends on these, but for the device, which conditions name on its own.
const Names kOfNoResult = {"--strict",  "--allow-outside-paths", "--quiet", "--verbose", "--device",
                           "--progress"};

// A member that no option reaches is one of the renderer's own, or of tests.
TEST(Settings, ReachEveryMember) {
    SharedOptions all = render_options();
    for (const Setting& setting : settings_of(all)) setting.take(other_value(setting));
    all.settings.grid.fine_per_octave = 5;  // the window's
    RenderSettings own;
    own.background = all.settings.background;
    own.reflections = all.settings.reflections;
    own.opened = all.settings.opened;
    auto& a = all.settings;
    auto& b = own;
    const auto differ = [](const auto&... pairs) {
        std::vector<bool> out;
        (out.push_back(!(pairs.first == pairs.second)), ...);
        return out;
    };
#define BOTH(member) std::pair(a.member, b.member)
    const auto reached = differ(
        BOTH(renderer), BOTH(width), BOTH(height), BOTH(lights.count), BOTH(lights.seed),
        BOTH(lights.radius), BOTH(lights.intensity), BOTH(lights.size), BOTH(lights.box),
        BOTH(tails), BOTH(range_budget), BOTH(seed), BOTH(tree_share), BOTH(gbuffer),
        BOTH(geometry), BOTH(anisotropy), BOTH(no_reuse), BOTH(shading), BOTH(shadows),
        BOTH(shadow_rays), BOTH(ambient), BOTH(bloom), BOTH(exposure), BOTH(tone_curve),
        BOTH(samples), BOTH(auto_samples.error), BOTH(auto_samples.most), BOTH(want.view),
        BOTH(want.aovs), BOTH(grid.tiles_x), BOTH(grid.tiles_y), BOTH(grid.slices_per_octave),
        BOTH(grid.fine_per_octave), BOTH(kernels.lanes), BOTH(kernels.math),
        BOTH(kernels.light_colors), BOTH(light_mix.gains), BOTH(max_memory_bytes), BOTH(device));
#undef BOTH
    for (std::size_t i = 0; i < reached.size(); ++i) EXPECT_TRUE(reached[i]) << "member " << i;
}

TEST(Settings, RefuseAResumeWithAnotherValue) {
    const TemporaryFolder folder;
    const DeviceInfo device = describe(choose_device(""));
    const Scene scene = make_generated_scene("grid");
    const auto document = [&](const SharedOptions& options) {
        const Camera camera = choose_camera(options, scene);
        return result_document(bench_context(options, {}, scene, camera, device), {}, {});
    };
    const std::filesystem::path file = folder / "bench.context.json";
    write_text(file, document(render_options()).dump());
    EXPECT_NO_THROW(require_same_context(file, document(render_options())));
    // Rows say them; lanes are in the tuning, too.
    const Names swept = {"--renderer", "--resolution", "--lights", "--grid", "--gbuffer"};
    for (const auto& changed : changed_options()) {
        std::string refusal;
        try {
            require_same_context(file, document(changed.options));
        } catch (const Error& error) {
            refusal = error.what();
        }
        const bool may_resume =
            kOfNoResult.contains(changed.option) || swept.contains(changed.option);
        EXPECT_EQ(refusal.empty(), may_resume) << changed.option << ": " << refusal;
    }
}

TEST(Settings, AreInTheKeyOfAChoice) {
    const Scene scene = make_generated_scene("grid");
    const auto key = [&](const SharedOptions& options) {
        return conditions_json(options, scene, choose_camera(options, scene)).dump();
    };
    for (const auto& changed : changed_options()) {
        EXPECT_EQ(key(changed.options) == key(render_options()),
                  kOfNoResult.contains(changed.option))
            << changed.option;
    }
}

// Rows of other frames may not be added to those of a file.
TEST(Settings, OfBenchThatChangeItsFramesRefuseAResume) {
    const TemporaryFolder folder;
    const DeviceInfo device = describe(choose_device(""));
    const Scene scene = make_generated_scene("grid");
    const auto document = [&](const BenchOptions& options) {
        return result_document(bench_context(options.shared, bench_frames(options), scene,
                                             choose_camera(options.shared, scene), device),
                               {}, options.shard);
    };
    const std::filesystem::path file = folder / "bench.context.json";
    write_text(file, document(parsed<BenchOptions>({})).dump());
    EXPECT_NO_THROW(require_same_context(file, document(parsed<BenchOptions>({"--json"}))));
    for (const char* word : {"--warm-up=3", "--frames=7", "--motion=lights", "--shard=1/2"}) {
        EXPECT_THROW(require_same_context(file, document(parsed<BenchOptions>({word}))), Error)
            << word;
    }
}

// Values set in the panel are kept after the window's end.
TEST(Settings, OfThePanelComeBack) {
    const Names panel = {"--renderer",   "--samples",      "--show",
                         "--gbuffer",    "--shading",      "--shadows",
                         "--ambient",    "--exposure",     "--tonemap",
                         "--bloom",      "--rig",          "--lights",
                         "--light-seed", "--light-radius", "--light-intensity",
                         "--tails",      "--tree-share",   "--grid",
                         "--lanes",      "--light-size",   "--emissive-lights"};
    auto options = initial<SharedOptions>();
    for (const Setting& setting : settings_of(options)) {
        EXPECT_EQ(setting.text.effect.in_panel, panel.contains(setting.option()))
            << setting.option();
    }
    std::size_t found = 0;
    for (const auto& changed : changed_options()) {
        if (!panel.contains(changed.option)) continue;
        ++found;
        const TemporaryFolder folder;
        const auto nothing_given = [](const std::string&) { return false; };
        ViewState state;
        state.settings = changed.options.settings;
        state.rig = changed.options.rig;
        state.emissive_lights = changed.options.emissive_lights;
        StateFile file(folder / "view.json");
        const ViewState start = file.load({}, nothing_given);
        file.save(state);
        const ViewState again = StateFile(folder / "view.json").load({}, nothing_given);
        EXPECT_EQ(again.settings, state.settings) << changed.option;
        EXPECT_EQ(again.rig, state.rig) << changed.option;
        EXPECT_EQ(again.emissive_lights, state.emissive_lights) << changed.option;
        EXPECT_FALSE(again == start) << changed.option;
    }
    EXPECT_EQ(found, panel.size());
}

// A picture's note holds the options that change it, and --skip-existing refuses it by them.
TEST(Settings, AreInTheNoteOfAPictureThatTheyChange) {
    const Names of_no_picture = {"--strict",          "--allow-outside-paths",
                                 "--quiet",           "--verbose",
                                 "--device",          "--no-reuse",
                                 "--max-memory",      "--lanes",
                                 "--output",          "--stats",
                                 "--frames",          "--fps",
                                 "--shard",           "--tiles",
                                 "--exr-compression", "--png-level",
                                 "--metric",          "--threshold",
                                 "--reference",       "--difference",
                                 "--skip-existing",   "--mixed-devices",
                                 "--progress"};
    const TemporaryFolder folder;
    const std::string before = picture_command(initial<RenderOptions>());
    Frame frame;
    frame.width = 2;
    frame.height = 1;
    frame.display.resize(8);
    write_image(folder / "a.png", frame, {{{"command", before}, {"time", "0 s"}}, {}});
    for (const auto& changed : changed_options<RenderOptions>()) {
        const std::string command = picture_command(changed.options);
        const bool stays = of_no_picture.contains(changed.option);
        EXPECT_EQ(command == before, stays) << changed.option << ": " << command;
        const WantedPicture wanted{folder / "a.png", 2, 1, command, "0 s"};
        if (stays) {
            EXPECT_TRUE(is_made(wanted)) << changed.option;
        } else {
            EXPECT_THROW(is_made(wanted), Error) << changed.option;
        }
    }
}

// A video's frames are in one file, and a turntable's angle is a share of its frames.
TEST(Settings, FramesAreInTheNoteWhereAPictureDependsOnThem) {
    const auto command = [](const std::vector<std::string>& words) {
        return picture_command(parsed<RenderOptions>(words));
    };
    EXPECT_EQ(command({"--output=a.mp4", "--frames=3:9", "--fps=12"}),
              "kilolux render atrium --frames 3:9 --fps 12");
    EXPECT_EQ(command({"--output=a.#.png", "--turntable=90", "--frames=3:9", "--fps=12"}),
              "kilolux render atrium --frames 3:9 --turntable 90");
}

// The words of a shell.
std::vector<std::string> shell_words(const std::string& line) {
    wordexp_t words{};
    if (wordexp(line.c_str(), &words, WRDE_NOCMD | WRDE_UNDEF) != 0) throw Error(line);
    std::vector<std::string> out(words.we_wordv, words.we_wordv + words.we_wordc);
    wordfree(&words);
    return out;
}

TEST(Settings, AreInTheCopiedCommand) {
    const Scene scene = make_generated_scene("grid");
    // Of no picture, said as positions, or not in a PNG.
    const Names not_said = {"--quiet",
                            "--progress",
                            "--verbose",
                            "--aov",
                            "--light-groups",
                            "--camera-index",
                            "--camera-position",
                            "--camera-focal-point",
                            "--camera-view-up",
                            "--camera-view-angle",
                            "--camera-orthographic",
                            "--fit"};
    for (const auto& changed : changed_options()) {
        if (not_said.contains(changed.option)) continue;
        const CameraRig rig(choose_camera(changed.options, scene), bounds(scene));
        auto words = shell_words(render_command(rig, changed.options, scene));
        words.erase(words.begin(), words.begin() + 2);  // kilolux render
        words.resize(words.size() - 2);                 // -o kilolux.png
        EXPECT_EQ(texts_of(parsed(words)), texts_of(changed.options)) << changed.option;
    }
}

TEST(Settings, WordsAreSafeForAShell) {
    for (const char* word : {"plain", "", "two words", "it's", "$HOME", "a;b", "`ls`", "*", "~",
                             "a\\b", "#1", "\"", "a&b|c", "(x)", "<>", "{a,b}", "!"}) {
        EXPECT_EQ(shell_words(shell_word(word)), std::vector<std::string>{word});
    }
}

}  // namespace
}  // namespace kilolux
