// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/system/read_text.h"
#include "host/base/text.h"
#include "present/commands/bench.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The command in a line of its own, then the conditions.
std::string context_text(const Json& document, const std::string& fields) {
    const auto word = [&](const char* path) {
        const Json& value = document.at(Json::json_pointer(path));
        return value.is_string() ? value.get<std::string>() : value.dump();
    };
    const Json& context = document.at("context");
    std::string size, commands;
    for (const Json& part : document.value("parts", Json::array()))
        commands += "    " + part.at("command").get<std::string>() + "\n";
    if (context.contains("resolution"))
        size = fmt::format(", resolution {}x{}", word("/context/resolution/0"),
                           word("/context/resolution/1"));
    if (context.contains("shading")) size += ", shading " + word("/context/shading");
    return fmt::format(
        "{}    {}\n\nDevice {} (driver {}), commit {}, scene {}{}{}; {} frames after {}.\n"
        "Tuning: {}.\n\n",
        commands, word("/command"), word("/context/device/name"), word("/context/device/driver"),
        word("/context/program/commit"), word("/context/scene/name"), size, fields,
        word("/context/frames/measured"), word("/context/frames/warm_up"),
        tuning_text(context.at("tuning")));
}

std::string result_text(const fs::path& csv) {
    try {
        const TextTable texts = parse_csv(read_text(csv));
        const Json document = Json::parse(read_text(context_file(csv)));
        if (!is_bench_table(texts))
            return context_text(document, "") + to_markdown(table_of(texts));
        const std::vector<BenchRow> rows = bench_rows(texts);
        if (rows.empty()) throw Error("no rows");
        return context_text(document, shared_fields(rows)) + to_markdown(bench_summary(rows)) +
               "\n" + bench_legend(rows);
    } catch (const Json::exception& error) {
        throw Error(fmt::format("{}: {}", context_file(csv).string(), error.what()));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", csv.string(), error.what()));
    }
}

}  // namespace

std::string tuning_text(const Json& tuning) {
    std::vector<std::string> parts;
    for (const auto& [name, value] : tuning.items()) parts.push_back(name + " " + value.dump());
    return joined(parts);
}

fs::path context_file(fs::path csv) { return csv.replace_extension(".context.json"); }

std::string results_text(const std::vector<std::string>& csv_files) {
    std::string out;
    for (const std::string& csv : csv_files)
        out += fmt::format("{}## {}\n\n{}", out.empty() ? "" : "\n", fs::path(csv).stem().string(),
                           result_text(csv));
    return out;
}

}  // namespace kilolux
