// SPDX-License-Identifier: Apache-2.0
#include "present/program.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdio>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/base/version.h"
#include "host/render/renderer.h"
#include "present/cli/commit.h"
#include "present/commands/assemble/assemble.h"
#include "present/commands/bench/bench.h"
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
#include "present/help_format.h"

namespace kilolux {
namespace {

constexpr const char* kMeaning =
    "Kilolux lights a scene with thousands to a million lights, and says how fast and how right.";

constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0  done\n"
    "  1  runtime error (file, device, driver); one line on stderr says which\n"
    "  2  the command line cannot be obeyed\n"
    "  3  a comparison with --reference, or a hard case of certify, failed\n"
    "128+N  ended by signal N: 130 SIGINT, 143 SIGTERM";

using Words = std::vector<std::string>;

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }

bool has_any(const Words& words, const Words& wanted) {
    return std::find_first_of(words.begin(), words.end(), wanted.begin(), wanted.end()) !=
           words.end();
}

// A line a device, with the index that --device takes.
std::string device_list(const std::vector<DeviceInfo>& devices) {
    if (devices.empty()) choose_device("");  // says why there is none
    std::string out;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& d = devices[i];
        out += fmt::format("{}  {} ({}, {} compute units, {} lanes, {} MiB; {}; driver {}; {})\n",
                           i, d.name, d.is_cpu ? "CPU" : "GPU", d.compute_units, d.lane_width,
                           d.memory_bytes >> 20, d.version, d.driver, d.platform);
    }
    return out;
}

// "help render" as "render --help", "version" as "--version".
Words as_options(Words words) {
    if (words.empty()) return words;
    if (words[0] == "version") words[0] = "--version";
    if (words[0] == "help") {
        words.erase(words.begin());
        words.emplace_back("--help");
    }
    return words;
}

}  // namespace

Program::Program() : app_(kMeaning, "kilolux") {
    app_.formatter(std::make_shared<HelpFormat>());
    app_.set_help_flag();
    app_.allow_extras();
    app_.require_subcommand(0, 1);
    app_.footer(kExitCodes);
    const auto question = [this](const char* name, const char* meaning) {
        add_question(app_, "Options", name, meaning);
    };
    question("--help,-h", "Print this help and leave; kilolux help COMMAND for a command's");
    question("--version,-V", "Print the version and leave");
    question("--list-devices", "Print the OpenCL devices and leave");
    OptionBuilder(app_, "Options")
        .choice({"--completion", "", "", "Print a script that completes options in a shell"},
                completion_shell_, Choices(Words{"bash"}));
    add_render_command(*this);
    add_view_command(*this);
    add_bench_command(*this);
    add_report_command(*this);
    add_certify_command(*this);
    add_info_command(*this);
    add_photometry_command(*this);
    add_export_command(*this);
    add_score_command(*this);
    add_assemble_command(*this);
    add_merge_command(*this);
}

CLI::App& Program::add_command(const std::string& name, const std::string& meaning,
                               const std::string& examples, std::function<void()> run) {
    CLI::App& command = *app_.add_subcommand(name, meaning);
    command.set_help_flag();
    command.allow_extras();
    command.footer(
        fmt::format("kilolux {} --help-all lists every option.\n\nExamples:\n{}", name, examples));
    add_question(command, "General", "--help,-h", "Print this help and leave");
    add_question(command, "General", "--help-all", "Print the help of every option and leave");
    OptionBuilder(command, "General")
        .text({"--config", "FILE", "", "Options from a file, TOML or JSON; the command line wins"},
              config_file_);
    commands_.push_back({&command, std::move(run)});
    return command;
}

const Program::Command* Program::command_in(const Words& words) const {
    for (const std::string& word : words) {
        for (const Command& command : commands_) {
            if (command.app->get_name() == word) return &command;
        }
    }
    return nullptr;
}

// --help and --version are answered even where the rest of the command line is invalid.
bool Program::answer_question(const Words& words) const {
    const Command* command = command_in(words);
    const bool all = has_any(words, {"--help-all"});
    if (all || has_any(words, {"--help", "-h"})) {
        if (command == nullptr) refuse_unknown_command(words);
        const CLI::App& app = command != nullptr ? *command->app : app_;
        print(app.help(command != nullptr ? app_.get_name() : "",
                       all ? CLI::AppFormatMode::All : CLI::AppFormatMode::Normal));
        return true;
    }
    if (!has_any(words, {"--version", "-V"})) return false;
    print(fmt::format("kilolux {}, commit {}\nbuilt with {}\n", version(), commit(), built_with()));
    return true;
}

void Program::refuse_unknown_command(const Words& words) const {
    if (words.empty() || words[0].starts_with('-')) return;
    Words names;
    for (const Command& known : commands_) names.push_back(known.app->get_name());
    throw UsageError(fmt::format("'{}' is no command; there are {}{}", words[0], joined(names),
                                 did_you_mean(words[0], names)));
}

void Program::run(Words arguments) {
    arguments = as_options(std::move(arguments));
    if (answer_question(arguments)) return;
    // CLI11 takes arguments in reverse order.
    app_.parse(Words(arguments.rbegin(), arguments.rend()));
    const Command* command = nullptr;
    for (const Command& known : commands_) {
        if (known.app->parsed()) command = &known;
    }
    if (is_given(app_, "--completion")) return print(bash_completion(app_));
    if (is_given(command != nullptr ? *command->app : app_, "--list-devices")) {
        return print(device_list(list_devices()));
    }
    if (command == nullptr) refuse_unknown_command(app_.remaining());
    refuse_extras(app_, app_.remaining());
    if (command == nullptr) throw UsageError("no command given; see kilolux --help");
    refuse_extras(*command->app, command->app->remaining());
    if (!config_file_.empty()) apply_config_file(*command->app, config_file_);
    command->run();
}

bool is_given(const CLI::App& command, const std::string& name) {
    const CLI::Option* option = command.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

void refuse_extras(const CLI::App& command, const std::vector<std::string>& extras) {
    if (extras.empty()) return;
    // CLI11 keeps the mark behind which no argument is an option.
    const bool ended = extras[0] == "--";
    if (ended && extras.size() == 1) return;
    const std::string name = extras[0].substr(0, extras[0].find('='));
    if (!ended && name.size() > 1 && name[0] == '-') {
        if (command.get_name() == "bench" && (name == "--turntable" || name == "--camera-keys")) {
            throw UsageError(name +
                             ": bench times one view, so that its rows compare; render --stats "
                             "FILE has the times of every frame");
        }
        throw UsageError("unknown option " + name + did_you_mean(name, option_names(command)));
    }
    throw UsageError("unexpected argument '" + extras[ended ? 1 : 0] + "'");
}

}  // namespace kilolux
