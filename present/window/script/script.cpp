// SPDX-License-Identifier: Apache-2.0
#include "present/window/script/script.h"

#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "present/window/script/script_player.h"

namespace kilolux {
namespace {

// Words after the step's own name, at least and at most.
struct Arity {
    std::size_t least = 0;
    std::size_t most = 0;
};

const std::map<std::string, Arity>& known_steps() {
    static const std::map<std::string, Arity> steps = {
        {"key", {2, 2}},   {"drag", {4, 5}},       {"move", {2, 2}},   {"wheel", {1, 1}},
        {"open", {1, 9}},  {"click", {1, 9}},      {"choose", {2, 9}}, {"slide", {2, 9}},
        {"type", {2, 9}},  {"resize", {2, 2}},     {"frames", {1, 1}}, {"settle", {0, 0}},
        {"close", {0, 0}}, {"screenshot", {1, 1}}, {"away", {0, 0}}};
    return steps;
}

void check_step(const ScriptStep& step) {
    const std::string& name = step.words[0];
    const auto found = known_steps().find(name);
    if (found == known_steps().end()) {
        std::vector<std::string> names;
        for (const auto& [known, arity] : known_steps()) names.push_back(known);
        throw UsageError(step.place + ": '" + name + "' is not a step; there are " + joined(names) +
                         did_you_mean(name, names));
    }
    const std::size_t count = step.words.size() - 1;
    if (count >= found->second.least && count <= found->second.most) return;
    throw UsageError(fmt::format("{}: '{}' with {} words after it; it takes {} or more", step.place,
                                 name, count, found->second.least));
}

}  // namespace

std::vector<ScriptStep> read_script(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw Error(file.string() + ": cannot read the script");
    std::vector<ScriptStep> steps;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        ScriptStep step{fmt::format("{}:{}", file.string(), number), {}};
        std::istringstream words(line);
        for (std::string word; words >> word;) step.words.push_back(word);
        if (step.words.empty() || step.words[0][0] == '#') continue;
        check_step(step);
        steps.push_back(std::move(step));
    }
    return steps;
}

}  // namespace kilolux
