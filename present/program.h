// SPDX-License-Identifier: Apache-2.0
// The command line as a whole: the subcommands, and which one is meant.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace kilolux {

/// The program `kilolux` with its subcommands.
class Program {
 public:
    /// With every subcommand there is.
    Program();

    /// A new subcommand with --help, --help-all and --config; `examples` end its help. `run` is
    /// called once the command line is parsed. The returned App lives as long as the Program.
    CLI::App& add_command(const std::string& name, const std::string& meaning,
                          const std::string& examples, std::function<void()> run);

    /// Parses and obeys `arguments` (without the program's name). Throws UsageError or
    /// CLI::ParseError for what cannot be obeyed, and whatever the subcommand throws.
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

/// Throws UsageError, with the nearest known one, for arguments that no option of `command` took.
void refuse_extras(const CLI::App& command, const std::vector<std::string>& extras);

}  // namespace kilolux
