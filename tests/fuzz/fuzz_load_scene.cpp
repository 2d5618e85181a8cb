// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/scene/gltf/load_scene.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/gltf_seeds.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// One file name a process and type, so that millions of inputs leave nothing behind.
fs::path input_file(FuzzInput input) {
    static const TempFolder folder;
    const bool glb = input.size() >= 4 && std::equal(input.begin(), input.begin() + 4, "glTF");
    return folder.path() / (glb ? "input.glb" : "input.gltf");
}

[[noreturn]] void stop(const std::string& what) {
    std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}

}  // namespace

bool fuzz_load_scene(FuzzInput input) {
    set_verbosity(Verbosity::quiet);
    const fs::path file = input_file(input);
    write_file(file, Blob(input.begin(), input.end()));
    try {
        const std::string defect = scene_defect(load_scene(file));
        if (!defect.empty()) stop("loaded, but " + defect);
        return true;
    } catch (const Error& error) {
        const std::string message = error.what();
        if (message.find('\n') != std::string::npos) stop("more than a line: " + message);
        if (message.find(file.filename().string()) == std::string::npos) {
            stop("no file is named: " + message);
        }
        return false;
    }
}

std::vector<std::string> load_scene_corpus() {
    std::vector<std::string> corpus;
    for (const GltfBuilder& seed : gltf_seeds()) {
        for (const bool padded : {true, false}) {
            const Blob glb = seed.glb(padded);
            corpus.emplace_back(glb.begin(), glb.end());
        }
    }
    for (const GltfBuilder& seed : gltf_seeds()) {
        // A view compressed by meshopt needs a GLB's chunk.
        if (!seed.root.contains("buffers")) corpus.push_back(seed.gltf());
    }
    return corpus;
}

}  // namespace kilolux
