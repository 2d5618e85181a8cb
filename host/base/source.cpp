// SPDX-License-Identifier: Apache-2.0
#include "host/base/source.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "host/base/embedded.h"
#include "host/base/error.h"
#include "host/base/log.h"

namespace kilolux {
namespace {

std::string read_from_folder(const std::string& folder, std::string_view path) {
    warn("sources are read from KILOLUX_SOURCE_DIR=" + folder);
    const std::string file = folder + "/" + std::string(path);
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error(file + ": cannot be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// The path in an `#include "path"` line, or nothing.
std::string_view included_path(std::string_view line) {
    constexpr std::string_view kInclude = "#include \"";
    if (!line.starts_with(kInclude)) return {};
    const std::string_view rest = line.substr(kInclude.size());
    return rest.substr(0, rest.find('"'));
}

void append_line_directive(SplicedSource& out, std::size_t file, int line, bool glsl) {
    out.text += "#line " + std::to_string(line) + " ";
    out.text += glsl ? std::to_string(file) : "\"" + out.files[file] + "\"";
    out.text += "\n";
}

void splice(SplicedSource& out, std::string_view path, bool glsl) {
    if (std::find(out.files.begin(), out.files.end(), path) != out.files.end()) return;
    const std::size_t file = out.files.size();
    out.files.emplace_back(path);
    const std::string text = embedded_text(path);
    const bool version_first = glsl && text.starts_with("#version");
    if (!version_first) append_line_directive(out, file, 1, glsl);
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::string_view include = included_path(line);
        if (include.empty()) {
            out.text += line + "\n";
            if (version_first && number == 1) append_line_directive(out, file, 2, glsl);
        } else {
            splice(out, include, glsl);
            append_line_directive(out, file, number + 1, glsl);
        }
    }
}

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
    SplicedSource out;
    splice(out, path, glsl);
    return out;
}

}  // namespace kilolux
