// SPDX-License-Identifier: Apache-2.0
// The command line as a whole: finds and runs the subcommand.
#pragma once

#include <CLI/App.hpp>
#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "present/cli/option_builder.h"

namespace kilolux {

/// The program `kilolux` with its subcommands.
class Program {
 public:
    /// Adds all subcommands.
    Program();

    /// A new subcommand with --help, --help-all and --config; `examples` end its help. `run` is
    /// called once the command line is parsed. The returned App lives as long as the Program.
    CLI::App& add_command(const std::string& name, const std::string& meaning,
                          const std::string& examples, std::function<void()> run);

    /// A subcommand with options: `declare(command, options)` registers them, and `obey(options,
    /// command)` or `obey(options)` runs it.
    template <typename Options, typename Run>
    void add_command(const std::string& name, const std::string& meaning,
                     const std::string& examples, void (*declare)(CLI::App&, Options&), Run obey) {
        const auto options = std::make_shared<Options>();
        const auto self = std::make_shared<const CLI::App*>();
        CLI::App& command = add_command(name, meaning, examples, [options, self, obey] {
            if constexpr (std::invocable<Run, Options&, const CLI::App&>) {
                obey(*options, **self);
            } else {
                obey(*options);
            }
        });
        *self = &command;
        declare(command, *options);
        add_device_question(command);
    }

    /// Parses and runs `arguments` (without the program's name). Throws UsageError or
    /// CLI::ParseError for an invalid command line, and the subcommand's exceptions.
    void run(std::vector<std::string> arguments);

    const CLI::App& app() const { return app_; }

 private:
    struct Command {
        CLI::App* app;
        std::function<void()> run;
    };

    const Command* command_in(const std::vector<std::string>& words) const;
    bool answer_question(const std::vector<std::string>& words) const;
    void refuse_unknown_command(const std::vector<std::string>& words) const;

    CLI::App app_;
    std::string completion_shell_;
    std::string config_file_;
    std::vector<Command> commands_;
};

/// "--lights", "--quiet", ...: the long options of a command.
std::vector<std::string> option_names(const CLI::App& command);

/// Whether the command line holds the option.
bool is_given(const CLI::App& command, const std::string& name);

/// Throws UsageError, with the nearest known one, for arguments that no option of `command` took.
void refuse_extras(const CLI::App& command, const std::vector<std::string>& extras);

}  // namespace kilolux
