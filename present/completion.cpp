// SPDX-License-Identifier: Apache-2.0
#include "present/completion.h"

#include <fmt/format.h>
#include <vector>

#include "host/base/text.h"
#include "host/scene/generated/scenes.h"

namespace kilolux {
namespace {

// The bash function that offers values of an option, read from their form in --help; empty for a
// flag.
std::string values_of(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return "";
    const std::string form = option.get_type_name();
    if (form == "FILE" || form == "DIR") return "_kilolux_files";
    const bool list = form.ends_with(",...");
    std::vector<std::string> words;
    for (std::string_view part : split(form, '|')) {
        if (part.ends_with(",...")) part.remove_suffix(4);
        // A word in capitals stands for a kind of value.
        const bool is_word = !part.empty() && (part[0] < 'A' || part[0] > 'Z');
        if (is_word) words.emplace_back(part);
    }
    return fmt::format("{} \"{}\"", list ? "_kilolux_list" : "_kilolux_words", joined(words, " "));
}

std::string cases_of(const CLI::App& app, const std::string& command) {
    std::string out;
    std::vector<std::string> all;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) continue;
        std::vector<std::string> labels;
        const auto add = [&](const std::string& name) {
            labels.push_back(fmt::format("\"{} {}\"", command, name));
            all.push_back(name);
        };
        for (const std::string& name : option->get_lnames()) add("--" + name);
        for (const std::string& name : option->get_snames()) add("-" + name);
        const std::string values = values_of(*option);
        if (values.empty()) continue;
        out += fmt::format("        {}) {}; return ;;\n", joined(labels, "|"), values);
    }
    return out + fmt::format("        \"{} \"*) options=\"{}\" ;;\n", command, joined(all, " "));
}

// {0}: commands, {1}: cases, {2}: generated scenes.
constexpr const char* kScript =
    R"bash(# bash completion for kilolux; source it, or put it into bash-completion's folder
_kilolux_words() {{ COMPREPLY=($(compgen -W "$1" -- "$current")); }}
_kilolux_files() {{ compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- "$current")); }}
_kilolux_list() {{
    local before=""
    [[ $current == *,* ]] && before="${{current%,*}},"
    COMPREPLY=($(compgen -P "$before" -W "$1" -- "${{current##*,}}"))
}}
_kilolux() {{
    local current="${{COMP_WORDS[COMP_CWORD]}}" command="" options="" word
    local previous="${{COMP_WORDS[COMP_CWORD - 1]}}"
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        case " {0} " in *" $word "*) command=$word; break ;; esac
    done
    case "$command $previous" in
{1}    esac
    if [[ $current == -* ]]; then
        _kilolux_words "$options"
    elif [[ -z $command ]]; then
        _kilolux_words "{0}"
    else
        _kilolux_files
        COMPREPLY+=($(compgen -W "{2}" -- "$current"))
    fi
}}
complete -F _kilolux kilolux
)bash";

}  // namespace

std::string bash_completion(const CLI::App& program) {
    std::vector<std::string> commands;
    std::string cases;
    for (const CLI::App* command : program.get_subcommands({})) {
        commands.push_back(command->get_name());
        cases += cases_of(*command, command->get_name());
    }
    return fmt::format(kScript, joined(commands, " "), cases + cases_of(program, ""),
                       joined(generated_scene_names(), " "));
}

}  // namespace kilolux
