// SPDX-License-Identifier: Apache-2.0
// Runs the program in an environment that fails.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/child.h"
#include "tests/support/paths.h"

namespace kilolux {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

inline constexpr const char* kOld = "an earlier output";

// `render` of a small scene to `file`, run by `before`: a program with its options that changes the
// environment, e.g. prlimit.
inline Words render_words(Words before, const fs::path& file, const Words& more = {}) {
    const Words render = {program_file(), "render", "plain", "--lights",   "50",
                          "--resolution", "48,32",  "-o",    file.string()};
    before.insert(before.end(), render.begin(), render.end());
    before.insert(before.end(), more.begin(), more.end());
    return before;
}

inline Words with_environment(const Words& variables) {
    Words words = {"/usr/bin/env"};
    words.insert(words.end(), variables.begin(), variables.end());
    return words;
}

// The environment in which calls of OpenCL fail as `fault` says: see layer/fault_layer.cpp.
inline Words with_fault(const std::string& fault, Words variables = {}) {
    variables.insert(variables.end(),
                     {"OPENCL_LAYERS=" KILOLUX_FAULT_LAYER, "KILOLUX_FAULT=" + fault});
    return with_environment(variables);
}

inline bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

// The last line is the error; warnings of the program or of drivers may stand before it.
inline void expect_failure(const ChildResult& result, std::string_view part) {
    EXPECT_EQ(result.code, 1) << "signal " << result.signal << "\n" << result.err;
    EXPECT_TRUE(has(result.err, part)) << result.err;
    EXPECT_TRUE(has("\n" + result.err, "\nkilolux: ")) << result.err;
}

class Faults : public testing::Test {
 protected:
    Faults() { write_text(picture_, kOld); }

    void expect_untouched() const {
        EXPECT_EQ(names_in(folder_), std::set<std::string>{"a.png"});
        EXPECT_EQ(text_of_file(picture_), kOld);
    }
    void expect_refused(const Words& before, std::string_view part, const Words& more = {}) const {
        SCOPED_TRACE(std::string(part));
        expect_failure(run_child(render_words(before, picture_, more)), part);
        expect_untouched();
    }

    TemporaryFolder folder_;
    TemporaryFolder elsewhere_;
    fs::path picture_ = folder_ / "a.png";
};

}  // namespace kilolux
