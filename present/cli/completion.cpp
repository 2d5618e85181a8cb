// SPDX-License-Identifier: Apache-2.0
#include "present/cli/completion.h"

#include <sstream>

#include "host/base/suggest.h"
#include "host/scene/generated/scenes.h"
#include "present/cli/option_values.h"

namespace kilolux {
namespace {

// What may follow an option, read from the form of its value in --help.
struct Values {
    std::vector<std::string> words;
    bool list = false;   // several words with commas between
    bool files = false;  // file names
    bool none = false;   // a flag
};

Values values_of(const CLI::Option& option) {
    Values values;
    values.none = option.get_items_expected_max() == 0;
    const std::string form = option.get_type_name();
    values.files = form == "FILE" || form == "DIR";
    std::istringstream parts(form);
    for (std::string part; std::getline(parts, part, '|');) {
        if (part.ends_with(",...")) {
            values.list = true;
            part.resize(part.size() - 4);
        }
        // Capitals stand for a kind of value, not for a word.
        const bool is_word = !part.empty() && (part[0] < 'A' || part[0] > 'Z');
        if (is_word) values.words.push_back(part);
    }
    return values;
}

std::vector<const CLI::Option*> dashed_options(const CLI::App& app) {
    std::vector<const CLI::Option*> options;
    for (const CLI::Option* option : app.get_options()) {
        if (option->nonpositional()) options.push_back(option);
    }
    return options;
}

std::vector<std::string> dashed_names(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    return names;
}

std::vector<std::string> command_names(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({}))
        names.push_back(command->get_name());
    return names;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

std::string bash_case(const CLI::App& app, const std::string& command) {
    std::string out;
    std::string all;
    for (const CLI::Option* option : dashed_options(app)) {
        std::string labels;
        for (const std::string& name : dashed_names(*option)) {
            labels += (labels.empty() ? "\"" : "|\"") + command + " " + name + "\"";
            all += (all.empty() ? "" : " ") + name;
        }
        const Values values = values_of(*option);
        if (values.none) continue;
        out += "        " + labels + ") ";
        if (values.files) {
            out += "_kilolux_files";
        } else {
            out += (values.list ? "_kilolux_list \"" : "_kilolux_words \"") +
                   joined(values.words, " ") + "\"";
        }
        out += "; return ;;\n";
    }
    return out + "        \"" + command + " \"*) options=\"" + all + "\" ;;\n";
}

std::string bash_script(const CLI::App& program) {
    const std::string commands = joined(command_names(program), " ");
    std::string cases;
    for (const CLI::App* command : program.get_subcommands({})) {
        cases += bash_case(*command, command->get_name());
    }
    cases += bash_case(program, "");
    return "# bash completion for kilolux; source it, or put it into bash-completion's folder\n"
           "_kilolux_words() { COMPREPLY=($(compgen -W \"$1\" -- \"$current\")); }\n"
           "_kilolux_files() { compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- "
           "\"$current\")); }\n"
           "_kilolux_list() {\n"
           "    local before=\"\"\n"
           "    [[ $current == *,* ]] && before=\"${current%,*},\"\n"
           "    COMPREPLY=($(compgen -P \"$before\" -W \"$1\" -- \"${current##*,}\"))\n"
           "}\n"
           "_kilolux() {\n"
           "    local current=\"${COMP_WORDS[COMP_CWORD]}\" command=\"\" options=\"\" word\n"
           "    local previous=\"${COMP_WORDS[COMP_CWORD - 1]}\"\n"
           "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
           "        case \" " +
           commands +
           " \" in *\" $word \"*) command=$word; break ;; esac\n"
           "    done\n"
           "    case \"$command $previous\" in\n" +
           cases +
           "    esac\n"
           "    if [[ $current == -* ]]; then\n"
           "        _kilolux_words \"$options\"\n"
           "    elif [[ -z $command ]]; then\n"
           "        _kilolux_words \"" +
           commands +
           "\"\n"
           "    else\n"
           "        _kilolux_files\n"
           "        COMPREPLY+=($(compgen -W \"" +
           joined(generated_scene_names(), " ") +
           "\" -- \"$current\"))\n"
           "    fi\n"
           "}\n"
           "complete -F _kilolux kilolux\n";
}

// One specification of zsh's _arguments, in single quotes.
std::string zsh_option(const CLI::Option& option) {
    std::string meaning = option.get_description();
    for (const char* special : {"[", "]", ":"}) {
        meaning = replaced(meaning, special, std::string("\\") + special);
    }
    const Values values = values_of(option);
    std::string action;
    if (!values.none) {
        action = ":" + replaced(option.get_type_name(), ":", "\\:") + ":";
        if (values.files) {
            action += "_files";
        } else if (values.list) {
            action += "_values -s , layer " + joined(values.words, " ");
        } else if (!values.words.empty()) {
            action += "(" + joined(values.words, " ") + ")";
        }
    }
    std::string out;
    for (const std::string& name : dashed_names(option)) {
        out += " \\\n                '*" +
               replaced(name + "[" + meaning + "]" + action, "'", "'\\''") + "'";
    }
    return out;
}

std::string zsh_script(const CLI::App& program) {
    std::string out = "#compdef kilolux\n_kilolux() {\n    local -a commands=(";
    std::string cases;
    for (const CLI::App* command : program.get_subcommands({})) {
        out += "\n        '" + command->get_name() + ":" +
               replaced(command->get_description(), "'", "'\\''") + "'";
        cases += "        " + command->get_name() + ")\n            _arguments";
        for (const CLI::Option* option : dashed_options(*command)) cases += zsh_option(*option);
        cases += " \\\n                '1:scene:_alternative \"scenes:scene:(" +
                 joined(generated_scene_names(), " ") +
                 ")\" \"files:file:_files -g \\*.gl\\(tf\\|b\\)\"' ;;\n";
    }
    out +=
        ")\n    if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then\n"
        "        _describe command commands\n        return\n    fi\n";
    out +=
        "    local command=$words[2]\n    (( CURRENT > 2 )) && { shift words; (( CURRENT-- )) }\n"
        "    case $command in\n" +
        cases + "        *)\n            _arguments";
    for (const CLI::Option* option : dashed_options(program)) out += zsh_option(*option);
    return out + " ;;\n    esac\n}\n_kilolux \"$@\"\n";
}

std::string fish_option(const CLI::Option& option, const std::string& condition) {
    std::string out = "complete -c kilolux -n '" + condition + "'";
    for (const std::string& name : option.get_lnames()) out += " -l " + name;
    for (const std::string& name : option.get_snames()) out += " -s " + name;
    const Values values = values_of(option);
    if (values.files) out += " -r -F";
    if (!values.none && !values.files) out += " -x";
    if (!values.words.empty()) out += " -a '" + joined(values.words, " ") + "'";
    return out + " -d '" + replaced(option.get_description(), "'", "\\'") + "'\n";
}

std::string fish_script(const CLI::App& program) {
    std::string out = "# fish completion for kilolux\n";
    for (const CLI::Option* option : dashed_options(program)) {
        out += fish_option(*option, "__fish_use_subcommand");
    }
    for (const CLI::App* command : program.get_subcommands({})) {
        const std::string here = "__fish_seen_subcommand_from " + command->get_name();
        out += "complete -c kilolux -f -n __fish_use_subcommand -a " + command->get_name() +
               " -d '" + replaced(command->get_description(), "'", "\\'") + "'\n";
        out += "complete -c kilolux -n '" + here + "' -a '" + joined(generated_scene_names(), " ") +
               "'\n";
        for (const CLI::Option* option : dashed_options(*command))
            out += fish_option(*option, here);
    }
    return out;
}

}  // namespace

std::vector<std::string> completion_shells() { return {"bash", "zsh", "fish"}; }

std::string completion_script(const CLI::App& program, const std::string& shell) {
    switch (parse_name("--completion", shell, completion_shells())) {
        case 0:
            return bash_script(program);
        case 1:
            return zsh_script(program);
        default:
            return fish_script(program);
    }
}

}  // namespace kilolux
