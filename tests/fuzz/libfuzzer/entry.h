// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>

#include "tests/fuzz/fuzz_targets.h"

namespace kilolux {

/// Puts the inputs to start from into the first folder that the command line names, if that is
/// empty.
inline int write_corpus(int argc, char** argv, const std::vector<std::string>& corpus) {
    for (int i = 1; i < argc; ++i) {
        const std::filesystem::path folder = argv[i];
        if (argv[i][0] == '-' || !std::filesystem::is_directory(folder)) continue;
        if (!std::filesystem::is_empty(folder)) return 0;
        for (std::size_t n = 0; n < corpus.size(); ++n) {
            std::ofstream(folder / ("seed-" + std::to_string(n)), std::ios::binary) << corpus[n];
        }
        return 0;
    }
    return 0;
}

}  // namespace kilolux
