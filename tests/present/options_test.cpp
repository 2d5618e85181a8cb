// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <limits>
#include <sstream>

#include "host/scene/generated/scenes.h"
#include "present/cli/names.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "present/cli/output_options.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

struct Parsed {
    SharedOptions shared;
    OutputOptions output;
};

// Options as the render command has them, parsed from words.
Parsed parsed(const std::string& line) {
    Parsed parsed;
    CLI::App app;
    add_options(app, parsed.shared);
    add_options(app, parsed.output);
    std::istringstream words(line);
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.insert(arguments.begin(), word);
    app.parse(arguments);
    return parsed;
}

std::string refusal(const std::string& line) {
    return message_of<UsageError>([&] { parsed(line); });
}

TEST(Options, ExposureNamesAutoWhereItIsTaken) {
    CLI::App app;
    SharedOptions options;
    options.takes_automatic_exposure = true;
    add_options(app, options);
    EXPECT_EQ(message_of<UsageError>([&] { app.parse("--exposure atuo"); }),
              "--exposure: 'atuo' is not 'auto' or a number from -126 to 126");
    app.parse("--exposure auto");
    EXPECT_TRUE(options.automatic_exposure);
}

TEST(Options, SamplesAreACountOrAutoWhereThatIsTaken) {
    CLI::App app;
    SharedOptions options;
    options.takes_automatic_samples = true;
    add_options(app, options);
    app.parse("--samples auto --sample-error 0.25 --max-samples 99");
    EXPECT_EQ(options.settings.auto_samples, (AutoSamples{true, 0.25f, 99}));
    app.parse("--samples 7");
    EXPECT_FALSE(options.settings.auto_samples.on);
    EXPECT_EQ(options.settings.samples, 7);
    EXPECT_EQ(message_of<UsageError>([&] { app.parse("--samples atuo"); }),
              "--samples: 'atuo' is not 'auto' or a whole number from 1 to 65536");
    EXPECT_EQ(refusal("--samples auto"), "--samples: only render makes it automatic");
    EXPECT_EQ(refusal("--samples 0"), "--samples: '0' is not a whole number from 1 to 65536");
    EXPECT_EQ(refusal("--max-samples 4"),
              "--max-samples: '4' is not a whole number from 8 to 65536");
    EXPECT_NE(refusal("--sample-error 0"), "");
}

TEST(Options, DefaultsAreThoseOfTheSettings) {
    const Parsed p = parsed("");
    EXPECT_EQ(p.shared.scene, "atrium");
    EXPECT_EQ(p.shared.settings.renderer, RendererKind::deferred);
    EXPECT_EQ(p.shared.settings.width, 1920);
    EXPECT_EQ(p.shared.settings.height, 1080);
    EXPECT_EQ(p.shared.settings.lights.count, 5000u);
    EXPECT_EQ(p.shared.settings.lights.seed, 1u);
    EXPECT_EQ(p.shared.settings.samples, 1);
    EXPECT_EQ(p.shared.settings.ambient, 0.02f);
    EXPECT_EQ(p.shared.settings.tone_curve, ToneCurve::neutral);
    EXPECT_EQ(p.shared.settings.want.view, ViewKind::lit);
    EXPECT_EQ(p.output.frames_per_second, 24.0);
    EXPECT_FALSE(p.output.frames.has_value());
}

// --help must state the real defaults: giving every one of them changes nothing.
TEST(Options, DefaultsInHelpAreTheRealOnes) {
    CLI::App app;
    SharedOptions shared;
    OutputOptions output;
    add_options(app, shared);
    add_options(app, output);
    std::vector<std::string> arguments;
    for (const CLI::Option* option : app.get_options()) {
        const std::string text = option->get_default_str();
        const bool in_words = text.find(' ') != std::string::npos || text == "best";
        if (text.empty() || in_words || option->get_positional()) continue;
        arguments.push_back(option->get_name() + "=" + text);
    }
    ASSERT_GT(arguments.size(), 20u);
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    const SharedOptions plain;
    const RenderSettings& a = shared.settings;
    const RenderSettings& b = plain.settings;
    EXPECT_EQ(a.renderer, b.renderer);
    EXPECT_EQ(std::tie(a.width, a.height, a.samples), std::tie(b.width, b.height, b.samples));
    EXPECT_EQ(std::tie(a.gbuffer, a.shading), std::tie(b.gbuffer, b.shading));
    EXPECT_EQ(std::tie(a.ambient, a.bloom, a.exposure), std::tie(b.ambient, b.bloom, b.exposure));
    EXPECT_EQ(std::tie(a.tone_curve, a.want.view, a.want.aovs),
              std::tie(b.tone_curve, b.want.view, b.want.aovs));
    EXPECT_EQ(std::tie(a.lights.count, a.lights.seed), std::tie(b.lights.count, b.lights.seed));
    EXPECT_EQ(std::tie(a.lights.radius, a.lights.intensity),
              std::tie(b.lights.radius, b.lights.intensity));
    EXPECT_EQ(std::tie(a.grid.tiles_x, a.grid.tiles_y, a.grid.slices_per_octave),
              std::tie(b.grid.tiles_x, b.grid.tiles_y, b.grid.slices_per_octave));
    EXPECT_EQ(a.kernels.lanes, b.kernels.lanes);
    EXPECT_EQ(shared.time, plain.time);
    EXPECT_EQ(output.frames_per_second, OutputOptions().frames_per_second);
    EXPECT_EQ(output.threshold, 0.0);
    EXPECT_EQ(output.metric, OutputOptions().metric);
}

