// SPDX-License-Identifier: Apache-2.0
#include "present/cli/option_builder.h"

#include <utility>

#include "host/base/suggest.h"

namespace kilolux {
namespace {

std::string long_name(const std::string& names) { return names.substr(0, names.find(',')); }

}  // namespace

Registrar::Registrar(CLI::App& command, std::string heading)
    : command_(command), heading_(std::move(heading)) {}

Registrar& Registrar::value(const OptionText& text, Take take) {
    const std::string name = long_name(text.name);
    const auto taker = [take = std::move(take), name](const std::string& seen) {
        take(name, seen);
    };
    CLI::Option* option = command_.add_option_function<std::string>(text.name, taker, text.meaning);
    option->type_name(text.form)->group(heading_)->default_str(text.standard);
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return *this;
}

Registrar& Registrar::text(const OptionText& text, std::string& out) {
    return value(text, [&out](const std::string&, const std::string& seen) { out = seen; });
}

Registrar& Registrar::flag(const std::string& name, bool& out, const std::string& meaning) {
    command_.add_flag(name, out, meaning)
        ->group(heading_)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return *this;
}

Registrar& Registrar::question(const std::string& name, const std::string& meaning) {
    command_.add_flag(name, meaning)->group(heading_);
    return *this;
}

Registrar& Registrar::number(const OptionText& text, double& out, const NumberRange& range) {
    return value(text, [&out, range](const std::string& name, const std::string& seen) {
        out = parse_number(name, seen, range);
    });
}

Registrar& Registrar::number(const OptionText& text, float& out, const NumberRange& range) {
    return value(text, [&out, range](const std::string& name, const std::string& seen) {
        out = static_cast<float>(parse_number(name, seen, range));
    });
}

Registrar& Registrar::number_or_auto(const OptionText& text, double& out,
                                     const NumberRange& range) {
    return value(text, [&out, range](const std::string& name, const std::string& seen) {
        out = parse_number_or_auto(name, seen, range);
    });
}

Registrar& Registrar::count(const OptionText& text, std::uint64_t& out, const CountRange& range) {
    return value(text, [&out, range](const std::string& name, const std::string& seen) {
        out = parse_count(name, seen, range);
    });
}

Registrar& Registrar::count(const OptionText& text, int& out, const CountRange& range) {
    return value(text, [&out, range](const std::string& name, const std::string& seen) {
        out = static_cast<int>(parse_count(name, seen, range));
    });
}

Registrar& Registrar::vector(const OptionText& text, std::optional<glm::dvec3>& out) {
    return value(text, [&out](const std::string& name, const std::string& seen) {
        out = parse_vector(name, seen);
    });
}

Registrar& Registrar::choice(OptionText text, std::string& out,
                             const std::vector<std::string>& names) {
    return place(std::move(text), names, [&out, names](std::size_t i) { out = names[i]; });
}

Registrar& Registrar::place(OptionText text, const std::vector<std::string>& names,
                            std::function<void(std::size_t)> take) {
    text.form = joined(names, "|");
    return value(text,
                 [names, take = std::move(take)](const std::string& name, const std::string& seen) {
                     take(parse_name(name, seen, names));
                 });
}

}  // namespace kilolux
