// SPDX-License-Identifier: Apache-2.0
// Tests every option that a command registers.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "present/cli/option_builder.h"
#include "present/commands/assemble/assemble.h"
#include "present/commands/bench/bench_options.h"
#include "present/commands/benchmark/score.h"
#include "present/commands/certify/certify.h"
#include "present/commands/export.h"
#include "present/commands/info.h"
#include "present/commands/merge/merge.h"
#include "present/commands/photometry/photometry.h"
#include "present/commands/render.h"
#include "present/commands/report.h"
#include "present/commands/view.h"
#include "present/completion.h"
#include "present/config_file.h"
#include "tests/support/option_examples.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

using Texts = std::map<std::string, std::string>;
using Words = std::vector<std::string>;

// The command refuses each value of the option but its default.
constexpr const char* kRefused = "refused";

// The options of a command, each with a value that is not its default.
template <typename Options>
class CommandOptions {
 public:
    // `own`: values in place of those of other_value(). `required`: words of each command line.
    CommandOptions(void (*declare)(CLI::App&, Options&), Texts own, Words required)
        : declare_(declare), required_(std::move(required)) {
        Options options;
        CLI::App app;
        declare(app, options);
        for (const Setting& s : settings_of(options)) {
            if (!own.contains(s.option())) own[s.option()] = other_value(s);
        }
        for (const CLI::Option* option : app.get_options()) {
            const std::string name = option->get_name();
            if (name == "--help" || option->get_required() || own[name] == kRefused) continue;
            EXPECT_NE(own[name], "") << name << ": no row of visit_settings() has it";
            values_[name] = own[name];
        }
        EXPECT_GT(values_.size(), 2u);
    }

    Options made(Words words, const std::filesystem::path& config = {}) const {
        Options options;
        CLI::App app;
        declare_(app, options);
        words.insert(words.end(), required_.begin(), required_.end());
        app.parse(Words(words.rbegin(), words.rend()));
        if (!config.empty()) apply_config_file(app, config);
        return options;
    }

    Options with(const std::string& name) const { return made({word(name)}); }

    // All options but one.
    Options without(const std::string& name) const {
        Words words;
        for (const auto& [option, text] : values_) {
            if (option != name) words.push_back(word(option));
        }
        return made(words);
    }

    void each_changes_itself_alone() const {
        const Options none = made({}), all = without("");
        const Texts before = shown(none);
        for (const auto& [name, text] : values_) {
            const Options changed = with(name);
            EXPECT_FALSE(changed == none) << name;
            EXPECT_FALSE(without(name) == all) << name << " sets what another option sets";
            for (const auto& [option, now] : shown(changed)) {
                EXPECT_EQ(now, option == name ? text : before.at(option)) << name << ", " << option;
            }
        }
    }

    void each_comes_from_config_files() const {
        const TemporaryFolder folder;
        for (const auto& [name, text] : values_) {
            const std::string key = name.starts_with("--") ? name.substr(2) : lower(name);
            const nlohmann::json value = text;
            write_text(folder / "a.json", nlohmann::json{{key, text}}.dump());
            write_text(folder / "a.toml", key + " = " + value.dump() + "\n");
            for (const char* file : {"a.json", "a.toml"}) {
                EXPECT_TRUE(made({}, folder / file) == with(name)) << name << " by " << file;
            }
        }
    }

    void each_number_has_a_unit() const {
        Options options;
        CLI::App app;
        declare_(app, options);
        for (const Setting& setting : settings_of(options)) {
            const std::string& unit = setting.text.unit;
            const bool is_number = setting.kind == SettingKind::number ||
                                   setting.kind == SettingKind::count ||
                                   setting.kind == SettingKind::numbers;
            EXPECT_FALSE(is_number && unit.empty()) << setting.option();
            const std::string help = app.get_option(setting.option())->get_description();
            const bool is_said = help.ends_with("[" + unit + "]");
            EXPECT_EQ(is_said, !unit.empty() && unit != "1") << setting.option() << ": " << help;
        }
    }

