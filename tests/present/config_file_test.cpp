// SPDX-License-Identifier: Apache-2.0
#include "present/config_file.h"

#include <gtest/gtest.h>

#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

SharedOptions parse(const std::string& text, std::vector<std::string> arguments = {}) {
    const TemporaryFolder folder;
    write_text(folder / "config", text);
    SharedOptions options;
    CLI::App app;
    add_options(app, options);
    app.parse(arguments);
    apply_config_file(app, folder / "config");
    return options;
}

void expect_both(const SharedOptions& o) {
    EXPECT_EQ(o.scene, "grid");
    EXPECT_EQ(o.settings.lights.count, 77u);
    EXPECT_EQ(o.settings.width, 64);
    EXPECT_EQ(o.settings.height, 48);
    EXPECT_EQ(o.settings.exposure, -1.5f);
    EXPECT_EQ(o.settings.renderer, RendererKind::forward_plus);
    EXPECT_EQ(o.camera.position, glm::dvec3(1, 2.5, -3));
    EXPECT_TRUE(o.quiet);
    EXPECT_FALSE(o.verbose);
}

TEST(ConfigFile, MayHaveNoEnd) {
    CLI::App app;
    EXPECT_TRUE(contains(message_of<Error>([&] { apply_config_file(app, "/dev/zero"); }),
                         "/dev/zero: cannot read: is larger than 256 MiB"));
}

TEST(ConfigFile, Toml) {
    expect_both(
        parse("# a comment\nscene = \"grid\"\nlights = 77\nresolution = [64, 48]\n"
              "exposure = -1.5\nrenderer = \"forward-plus\"\ncamera-position = \"1,2.5,-3\"\n"
              "quiet = true\nverbose = false\n"));
}

TEST(ConfigFile, Json) {
    expect_both(parse(R"({"scene": "grid", "lights": 77, "resolution": [64, 48], "exposure": -1.5,
                  "renderer": "forward-plus", "camera-position": [1, 2.5, -3],
                  "quiet": true, "verbose": false})"));
}

TEST(ConfigFile, TheCommandLineWins) {
    const SharedOptions o = parse("lights = 77\nlight-seed = 3\n", {"5", "--lights"});
    EXPECT_EQ(o.settings.lights.count, 5u);
    EXPECT_EQ(o.settings.lights.seed, 3u);
}

TEST(ConfigFile, UnknownNamesAndBadValues) {
    const struct {
        const char* text;
        const char* message;
    } cases[] = {
        {"ligths = 5\n", "unknown option 'ligths'; did you mean '--lights'?"},
        {"{\"ligths\": 5}", "unknown option 'ligths'"},
        {"lights = -5\n", "--lights: '-5' is not a whole number"},
        {"{\"lights\": 5.5}", "--lights: '5.5' is not a whole number"},
        {"{\"lights\": null}", "lights: 'null' must be a text, a number"},
        {"{\"lights\": {\"n\": 5}}", "must be a text, a number"},
        {"quiet = 3\n", "quiet: '3' is not true or false"},
        {"[camera]\nposition = \"0,0,0\"\n", "[camera]"},
        {"{\"lights\": 5", "is not valid JSON"},
        {"lights = 5\nquiet = true\nlights = 6\n",
         "config:3: 'lights' is given twice, as 5 and as 6; give a list as an array"},
        {"# two\n\nlights = 5 # first\n'lights'=6\n",
         "config:4: 'lights' is given twice, as 5 and as 6"},
        {"resolution = [\n64,\n 48 ]\nresolution = [1, 2]\n",
         "config:4: 'resolution' is given twice, as [ 64, 48 ] and as [1, 2]"},
        {"variant = \"a#[=\"\nvariant = 'a#[='\n",
         "config:2: 'variant' is given twice, as \"a#[=\" and as 'a#[='"},
        {"\"quiet\" = true\nquiet = true\n",
         "config:2: 'quiet' is given twice, as true and as true"},
        {"{\"lights\": 5, \"lights\": 6}", "config: 'lights' is given twice, as 5 and as 6"},
        {"{\"aov\": [\"depth\"], \"aov\": [\"normal\"]}", "is given twice, as depth and as normal"},
    };
    for (const auto& c : cases) {
        const auto message = message_of<UsageError>([&] { parse(c.text); });
        EXPECT_TRUE(contains(message, c.message)) << c.text << ": " << message;
    }
}

TEST(ConfigFile, AnEmptyOneSaysNothing) {
    for (const char* text : {"", "\n", "# a comment\n", "{}"}) {
        EXPECT_EQ(parse(text), SharedOptions()) << text;
    }
}

TEST(ConfigFile, AFileThatCannotBeRead) {
    CLI::App app;
    const TemporaryFolder folder;
    EXPECT_EQ(message_of<Error>([&] { apply_config_file(app, folder.path()); }),
              folder.path().string() + ": cannot read: Is a directory");
    const auto message = message_of<Error>([&] { apply_config_file(app, "/no/such/file"); });
    EXPECT_EQ(message, "/no/such/file: cannot read: No such file or directory");
}

}  // namespace
}  // namespace kilolux
