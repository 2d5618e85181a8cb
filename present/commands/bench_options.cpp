// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/base/error.h"
#include "host/base/gbuffer_layout.h"
#include "host/base/text.h"
#include "present/cli/names.h"
#include "present/cli/option_builder.h"
#include "present/commands/bench.h"

namespace kilolux {
namespace {

constexpr std::uint64_t kMostLights = std::uint64_t{1} << 31;

// The largest coarse grid: more clusters than pixels say nothing.
constexpr std::uint64_t kMostTiles = 4096;

// Lists of tuples; "1920x1080" is as good as "1920,1080".
template <std::size_t N>
std::vector<std::array<int, N>> parse_tuples(const std::string& option, const std::string& text,
                                             const std::string& form, const CountRange& range) {
    std::vector<std::array<int, N>> out;
    for (const std::string_view piece : split(text, ';')) {
        std::string part(piece);
        std::replace(part.begin(), part.end(), 'x', ',');
        const auto values = parse_counts(option, part, form, range);
        std::array<int, N> tuple{};
        std::copy(values.begin(), values.end(), tuple.begin());
        if (std::find(out.begin(), out.end(), tuple) == out.end()) out.push_back(tuple);
    }
    return out;
}

template <typename Enum>
std::vector<Enum> parse_enums(const std::string& option, const std::string& text,
                              const std::vector<std::string>& names) {
    std::vector<Enum> out;
    for (const std::string_view name : split(text, ',')) {
        const auto value = static_cast<Enum>(parse_name(option, std::string(name), names));
        if (std::find(out.begin(), out.end(), value) == out.end()) out.push_back(value);
    }
    return out;
}

// Powers of two, 0 for "auto".
std::vector<int> parse_powers(const std::string& option, const std::string& text) {
    std::vector<int> out;
    for (const std::string_view name : split(text, ',')) {
        const std::size_t place =
            parse_name(option, std::string(name), {"auto", "1", "2", "4", "8", "16"});
        const int value = place == 0 ? 0 : 1 << (place - 1);
        if (std::find(out.begin(), out.end(), value) == out.end()) out.push_back(value);
    }
    return out;
}

void add_sweep_options(CLI::App& command, BenchAxes& a) {
    using Text = const std::string&;
    // The shared options of these names take one value; here they take lists.
    for (const char* name :
         {"--lights", "--renderer", "--resolution", "--gbuffer", "--grid", "--lanes"}) {
        command.remove_option(command.get_option(name));
    }
    OptionBuilder(command, "Sweeps: every combination of these lists is measured")
        .value({"--lights", "N,A:B:STEP,A:B:*F", "5000", "Generated lights"},
               [&a](Text name, Text text) {
                   a.lights = parse_count_sweep(name, text, 0, kMostLights);
               })
        .value(
            {"--renderer", "NAME,...", "deferred", "deferred, forward-plus, forward, deferred-all"},
            [&a](Text name, Text text) {
                a.renderers = parse_enums<RendererKind>(name, text, renderer_names());
            })
        .value({"--resolution", "W,H;W,H", "1920,1080", "Sizes in pixels"},
               [&a](Text name, Text text) { a.resolutions = parse_resolutions(name, text); })
        .value({"--grid", "X,Y,S;X,Y,S", "16,9,4",
                "Coarse grids: tiles across and down, slices for each doubling of depth"},
               [&a](Text name, Text text) { a.grids = parse_grids(name, text); })
        .value({"--lanes", "N,...", "auto", "auto, 1, 2, 4, 8, 16"},
               [&a](Text name, Text text) { a.lanes = parse_powers(name, text); })
        .value({"--group-height", "N,...", "auto",
                "Rows of pixels that a work-group shades: auto, 1, 2, 4, 8, 16"},
               [&a](Text name, Text text) { a.group_heights = parse_powers(name, text); })
        .value({"--gbuffer", "NAME,...", "packed", "packed, full, half, normal-xy, oct-2x4"},
               [&a](Text name, Text text) {
                   a.gbuffers = parse_enums<uint>(name, text, gbuffer_names());
               });
}

void add_mode_options(CLI::App& command, BenchOptions& o) {
    OptionBuilder(command, "What is measured, instead of the frames of a sweep")
        .flag("--quick", o.quick, "A small sweep of lights, grid and groups")
        .flag("--culling", o.culling,
              "Light lists for 1000 to a million lights, against brute force")
        .flag("--shade", o.shading,
              "The shading kernel alone, by model and lanes, against the device's limits")
        .flag("--tune", o.tune,
              "Search the fastest work sizes of this device and keep them for all commands")
        .value({"--table", "FILE,...", "",
                "Print the tables of CSV files that a bench wrote, with what made them"},
               [&o](const std::string&, const std::string& text) {
                   for (const std::string_view file : split(text, ',')) o.tables.emplace_back(file);
               });
}

}  // namespace

std::vector<std::array<int, 2>> parse_resolutions(const std::string& option,
                                                  const std::string& text) {
    return parse_tuples<2>(option, text, "W,H", {1, 65536});
}

std::vector<std::array<int, 3>> parse_grids(const std::string& option, const std::string& text) {
    auto grids = parse_tuples<3>(option, text, "X,Y,SLICES_PER_OCTAVE", {1, kMostTiles});
    for (const auto& grid : grids) {
        parse_count(option + ": slices per octave", std::to_string(grid[2]), {1, 64});
    }
    return grids;
}

void add_bench_options(CLI::App& command, BenchOptions& options) {
    using Text = const std::string&;
    add_shared_options(command, options.shared);
    add_sweep_options(command, options.axes);
    add_mode_options(command, options);
    OptionBuilder(command, "Measuring and output")
        .value({"--warm-up", "N", "30", "Frames before those that count"},
               [&options](Text name, Text text) {
                   options.warm_up = static_cast<int>(parse_count(name, text, {0, 1000000}));
               })
        .value({"--frames", "N", "120", "Frames that count; runs with --shade and --tune"},
               [&options](Text name, Text text) {
                   options.frames = static_cast<int>(parse_count(name, text, {1, 1000000}));
               })
        .value({"--output,-o", "DIR", "", "Folder for CSV, JSON and plots"},
               [&options](Text, Text text) { options.output = text; })
        .flag("--resume", options.resume,
              "Go on with the CSV in the folder, which the same program, device, tuning, scene and "
              "settings must have written")
        .flag("--json", options.json, "JSON instead of a table on standard output");
    add_budget_options(command, options.budget);
}

}  // namespace kilolux
