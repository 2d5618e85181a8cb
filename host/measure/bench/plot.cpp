// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/child_process.h"
#include "host/base/system/temporary_folder.h"
#include "host/measure/bench/plot_script.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// gnuplot first repeats the script's line and marks the place.
std::string reason_of(const std::vector<std::string>& messages) {
    for (const std::string& line : messages) {
        if (line.find("line ") != std::string::npos || line.find("rror") != std::string::npos) {
            return line;
        }
    }
    return messages.empty() ? "it says nothing" : messages.back();
}

void run_gnuplot(const fs::path& folder, const std::string& script, const fs::path& stem) {
    const std::string what = fmt::format("plot '{}': ", stem.string());
    ChildProcess gnuplot({"gnuplot", script}, -1, folder);
    if (!gnuplot.succeeded()) {
        throw Error(what + "gnuplot failed: " + reason_of(gnuplot.messages()));
    }
}

void move_into_place(const fs::path& from, const fs::path& to) {
    std::error_code failure;
    fs::rename(from, to, failure);
    if (!failure) return;
    throw Error(fmt::format("plot: cannot write '{}': {}", to.string(), failure.message()));
}

}  // namespace

bool can_plot() {
    if (has_program("gnuplot")) return true;
    warn("no plots: gnuplot not found; install the package gnuplot-nox");
    return false;
}

std::vector<PlotPoint>& series_of(Plot& plot, const std::string& name, PlotStyle style) {
    auto found = std::ranges::find(plot.series, name, &PlotSeries::name);
    if (found == plot.series.end()) found = plot.series.insert(found, {name, {}, style});
    return found->points;
}

void write_plot(const Plot& plot, const fs::path& stem) {
    const Plot ready = drawable(plot);
    if (ready.series.empty()) {
        throw Error(fmt::format("plot '{}': no point to draw in {} series", stem.string(),
                                plot.series.size()));
    }
    const fs::path parent = stem.has_parent_path() ? stem.parent_path() : fs::path(".");
    const std::string name = stem.filename().string();
    const TemporaryFolder work(parent);
    write_atomically(work.path() / (name + ".dat"), plot_data(ready));
    write_atomically(work.path() / (name + ".gnuplot"), plot_script(ready, name));
    run_gnuplot(work.path(), name + ".gnuplot", stem);
    for (const char* extension : {".gnuplot", ".dat", ".png", ".svg"}) {
        move_into_place(work.path() / (name + extension), parent / (name + extension));
    }
}

void write_plots(const std::vector<NamedPlot>& plots, const fs::path& folder) {
    for (const NamedPlot& plot : plots) write_plot(plot.plot, folder / plot.stem);
}

}  // namespace kilolux
