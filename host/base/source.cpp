// SPDX-License-Identifier: Apache-2.0
#include "host/base/source.h"

#include <algorithm>
#include <cstdlib>

#include "host/base/embedded.h"
#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/read_text.h"

namespace kilolux {
namespace {

std::string read_from_folder(const std::string& folder, std::string_view path) {
    warn("sources are read from KILOLUX_SOURCE_DIR=" + folder);
    const std::string file = folder + "/" + std::string(path);
    return read_text(file);
}

// The path in an `#include "path"` line, or nothing.
std::string_view included_path(std::string_view line) {
    constexpr std::string_view kInclude = "#include \"";
    if (!line.starts_with(kInclude)) return {};
    const std::string_view rest = line.substr(kInclude.size());
    return rest.substr(0, rest.find('"'));
}

bool starts(std::string_view line, std::string_view directive) {
    return line.starts_with(directive);
}

// Whether a text's first directive is that of an include guard, which encloses all of it.
bool is_guarded(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        if (starts(line, "#")) return starts(line, "#ifndef ");
    }
    return false;
}

// Splices files into one text. A file that an #if may leave out is spliced again where it is
// included next; its include guard drops what is there already.
class Splicer {
 public:
    explicit Splicer(bool glsl) : glsl_(glsl) {}

    // `conditional`: within an #if other than an include guard.
    void add(std::string_view path, bool conditional) {
        if (contains(spliced_, path) || contains(open_, path)) return;
        if (!conditional) spliced_.emplace_back(path);
        open_.emplace_back(path);
        add_lines(embedded_text(path), number_of(path), conditional);
        open_.pop_back();
    }
    SplicedSource take() { return std::move(out_); }

 private:
    static bool contains(const std::vector<std::string>& paths, std::string_view path) {
        return std::find(paths.begin(), paths.end(), path) != paths.end();
    }

    std::size_t number_of(std::string_view path) {
        const auto found = std::find(out_.files.begin(), out_.files.end(), path);
        const auto number = static_cast<std::size_t>(found - out_.files.begin());
        if (found == out_.files.end()) out_.files.emplace_back(path);
        return number;
    }

    void add_lines(const std::string& text, std::size_t file, bool conditional) {
        const bool version_first = glsl_ && text.starts_with("#version");
        if (!version_first) add_line_directive(file, 1);
        int depth = is_guarded(text) ? -1 : 0;  // of #if
        std::istringstream lines(text);
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) {
            const std::string_view include = included_path(line);
            if (starts(line, "#if")) ++depth;
            if (starts(line, "#endif")) --depth;
            if (!include.empty()) add(include, conditional || depth > 0);
            if (include.empty()) out_.text += line + "\n";
            if (!include.empty() || (version_first && number == 1))
                add_line_directive(file, number + 1);
        }
    }

    void add_line_directive(std::size_t file, int line) {
        out_.text += "#line " + std::to_string(line) + " ";
        out_.text += glsl_ ? std::to_string(file) : "\"" + out_.files[file] + "\"";
        out_.text += "\n";
    }

    bool glsl_;
    SplicedSource out_;
    std::vector<std::string> spliced_;  // that no #if leaves out
    std::vector<std::string> open_;     // whose lines are being added
};

}  // namespace

std::string embedded_text(std::string_view path) {
    if (const char* folder = std::getenv("KILOLUX_SOURCE_DIR"))
        return read_from_folder(folder, path);
    for (const EmbeddedFile& file : embedded_files()) {
        if (file.path == path) return std::string(file.text);
    }
    throw Error(std::string(path) + ": no such embedded source");
}

std::vector<std::string> embedded_paths(std::string_view prefix) {
    std::vector<std::string> paths;
    for (const EmbeddedFile& file : embedded_files()) {
        if (file.path.starts_with(prefix)) paths.emplace_back(file.path);
    }
    return paths;
}

std::string kernel_path(std::string_view stem) {
    std::string name = "/";
    name.append(stem).append(".cl");
    for (const std::string& path : embedded_paths("kernels/"))
        if (path.ends_with(name)) return path;
    throw Error("kernels" + name + ": no such embedded source");
}

SplicedSource splice_source(std::string_view path, bool glsl) {
    Splicer splicer(glsl);
    splicer.add(path, false);
    return splicer.take();
}

}  // namespace kilolux
