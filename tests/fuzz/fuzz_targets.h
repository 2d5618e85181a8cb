// SPDX-License-Identifier: Apache-2.0
// The fuzz targets: libFuzzer runs them with feedback (libfuzzer/), fuzz_test.cpp a fixed number of
// times.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kilolux {

using FuzzInput = std::span<const std::uint8_t>;

/// Loads the bytes as a scene file: GLB when they begin so, else JSON. An Error must be one line.
/// True if it loads. Aborts where a scene is not fit to be rendered.
bool fuzz_load_scene(FuzzInput input);

/// Parses the bytes: lines are words of a command line of `kilolux render`; after a line "%", the
/// rest is a configuration file. True if they are valid.
bool fuzz_options(FuzzInput input);

/// Reads the bytes as a photometric file, LM-63 or EULUMDAT; an Error must be one line that names
/// the file. True if it is one.
bool fuzz_ies(FuzzInput input);

/// Inputs to start from.
std::vector<std::string> load_scene_corpus();
std::vector<std::string> options_corpus();
std::vector<std::string> ies_corpus();

}  // namespace kilolux