    // `members` gives those that the options set.
    template <typename Members>
    void reach_every(Members members) const {
        const Options none{}, all = without("");
        const auto before = members(none), after = members(all);
        const auto differ = [&]<std::size_t... i>(std::index_sequence<i...>) {
            return std::vector<bool>{!(std::get<i>(before) == std::get<i>(after))...};
        };
        const auto reached =
            differ(std::make_index_sequence<std::tuple_size_v<decltype(members(none))>>());
        for (std::size_t i = 0; i < reached.size(); ++i) EXPECT_TRUE(reached[i]) << "member " << i;
    }

 private:
    std::string word(const std::string& name) const {
        const std::string& text = values_.at(name);
        return name.starts_with("--") ? name + "=" + text : text;
    }

    // The rows' texts.
    static Texts shown(Options options) {
        Texts out;
        for (const Setting& setting : settings_of(options)) {
            if (setting.show) out[setting.option()] = setting.show();
        }
        return out;
    }

    void (*declare_)(CLI::App&, Options&);
    Words required_;
    Texts values_;
};

template <typename Options, typename Members>
void walk(void (*declare)(CLI::App&, Options&), Members members, const Texts& own,
          const Words& required = {}) {
    const CommandOptions options(declare, own, required);
    options.each_changes_itself_alone();
    options.each_comes_from_config_files();
    options.each_number_has_a_unit();
    options.reach_every(members);
}

// A new member of a command's options does not compile here.
void walk_render() {
    walk(add_render_options,
         [](const RenderOptions& o) {
             const auto& [shared, output, budget, has_alpha, command, tiles] = o;
             return std::tie(shared, output, budget);
         },
         {});
}

void walk_view() {
    walk(add_view_options,
         [](const ViewOptions& o) {
             const auto& [shared, exit_after, screenshot, script, fresh, serve, server] = o;
             const auto& [address, viewers, certificate, key] = server;
             return std::tie(shared, exit_after, screenshot, script, fresh, serve, viewers,
                             certificate, key);
         },
         {{"--screenshot", "a.png"},
          {"--script", "a.txt"},
          {"--serve", "127.0.0.1:8080"},
          {"--tls-certificate", "a.pem"},
          {"--tls-key", "b.pem"}});
}

void walk_bench() {
    walk(add_bench_options,
         [](const BenchOptions& o) {
             const auto& [shared, axes, warm_up, frames, motion, output, jobs, tables, shard,
                          resume, json, quick, tune, budget] = o;
             const auto& [renderers, resolutions, lights, grids, lanes, gbuffers] = axes;
             return std::tie(shared, renderers, resolutions, lights, grids, lanes, gbuffers,
                             warm_up, frames, motion, output, jobs, tables, shard, resume, json,
                             quick, tune, budget);
         },
         {{"--background", kRefused},
          {"--renderer", "forward,deferred"},
          {"--resolution", "64,36;128,72"},
          {"--lights", "10:30:10"},
          {"--grid", "8,4,2;4,4,1"},
          {"--lanes", "2,4"},
          {"--gbuffer", "full,half"},
          {"--warm-up", "3"},
          {"--frames", "7"},
          {"--output", "out"},
          {"--job", "png,exr"},
          {"--table", "a.csv"}});
}

void walk_report() {
    walk(add_options<ReportOptions>,
         [](const ReportOptions& o) {
             const auto& [shared, warm_up, frames, output, axes, json, quick, check_default,
                          mixed_devices, devices, shard, budget] = o;
             return std::tie(shared, warm_up, frames, output, axes, json, quick, check_default,
                             mixed_devices, shard, budget);
         },
         {{"--background", kRefused}, {"--warm-up", "3"}, {"--frames", "7"}, {"--output", "out"}});
}

