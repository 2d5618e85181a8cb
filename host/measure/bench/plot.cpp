// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/plot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "host/measure/bench/plot_script.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// A temporary folder beside the results.
class WorkFolder {
 public:
    explicit WorkFolder(const fs::path& parent) {
        std::string name = (parent / ".kilolux-plot-XXXXXX").string();
        if (!mkdtemp(name.data())) {
            throw Error(fmt::format("plot: cannot write in '{}': {}", parent.string(),
                                    std::strerror(errno)));
        }
        path_ = name;
    }
    ~WorkFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    const fs::path& path() const { return path_; }

 private:
    fs::path path_;
};

std::string first_line(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    // gnuplot first repeats the script's line and marks the place.
    while (std::getline(in, line)) {
        if (line.find("line ") != std::string::npos || line.find("rror") != std::string::npos)
            break;
    }
    return line;
}

// A child process' folder, its empty input and the file for its messages.
class SpawnActions {
 public:
    SpawnActions(const fs::path& folder, const fs::path& messages) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
        posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, 1, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, 2, messages.c_str(),
                                         O_WRONLY | O_CREAT | O_TRUNC, 0600);
    }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
    posix_spawn_file_actions_t actions_;
};

int wait_for(pid_t process) {
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

void run_gnuplot(const fs::path& folder, const std::string& script, const fs::path& stem) {
    const fs::path messages = folder / "messages";
    const SpawnActions actions(fs::absolute(folder), fs::absolute(messages));
    std::string program = "gnuplot", argument = script;
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    pid_t process = 0;
    const int failure =
        posix_spawnp(&process, program.c_str(), actions.get(), nullptr, arguments, environ);
    const std::string what = fmt::format("plot '{}': ", stem.string());
    if (failure == ENOENT) {
        throw Error(what + "gnuplot not found; install the package gnuplot-nox");
    }
    if (failure != 0) {
        throw Error(fmt::format("{}cannot run gnuplot: {}", what, std::strerror(failure)));
    }
    const int status = wait_for(process);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    throw Error(fmt::format("{}gnuplot failed: {}", what, first_line(messages)));
}

void move_into_place(const fs::path& from, const fs::path& to) {
    std::error_code failure;
    fs::rename(from, to, failure);
    if (!failure) return;
    throw Error(fmt::format("plot: cannot write '{}': {}", to.string(), failure.message()));
}

fs::path with_extension(const fs::path& stem, const char* extension) {
    fs::path out = stem;
    out += extension;
    return out;
}

}  // namespace

std::vector<PlotPoint>& series_of(Plot& plot, const std::string& name, PlotStyle style) {
    auto found = std::ranges::find(plot.series, name, &PlotSeries::name);
    if (found == plot.series.end()) found = plot.series.insert(found, {name, {}, style});
    return found->points;
}

PlotFiles write_plot(const Plot& plot, const fs::path& stem) {
    const Plot ready = drawable(plot);
    if (ready.series.empty()) {
        throw Error(fmt::format("plot '{}': no point to draw in {} series", stem.string(),
                                plot.series.size()));
    }
    const fs::path parent = stem.has_parent_path() ? stem.parent_path() : fs::path(".");
    const std::string name = stem.filename().string();
    const WorkFolder work(parent);
    write_atomically(work.path() / (name + ".dat"), plot_data(ready));
    write_atomically(work.path() / (name + ".gnuplot"), plot_script(ready, name));
    run_gnuplot(work.path(), name + ".gnuplot", stem);
    PlotFiles out{.script = with_extension(stem, ".gnuplot"),
                  .data = with_extension(stem, ".dat"),
                  .png = with_extension(stem, ".png"),
                  .svg = with_extension(stem, ".svg")};
    for (const fs::path& file : {out.script, out.data, out.png, out.svg}) {
        move_into_place(work.path() / file.filename(), file);
    }
    return out;
}

}  // namespace kilolux
