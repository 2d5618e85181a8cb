// SPDX-License-Identifier: Apache-2.0
#include "present/commands/bench/bench_options.h"

#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "host/base/text.h"
#include "present/cli/names.h"
#include "present/cli/option_builder.h"
#include "present/cli/output_options.h"
#include "present/cli/sequence.h"

namespace kilolux {
namespace {

// The values that `parse` makes of the option's name and each part of `text`, each once.
template <typename Parse>
auto parse_list(const std::string& option, std::string_view text, char separator, Parse parse) {
    std::vector<std::invoke_result_t<Parse, const std::string&, std::string_view>> out;
    for (const std::string_view part : split(text, separator)) {
        const auto value = parse(option, part);
        if (std::ranges::find(out, value) == out.end()) out.push_back(value);
    }
    return out;
}

template <typename T>
auto choices_parser(std::vector<std::string> names) {
    return [names = std::move(names)](const std::string& option, const std::string& text) {
        return parse_list(option, text, ',', [&](const std::string& name, std::string_view word) {
            return static_cast<T>(parse_name(name, word, names));
        });
    };
}

std::vector<int> parse_lane_list(const std::string& option, const std::string& text) {
    return parse_list(option, text, ',', parse_lanes);
}

// "1920x1080" means "1920,1080".
std::string with_commas(std::string_view text) {
    std::string out(text);
    std::ranges::replace(out, 'x', ',');
    return out;
}

void visit_sweep(BenchAxes& a, const SettingVisitor& f) {
    using Text = const std::string&;
    OptionBuilder(f, "Sweeps: every combination of these lists is measured")
        .value({"--lights", "N,A:B:STEP,A:B:*F", "5000", "Generated lights", kNeither, "1"},
               a.lights,
               [](Text name, Text text) {
                   return parse_count_sweep(name, text, kLightsRange.min, kLightsRange.max);
               })
        .value(
            {"--renderer", "NAME,...", "deferred", "deferred, forward-plus, forward, deferred-all"},
            a.renderers, choices_parser<RendererKind>(names_of<RendererKind>()))
        .value({"--resolution", "W,H;W,H", "1920,1080", "Sizes", kNeither, "px"}, a.resolutions,
               parse_resolutions)
        .value({"--grid", "X,Y,S;X,Y,S", "16,9,4",
                "Coarse grids: tiles across and down, slices for each doubling of depth", kNeither,
                "1"},
               a.grids, parse_grids)
        .value({"--lanes", "N,...", "auto", "auto, 1, 2, 4, 8, 16", kNeither, "1"}, a.lanes,
               parse_lane_list)
        .value(SettingKind::list,
               {"--gbuffer", "NAME,...", "packed", "packed, full, half, normal-xy, oct-2x4"},
               [&a](Text name, Text text) {
                   a.gbuffers = choices_parser<uint>(gbuffer_choices().names)(name, text);
               },
               {});
}

// The types of pictures and videos: their extensions without the point.
std::vector<std::string> job_types() {
    std::vector<std::string> out = output_extensions();
    for (std::string& type : out) type.erase(0, 1);
    return out;
}

void visit_mode(BenchOptions& o, const SettingVisitor& f) {
    using Text = const std::string&;
    OptionBuilder(f, "What is measured, instead of the frames of a sweep")
        .flag("--quick", o.quick, "A small sweep of lights and grid")
        .flag("--tune", o.tune,
              "Search the fastest work sizes of this device and keep them for all commands")
        .value({"--job", "TYPE,...", "",
                "Pictures a second from the command to files of these types (" +
                    joined(job_types()) + ") in a temporary folder, beside the frames alone"},
               o.jobs,
               [](Text name, Text text) {
                   return parse_list(name, text, ',', [](Text option, std::string_view type) {
                       const std::vector<std::string> known = job_types();
                       return known[parse_name(option, type, known)];
                   });
               })
        .value({"--table", "FILE,...", "",
                "Print the tables of CSV files that a bench wrote, with what made them"},
               o.tables, [](Text, Text text) {
                   const auto files = split(text, ',');
                   return std::vector<std::string>(files.begin(), files.end());
               });
}

}  // namespace

std::vector<std::array<int, 2>> parse_resolutions(const std::string& option,
                                                  const std::string& text) {
    return parse_list(option, text, ';', [](const std::string& name, std::string_view part) {
        const auto v = parse_counts(name, with_commas(part), "W,H", kEdgeRange);
        return std::array{v[0], v[1]};
    });
}

std::vector<std::array<int, 3>> parse_grids(const std::string& option, const std::string& text) {
    return parse_list(option, text, ';', [](const std::string& name, std::string_view part) {
        return parse_grid(name, with_commas(part));
    });
}

void visit_settings(BenchOptions& options, const SettingVisitor& f) {
    std::set<std::string> swept;  // the shared options of these names take one value, here lists
    visit_sweep(options.axes, [&](const Setting& setting) { swept.insert(setting.option()); });
    visit_settings(options.shared, [&](const Setting& setting) {
        if (!swept.contains(setting.option())) f(setting);
    });
    visit_sweep(options.axes, f);
    visit_mode(options, f);
    OptionBuilder(f, "Measuring and output")
        .count({"--warm-up", "N", text_of(BenchFrames{}.warm_up), "Frames before those that count",
                kNeither, "1"},
               options.warm_up, {0, 1'000'000})
        .count({"--frames", "N", text_of(BenchFrames{}.measured),
                fmt::format("Frames that count; runs with --tune; pictures with --job ({} there)",
                            kJobPictures),
                kNeither, "1"},
               options.frames, {1, 1'000'000})
        .choice({"--motion", "", "camera", "What moves from frame to frame"}, options.motion)
        .text({"--output,-o", "DIR", "", "Folder for CSV, JSON and plots"}, options.output)
        .flag("--resume", options.resume,
              "Go on with the CSV in the folder, which the same program, device, tuning, scene and "
              "settings must have written")
        .value({"--shard", "I/N", "0/1", shard_meaning("point of the sweep")}, options.shard,
               parse_shard)
        .flag("--json", options.json, "JSON instead of a table on standard output");
    visit_settings(options.budget, f);
}

void add_bench_options(CLI::App& command, BenchOptions& options) {
    options.shared.compares_renderers = true;
    options.shared.takes_light_layers = true;  // whose cost it measures
    add_options(command, options);
}

}  // namespace kilolux
