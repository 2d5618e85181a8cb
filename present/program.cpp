// SPDX-License-Identifier: Apache-2.0
#include "present/program.h"

#include <cstdio>
#include <memory>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/base/version.h"
#include "host/render/renderer.h"
#include "present/cli/completion.h"
#include "present/cli/device_list.h"
#include "present/cli/help_format.h"
#include "present/cli/option_builder.h"
#include "present/commands/commands.h"
#include "present/config_file.h"

namespace kilolux {
namespace {

constexpr const char* kMeaning =
    "Kilolux lights a scene with thousands to a million lights, and says how fast and how right.";

constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0  done\n"
    "  1  something outside failed: a file, a device, a driver; one line says what\n"
    "  2  the command line cannot be obeyed\n"
    "  3  a comparison with --reference, or a hard case of certify, failed\n"
    "130  interrupted";

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }

bool given(const CLI::App& app, const std::string& name) {
    const CLI::Option* option = app.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
}

}  // namespace

Program::Program() : app_(kMeaning, "kilolux") {
    app_.formatter(std::make_shared<HelpFormat>());
    app_.set_help_flag();
    app_.allow_extras();
    app_.require_subcommand(0, 1);
    app_.footer(kExitCodes);
    Registrar(app_, "Options")
        .question("--help,-h", "Print this help and leave; kilolux COMMAND --help for a command's")
        .question("--version", "Print the version and leave")
        .question("--list-devices", "Print the OpenCL devices and leave")
        .choice({"--completion", "", "", "Print a script that completes options in a shell"},
                completion_shell_, completion_shells());
    add_render_command(*this);
    add_view_command(*this);
    add_bench_command(*this);
    add_report_command(*this);
    add_certify_command(*this);
    add_info_command(*this);
    add_export_command(*this);
}

CLI::App& Program::add_command(const std::string& name, const std::string& meaning,
                               const std::string& examples, std::function<void()> run) {
    CLI::App& command = *app_.add_subcommand(name, meaning);
    command.set_help_flag();
    command.allow_extras();
    command.footer("Examples:\n" + examples);
    Registrar(command, "General")
        .question("--help,-h", "Print this help and leave")
        .text({"--config", "FILE", "", "Options from a file, TOML or JSON; the command line wins"},
              config_file_);
    commands_.push_back({&command, std::move(run)});
    return command;
}

const Program::Command* Program::chosen_command() const {
    for (const Command& command : commands_) {
        if (command.app->parsed()) return &command;
    }
    return nullptr;
}

// --help and its like, which need no valid command line beside them.
bool Program::answer_question(const Command* command) const {
    const CLI::App& app = command != nullptr ? *command->app : app_;
    if (given(app, "--help") || given(app_, "--help")) {
        print(app.help(command != nullptr ? app_.get_name() : ""));
    } else if (given(app_, "--version")) {
        print("kilolux " + version() + "\n");
    } else if (given(app_, "--completion")) {
        print(completion_script(app_, completion_shell_));
    } else if (given(app, "--list-devices") || given(app_, "--list-devices")) {
        print(device_list(list_devices()));
    } else {
        return false;
    }
    return true;
}

void Program::refuse_unknown(const Command* command) const {
    const std::vector<std::string> extras = app_.remaining();
    if (command == nullptr && !extras.empty() && extras[0].rfind('-', 0) != 0) {
        std::vector<std::string> names;
        for (const Command& known : commands_) names.push_back(known.app->get_name());
        throw UsageError("'" + extras[0] + "' is no command; there are " + joined(names) +
                         did_you_mean(extras[0], names));
    }
    refuse_extras(app_, extras);
    if (command == nullptr) throw UsageError("no command given; see kilolux --help");
    refuse_extras(*command->app, command->app->remaining());
}

void Program::run(std::vector<std::string> arguments) {
    // CLI11 takes them from the back.
    app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    const Command* command = chosen_command();
    if (answer_question(command)) return;
    refuse_unknown(command);
    if (!config_file_.empty()) apply_config_file(*command->app, config_file_);
    command->run();
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
    const std::string name = extras[0].substr(0, extras[0].find('='));
    if (name.size() > 1 && name[0] == '-') {
        throw UsageError("unknown option " + name + did_you_mean(name, option_names(command)));
    }
    throw UsageError("unexpected argument '" + extras[0] + "'");
}

}  // namespace kilolux
