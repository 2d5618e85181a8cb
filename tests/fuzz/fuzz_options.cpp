// SPDX-License-Identifier: Apache-2.0
#include <CLI/Error.hpp>
#include <cstdio>
#include <cstdlib>

#include "host/base/error.h"
#include "present/cli/option_builder.h"
#include "present/cli/options.h"
#include "present/cli/output_options.h"
#include "present/config_file.h"
#include "present/program.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

struct Words {
    std::vector<std::string> words;
    std::string config;
    bool has_config = false;
};

Words split(FuzzInput input) {
    Words out;
    std::string rest(input.begin(), input.end());
    while (!rest.empty()) {
        const std::size_t end = rest.find('\n');
        const std::string line = rest.substr(0, end);
        rest.erase(0, end == std::string::npos ? rest.size() : end + 1);
        if (line == "%") {
            out.config = rest;
            out.has_config = true;
            break;
        }
        // A word of a command line ends at a zero byte.
        out.words.push_back(line.substr(0, line.find('\0')));
    }
    return out;
}

void parse(const Words& words) {
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();
    SharedOptions shared;
    OutputOptions output;
    add_options(app, shared);
    add_options(app, output);
    app.parse(std::vector<std::string>(words.words.rbegin(), words.words.rend()));
    refuse_extras(app, app.remaining());
    if (words.has_config) {
        static const TempFolder folder;
        write_file(folder.path() / "config", words.config);
        apply_config_file(app, folder.path() / "config");
    }
    check_output_options(shared, output);
    const RenderSettings& s = shared.settings;
    if (s.width < 1 || s.height < 1 || s.samples < 1 || !(s.bloom >= 0.0f && s.bloom <= 1.0f)) {
        std::fprintf(stderr, "accepted what cannot be rendered\n");
        std::abort();
    }
}

}  // namespace

bool fuzz_options(FuzzInput input) {
    try {
        parse(split(input));
        return true;
    } catch (const Error&) {
        return false;
    } catch (const CLI::ParseError&) {
        return false;
    }
}

std::vector<std::string> options_corpus() {
    return {
        "atrium\n-o\na.png\n--lights\n100\n--resolution\n64,48\n--quiet",
        "town.glb\n--output=b.exr\n--aov\ndepth,normal\n--exr-half\n--renderer=forward-plus",
        "-o\na.mp4\n--frames\n0:9\n--resolution\n64,48",
        "-o\nf.##.png\n--frames\n0:99\n--fps\n24\n--shard\n1/4\n--skip-existing\n--time\n-1.5",
        "-o\na.png\n--camera-position\n1,2,3\n--camera-focal-point\n0,0,0\n--camera-view-up\n0,1,"
        "0\n"
        "--camera-view-angle\n45\n--camera-orthographic",
        "-o\na.hdr\n--light-box\n0,0,0,1,2,3\n--light-radius\nauto\n--light-intensity\n5e-3\n"
        "--light-seed\n18446744073709551615",
        "-o\na.png\n--bloom\n0.5\n--exposure\n-2\n--tonemap\naces\n--samples\n4\n--show\nlights\n"
        "--gbuffer\nhalf\n--shading\npbr\n--ambient\n0\n--grid\n16,9,4\n--lanes\n8",
        "-o\na.png\n--max-memory\n512M\n--reference\nr.exr\n--threshold\n0.1\n--metric\nrmse\n"
        "--stats\n-\n--device\n0\n--verbose",
        "-o\na.png\n%\nlights = 1000\nresolution = [640, 360]\nquiet = true\nscene = \"grid\"\n",
        "-o\na.png\n%\n{\"lights\": 1000, \"resolution\": [640, 360], \"quiet\": true}",
        "-o\na.png\n%\n# comment\nbloom = 0.25\ngrid=\"8,8,2\"\n",
    };
}

}  // namespace kilolux