void walk_certify() {
    walk(add_options<CertifyOptions>,
         [](const CertifyOptions& o) {
             const auto& [device, lanes, cases, parts, isolate, jobs, resume, quick, tables, output,
                          progress, quiet] = o;
             return std::tie(device, lanes, cases, parts, isolate, jobs, resume, quick, tables,
                             output, progress, quiet);
         },
         {{"--case", "tiny-lights"},
          {"--lanes", "2,4"},
          {"--with", "tuning"},
          {"--table", "a.json"}});
}

void walk_info() {
    walk(add_options<InfoOptions>,
         [](const InfoOptions& o) {
             const auto& [shared, json, costs, measure_limits, check_limits] = o;
             return std::tie(shared, json, costs, measure_limits, check_limits);
         },
         {{"--background", kRefused}});
}

void walk_export() {
    walk(add_export_options,
         [](const ExportOptions& o) {
             const auto& [shared, output, benchmark] = o;
             return std::tie(shared, output, benchmark);
         },
         {{"--background", kRefused}, {"--output", "a.glb"}, {"--benchmark", "set"}});
}

void walk_score() {
    walk(add_score_options,
         [](const ScoreOptions& o) {
             const auto& [shared, picture, reference, inverse_square, json] = o;
             return std::tie(shared, reference, inverse_square, json);
         },
         {{"--background", kRefused}, {"--scene", "grid"}}, {"mine.exr"});
}

void walk_photometry() {
    walk(add_photometry_options,
         [](const PhotometryOptions& o) {
             const auto& [shared, points, plane, exact_points, output, json] = o;
             return std::tie(shared, points, plane, exact_points, output, json);
         },
         {{"--background", kRefused},
          {"--plane", "0,0,0,4,0,0,0,0,-3,8,6"},
          {"--points", "desk points.csv"},
          {"--exact-points", "7"},
          {"--output", "a.csv"}});
}

void walk_assemble() {
    walk(add_assemble_options,
         [](const AssembleOptions& o) {
             const auto& [output, tiles, progress, quiet] = o;
             return std::tie(output, tiles, progress, quiet);
         },
         {}, {"tile.exr"});
}

void walk_merge() {
    walk(add_merge_options,
         [](const MergeOptions& o) {
             const auto& [output, results, keep_differences, check_default, quiet] = o;
             return std::tie(output, results, keep_differences, check_default, quiet);
         },
         {{"--output", "out"}}, {"result"});
}

TEST(CommandOptions, ChangeThemselvesAlone) {
    const std::map<std::string, void (*)()> walks = {
        {"render", walk_render},         {"view", walk_view},         {"bench", walk_bench},
        {"report", walk_report},         {"certify", walk_certify},   {"info", walk_info},
        {"export", walk_export},         {"assemble", walk_assemble}, {"merge", walk_merge},
        {"photometry", walk_photometry}, {"score", walk_score}};
    const Program program;
    for (const CLI::App* command : program.app().get_subcommands({})) {
        const std::string& name = command->get_name();
        SCOPED_TRACE(name);
        ASSERT_TRUE(walks.contains(name)) << "this test needs the options of the command";
        walks.at(name)();
    }
}

TEST(CommandOptions, AreInHelpAndCompletion) {
    const Program program;
    const std::string completion = bash_completion(program.app());
    for (const CLI::App* command : program.app().get_subcommands({})) {
        const std::string& name = command->get_name();
        const std::string help = command->help("", CLI::AppFormatMode::All);
        const std::string label = "\"" + name + " \"*) options=\"";
        const std::size_t begin = completion.find(label);
        ASSERT_NE(begin, std::string::npos) << name;
        const std::string offered =
            completion.substr(begin, completion.find('\n', begin) - begin) + ",";
        for (const std::string& option : option_names(*command)) {
            EXPECT_NE(help.find("\n  " + option), std::string::npos) << name << " " << option;
            EXPECT_TRUE(offered.find(option + " ") != std::string::npos ||
                        offered.find(option + "\"") != std::string::npos)
                << name << " " << option;
        }
    }
}

}  // namespace
}  // namespace kilolux
