// SPDX-License-Identifier: Apache-2.0
#include "present/commands/bench/bench_context.h"

#include <fmt/format.h>
#include <filesystem>
#include <fstream>

#include "host/base/error.h"
#include "host/base/system/read_text.h"
#include "host/base/text.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/plan/scene_plan.h"
#include "present/cli/conditions.h"
#include "present/cli/names.h"
#include "present/cli/stats_json.h"

namespace kilolux {
namespace {

using Json = nlohmann::ordered_json;

// Erases the settings that the rows of a sweep hold themselves.
void erase_swept(Json& settings) {
    for (const auto& [field, text] : fields_of(SweepPoint{})) settings.erase(field);
}

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

std::string command_line() {
    std::ifstream in("/proc/self/cmdline", std::ios::binary);
    std::string word;
    std::getline(in, word, '\0');  // the program's path
    std::string out = std::filesystem::path(word).filename().string();
    while (std::getline(in, word, '\0')) {
        out.append(" ").append(shell_word(word));
    }
    return out;
}

Json tuning_json(const StoredTuning& stored) {
    Json out = {{"lanes", stored.lanes}};
    for (const TuningParameter& parameter : tuning_parameters())
        out[parameter.name] = stored.tuning.*parameter.value;
    return out;
}

Json bench_context(const SharedOptions& shared, const BenchFrames& frames, const Scene& scene,
                   const Camera& camera, const DeviceInfo& device) {
    Json out = conditions_json(shared, scene, camera);
    erase_swept(out["settings"]);
    out["device"] = device_json(device);
    const std::uint64_t lights = scene.lights.size() + shared.settings.lights.count;
    const int shading = make_scene_plan(scene, shared.settings, lights).kernels.shading;
    out["shading"] = kShadingNames[shading];  // that --shading auto is
    out["tuning"] = tuning_json(choose_tuning(device, shared.settings.kernels));
    out["frames"] = {{"warm_up", frames.warm_up},
                     {"measured", frames.measured},
                     {"motion", name_of(frames.motion)}};
    return out;
}

Json result_document(const Json& context, const std::vector<std::string>& points,
                     const Shard& shard) {
    Json out = {{"command", command_line()}, {"context", context}, {"points", points}};
    if (shard.count > 1) out["shard"] = text_of(shard);
    return out;
}

void require_same_context(const std::filesystem::path& file, const Json& document) {
    std::ifstream in(file);
    const Json found = Json::parse(in, nullptr, false);
    if (!in || !found.contains("context"))
        throw Error(fmt::format("{}: missing or damaged; --resume needs it", file.string()));
    std::string difference = first_difference(found["context"], document["context"]);
    if (difference.empty()) {
        const auto shard = [](const Json& of) { return Json{{"shard", of.value("shard", "0/1")}}; };
        difference = first_difference(shard(found), shard(document));
    }
    if (!difference.empty()) {
        throw Error(
            fmt::format("{}: measured under other conditions: {}; choose another folder "
                        "or leave --resume out",
                        file.string(), difference));
    }
}

Json limits_json(const DeviceLimits& limits) {
    Json out = {{"lanes", limits.lanes}, {"effective_lanes", limits.effective_lanes()}};
    for (const LimitField& field : limit_fields()) out[field.name] = limits.*field.value;
    return out;
}

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