TEST(Options, PictureOptionsArrive) {
    const Parsed p = parsed(
        "grid --renderer deferred-all --resolution 17,31 --gbuffer half --shading blinn-phong "
        "--ambient 0.5 --samples 16 --time -2.5 --show lit --aov depth,light-count --bloom 0.25 "
        "--exposure -1.5 --tonemap aces");
    const RenderSettings& s = p.shared.settings;
    EXPECT_EQ(p.shared.scene, "grid");
    EXPECT_EQ(s.renderer, RendererKind::deferred_all);
    EXPECT_EQ(s.width, 17);
    EXPECT_EQ(s.height, 31);
    EXPECT_EQ(s.gbuffer, static_cast<uint>(GBUFFER_HALF));
    EXPECT_EQ(s.shading, Shading::blinn_phong);
    EXPECT_EQ(s.ambient, 0.5f);
    EXPECT_EQ(s.samples, 16);
    EXPECT_EQ(p.shared.time, -2.5);
    EXPECT_EQ(s.want.aovs, (std::vector<std::string>{"depth", "light-count"}));
    EXPECT_EQ(s.bloom, 0.25f);
    EXPECT_EQ(s.exposure, -1.5f);
    EXPECT_EQ(s.tone_curve, ToneCurve::aces);
}

TEST(Options, LightCameraAndDeviceOptionsArrive) {
    const Parsed p = parsed(
        "--lights 2147483648 --light-seed 18446744073709551615 --light-radius 2.5 "
        "--light-intensity 7 --light-size 0.25 --emissive-lights on --light-box -1,-2,-3,1,2,3 "
        "--light-groups key=lamp*+kind:spot,fill=ies:* --light-mix key=2,fill=0.5:1,0.5,0 "
        "--no-light-layers "
        "--camera-index 3 "
        "--camera-position -1,2,3 "
        "--camera-focal-point 0,0,-1e3 --camera-view-up 0,0,1 --camera-view-angle 45.5 "
        "--camera-orthographic --grid 32,18,8 --lanes 16 --device pthread -v");
    const LightOptions& l = p.shared.settings.lights;
    EXPECT_EQ(l.count, 2147483648u);
    EXPECT_EQ(l.seed, std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(l.radius, 2.5);
    EXPECT_EQ(l.intensity, 7.0);
    EXPECT_EQ(l.size, 0.25);
    EXPECT_EQ(p.shared.load.light_size, 0.25) << "of the file's points";
    EXPECT_EQ(p.shared.emissive_lights, EmissiveLights::on);
    ASSERT_EQ(p.shared.light_groups.size(), 2u);
    EXPECT_EQ(p.shared.light_groups[0].name, "key");
    EXPECT_EQ(p.shared.light_groups[0].patterns, (std::vector<std::string>{"lamp*", "kind:spot"}));
    EXPECT_EQ(text_of(p.shared.light_groups), "key=lamp*+kind:spot,fill=ies:*");
    EXPECT_EQ(text_of(p.shared.settings.light_mix.gains), "key=2,fill=0.5:1,0.5,0");
    EXPECT_TRUE(p.shared.no_light_layers);
    EXPECT_EQ(l.box.min, glm::dvec3(-1, -2, -3));
    EXPECT_EQ(l.box.max, glm::dvec3(1, 2, 3));
    EXPECT_EQ(p.shared.camera.index, 3);
    EXPECT_EQ(p.shared.camera.position, glm::dvec3(-1, 2, 3));
    EXPECT_EQ(p.shared.camera.focal_point, glm::dvec3(0, 0, -1000));
    EXPECT_EQ(p.shared.camera.view_up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(p.shared.camera.view_angle, 45.5);
    EXPECT_TRUE(p.shared.camera.orthographic);
    EXPECT_EQ(p.shared.settings.grid.tiles_x, 32);
    EXPECT_EQ(p.shared.settings.grid.tiles_y, 18);
    EXPECT_EQ(p.shared.settings.grid.slices_per_octave, 8);
    EXPECT_EQ(p.shared.settings.kernels.lanes, 16);
    EXPECT_EQ(p.shared.settings.device, "pthread");
    EXPECT_TRUE(p.shared.verbose);
}

TEST(Options, OutputOptionsArrive) {
    const Parsed p = parsed(
        "-o a/f.####.exr --exr-half --frames 3:9 --fps 12.5 --shard 1/4 --skip-existing --stats - "
        "--reference r.exr --threshold 0.01 --metric max --quiet");
    EXPECT_EQ(p.output.output, "a/f.####.exr");
    EXPECT_TRUE(p.output.encoding.half_colour);
    ASSERT_TRUE(p.output.frames.has_value());
    EXPECT_EQ(p.output.frames->first(), 3);
    EXPECT_EQ(p.output.frames->last(), 9);
    EXPECT_EQ(p.output.frames_per_second, 12.5);
    EXPECT_EQ(p.output.shard.index, 1);
    EXPECT_EQ(p.output.shard.count, 4);
    EXPECT_TRUE(p.output.skip_existing);
    EXPECT_EQ(p.output.stats, "-");
    EXPECT_EQ(p.output.reference, "r.exr");
    EXPECT_EQ(p.output.threshold, 0.01);
    EXPECT_EQ(p.output.metric, "max");
    EXPECT_TRUE(p.shared.quiet);
}

TEST(Options, EveryNameIsTakenAndPlacedRight) {
    const auto renderers = names_of<RendererKind>();
    for (std::size_t i = 0; i < renderers.size(); ++i) {
        const auto kind = parsed("--renderer " + renderers[i]).shared.settings.renderer;
        EXPECT_EQ(static_cast<std::size_t>(kind), i) << renderers[i];
        EXPECT_EQ(name_of(kind), renderers[i]);
    }
    for (const std::string& name : names_of<Shading>()) {
        EXPECT_EQ(name_of(parsed("--shading " + name).shared.settings.shading), name);
    }
    for (const std::string& name : names_of<ToneCurve>()) {
        EXPECT_EQ(name_of(parsed("--tonemap " + name).shared.settings.tone_curve), name);
    }
    const auto layouts = gbuffer_choices().names;
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        EXPECT_EQ(parsed("--gbuffer " + layouts[i]).shared.settings.gbuffer, i) << layouts[i];
    }
    for (const int lanes : {1, 2, 4, 8, 16}) {
        EXPECT_EQ(parsed("--lanes " + std::to_string(lanes)).shared.settings.kernels.lanes, lanes);
    }
    EXPECT_EQ(parsed("--lanes auto").shared.settings.kernels.lanes, 0);
    EXPECT_EQ(parsed("--light-radius auto").shared.settings.lights.radius, 0.0);
}

TEST(Options, PeoplesWaysToWriteNumbers) {
    EXPECT_EQ(parsed("--lights 5k").shared.settings.lights.count, 5000u);
    EXPECT_EQ(parsed("--lights 1e6").shared.settings.lights.count, 1'000'000u);
    EXPECT_EQ(parsed("--lights 1.5M").shared.settings.lights.count, 1'500'000u);
    const RenderSettings settings = parsed("--resolution 1280x720").shared.settings;
    EXPECT_EQ(std::tie(settings.width, settings.height), std::make_tuple(1280, 720));
}

// --help has a meaning for every word; scenes' views come with the renderer.
TEST(Options, EveryChoiceHasAMeaning) {
    for (const Choices& choices :
         {choices_of(RendererKind{}), choices_of(Shading{}), choices_of(ToneCurve{}),
          choices_of(MathMode{}), choices_of(LightColors{}), choices_of(ViewKind{}),
          gbuffer_choices(), aov_choices(), metric_choices()}) {
        ASSERT_EQ(choices.meanings.size(), choices.names.size()) << choices.names[0];
        for (std::size_t i = 0; i < choices.names.size(); ++i) {
            EXPECT_FALSE(choices.meanings[i].empty()) << choices.names[i];
        }
    }
}

TEST(Options, TheLastOneCounts) {
    EXPECT_EQ(parsed("--lights 5 --lights 7").shared.settings.lights.count, 7u);
    EXPECT_EQ(parsed("--lights=5").shared.settings.lights.count, 5u);
}

TEST(Options, BadValuesAreRefusedWithTheOptionTheValueAndWhatIsAllowed) {
    const struct {
        const char* line;
        const char* message;
    } cases[] = {
        {"--resolution 0,9", "--resolution: '0,9' is not W,H"},
        {"--resolution 9", "--resolution: '9' is not W,H"},
        {"--lights -1", "--lights: '-1' is not a whole number from 0 to 2147483648"},
        {"--lights 2147483649", "--lights: '2147483649'"},
        {"--light-seed 1.5", "--light-seed: '1.5'"},
        {"--light-radius 0", "--light-radius: '0' is not 'auto' or a number between 0"},
        {"--light-radius -1", "--light-radius: '-1'"},
        {"--light-intensity inf", "--light-intensity: 'inf'"},
        {"--light-size -1", "--light-size: '-1'"},
        {"--light-box 1,1,1,0,0,0", "--light-box: '1,1,1,0,0,0' is not a box"},
        {"--renderer clustered", "--renderer: 'clustered' is none of deferred, forward-plus"},
        {"--gbuffer fat", "--gbuffer: 'fat' is none of packed, full, half"},
        {"--shading phong", "--shading: 'phong' is none of auto"},
        {"--tonemap filmic", "--tonemap: 'filmic' is none of none, neutral, aces"},
        {"--show everything", "--show: 'everything' is none of lit"},
        {"--aov dpeth", "did you mean 'depth'?"},
        {"--ambient -0.1", "--ambient: '-0.1' is not a number from 0"},
        {"--bloom 2", "--bloom: '2' is not a number from 0 to 1"},
        {"--exposure nan", "--exposure: 'nan' is not a number from -126 to 126"},
        {"--samples 0", "--samples: '0' is not a whole number from 1 to 65536"},
        {"--time inf", "--time: 'inf' is not a finite number"},
        {"--camera-index -1", "--camera-index: '-1'"},
        {"--camera-position 1,2", "--camera-position: '1,2' is not 3 finite numbers X,Y,Z"},
        {"--camera-focal-point a,b,c", "--camera-focal-point: 'a,b,c'"},
        {"--camera-view-up 0,1", "--camera-view-up: '0,1'"},
        {"--camera-view-angle 180", "--camera-view-angle: '180' is not a number between 0 and 180"},
        {"--grid 16,9", "--grid: '16,9' is not X,Y,SLICES_PER_OCTAVE"},
        {"--grid 16,9,65", "--grid: slices per octave: '65' is not a whole number from 1 to 64"},
        {"--grid 0,9,4", "--grid: '0,9,4'"},
        {"--lanes 3", "--lanes: '3' is none of auto, 1, 2, 4, 8, 16"},
        {"--frames 9:3", "--frames: '9:3' is not A:B"},
        {"--fps 0", "--fps: '0' is not a number between 0"},
        {"--shard 4/4", "--shard: '4/4' is not I/N"},
        {"--threshold -1", "--threshold: '-1'"},
        {"--metric psrn", "--metric: 'psrn' is none of rmse"},
        {"-o a.bmp", "a.bmp: image type '.bmp' is none of .exr"},
    };
    for (const auto& c : cases) {
        EXPECT_TRUE(contains(refusal(c.line), c.message)) << c.line << ": " << refusal(c.line);
    }
}

TEST(Options, WhatNeedsOrExcludesEachOther) {
    const struct {
        const char* line;
        const char* message;
    } cases[] = {
        {"", "--output: needs a file"},
        {"-o a.png --frames 1:2", "--output: 'a.png' has no ####"},
        {"-o a.##.png", "no --frames"},
        {"-o a.png --aov depth", "--aov: 'a.png' cannot hold layers"},
        {"-o a.png --aov-ids uint", "--aov-ids: 'a.png' is not an EXR file"},
        {"-o a.png --exr-compression none", "--exr-compression: 'a.png' is not an EXR file"},
        {"-o a.png --exr-half", "--exr-half: 'a.png' is not an EXR file"},
        {"-o a.png --quiet --verbose", "exclude each other"},
        {"-o a.png --show error", "--show error: needs --reference FILE"},
        {"-o a.exr --show error --reference r.png", "holds light"},
        {"-o a.png --shard 0/2", "--shard: needs --frames"},
        {"-o a.png --threshold 0.1", "--threshold: needs --reference FILE"},
        {"-o a.png --difference d.png", "--difference: needs --reference FILE"},
        {"-o a.png --skip-existing --reference r.png", "--skip-existing: leaves frames out"},
        {"-o a.#.png --frames 1:2 --reference r.#.png --difference d.png", "'d.png' has no ####"},
    };
    for (const auto& c : cases) {
        const Parsed p = parsed(c.line);
        const auto message = message_of<UsageError>([&] {
            begin_command(p.shared, !p.output.reference.empty());
            check_output_options(p.shared, p.output);
        });
        EXPECT_TRUE(contains(message, c.message)) << c.line << ": " << message;
    }
    const Parsed good = parsed("-o a.#.exr --frames 1:2 --aov depth --exr-half --shard 0/2");
    EXPECT_NO_THROW(check_output_options(good.shared, good.output));
}

}  // namespace
}  // namespace kilolux
