// SPDX-License-Identifier: Apache-2.0
// A fixed count of mutated inputs for each fuzz target, without feedback; libFuzzer continues from
// the same inputs in tests/run --full, and by hand (tests/fuzz/README.md).
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/gltf_builder.h"

namespace kilolux {
namespace {

using Random = std::mt19937;

std::size_t pick(Random& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

const std::vector<std::string>& tokens() {
    static const std::vector<std::string> words = {
        "-1",   "0",    "1e308", "nan",  "inf",  "4294967296", "18446744073709551616",
        "--",   "=",    ",",     ":",    "/",    "#",          "\n",
        "null", "[]",   "{}",    "\"\"", "true", "1e-400",     "\\u0000",
        "%\n",  "auto", "../",   "[[",   "\xff", "data:,",     std::string(300, '['),
    };
    return words;
}

// One small change: a byte, a part removed or doubled, a token, or the rest of another input.
std::string mutated(Random& random, const std::vector<std::string>& corpus) {
    std::string text = corpus[pick(random, corpus.size())];
    for (std::size_t changes = 1 + pick(random, 6); changes > 0; --changes) {
        if (text.empty()) return text;
        const std::size_t at = pick(random, text.size());
        const std::size_t length = 1 + pick(random, std::min<std::size_t>(text.size() - at, 40));
        const std::string& other = corpus[pick(random, corpus.size())];
        switch (pick(random, 6)) {
            case 0:
                text[at] = static_cast<char>(text[at] ^ (1 << pick(random, 8)));
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(at, length));
                break;
            case 3:
                text.insert(at, tokens()[pick(random, tokens().size())]);
                break;
            case 4:
                text.replace(at, length, tokens()[pick(random, tokens().size())]);
                break;
            default:
                text = text.substr(0, at) + other.substr(pick(random, other.size()));
        }
    }
    return text;
}

using Target = bool (*)(FuzzInput);

bool run(Target target, const std::string& text) {
    return target({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// A crash leaves the input that caused it in the file that is printed.
void expect_no_crash(Target target, const std::vector<std::string>& corpus, int count) {
    const TempFolder folder;
    const auto file = folder.path() / "input";
    std::cout << "inputs go to " << file << std::endl;
    for (const std::string& seed : corpus) EXPECT_TRUE(run(target, seed)) << seed;
    Random random(5);
    int obeyed = 0;
    for (int i = 0; i < count; ++i) {
        const std::string input = mutated(random, corpus);
        std::ofstream(file, std::ios::binary) << input;
        obeyed += run(target, input) ? 1 : 0;
    }
    EXPECT_GT(obeyed, 0);
    EXPECT_LT(obeyed, count);
}

TEST(Fuzz, LoadScene) { expect_no_crash(fuzz_load_scene, load_scene_corpus(), 3000); }

TEST(Fuzz, Options) { expect_no_crash(fuzz_options, options_corpus(), 3000); }

TEST(Fuzz, Ies) { expect_no_crash(fuzz_ies, ies_corpus(), 3000); }

}  // namespace
}  // namespace kilolux
