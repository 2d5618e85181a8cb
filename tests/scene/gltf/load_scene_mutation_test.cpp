// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "host/base/error.h"
#include "host/scene/gltf/load_scene.h"
#include "tests/support/gltf_seeds.h"

namespace kilolux {
namespace {

using nlohmann::json;

constexpr int kMutationsPerSeed = 250;  // of each kind
constexpr std::size_t kMaxMemoryKiB = std::size_t{1} << 20;

using Random = std::mt19937;

std::size_t pick(Random& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

Blob flip_bits(Random& random, const GltfBuilder& seed) {
    Blob glb = seed.glb();
    for (std::size_t flips = 1 + pick(random, 8); flips > 0; --flips) {
        glb[pick(random, glb.size())] ^= static_cast<unsigned char>(1u << pick(random, 8));
    }
    return glb;
}

// Cut short, and in half the cases with a header that says so.
Blob truncate(Random& random, const GltfBuilder& seed) {
    Blob glb = seed.glb();
    glb.resize(pick(random, glb.size()));
    if (glb.size() < 20 || pick(random, 2) == 0) return glb;
    glb[8] = static_cast<unsigned char>(glb.size() & 255u);
    glb[9] = static_cast<unsigned char>(glb.size() >> 8 & 255u);
    return glb;
}

Blob scribble_on_buffer(Random& random, const GltfBuilder& seed) {
    GltfBuilder file = seed;
    const std::size_t begin = pick(random, file.bin.size());
    for (std::size_t i = begin; i < std::min(begin + 16, file.bin.size()); ++i) {
        file.bin[i] = static_cast<unsigned char>(pick(random, 256));
    }
    return file.glb();
}

json odd_value(Random& random) {
    static const std::vector<json> values = {nullptr,
                                             true,
                                             -1,
                                             0,
                                             1,
                                             3,
                                             255,
                                             65536,
                                             2147483647,
                                             2147483648,
                                             4294967295,
                                             -2147483649,
                                             9007199254740992,
                                             18446744073709551615u,
                                             0.5,
                                             -0.0,
                                             1e-320,
                                             1e38,
                                             1e300,
                                             "",
                                             "x",
                                             "VEC3",
                                             "MAT4",
                                             "SCALAR",
                                             "data:,",
                                             "data:image/png;base64,AAAA",
                                             json::array(),
                                             json::object(),
                                             json::array({0}),
                                             json::array({0, 0, 0}),
                                             json::array({1e300, 1e300, 1e300}),
                                             json::array({0, 0, 0, 0}),
                                             {{"index", 0}},
                                             {{"a", {{"b", 1}}}}};
    return values[pick(random, values.size())];
}

// Replaces, removes or doubles values anywhere in the JSON; inner objects and arrays too.
Blob change_json(Random& random, const GltfBuilder& seed) {
    GltfBuilder file = seed;
    if (!file.root.contains("buffers")) file.root["buffers"] = {{{"byteLength", file.bin.size()}}};
    for (std::size_t changes = 1 + pick(random, 3); changes > 0; --changes) {
        const json flat = file.root.flatten();
        auto entry = flat.begin();
        std::advance(entry, pick(random, flat.size()));
        json::json_pointer pointer(entry.key());
        while (!pointer.empty() && pick(random, 4) == 0) pointer.pop_back();
        if (pointer.empty()) continue;
        json& parent = file.root[pointer.parent_pointer()];
        const std::size_t kind = pick(random, 8);
        if (kind == 0 && parent.is_object()) {
            parent.erase(pointer.back());
        } else if (kind == 1 && parent.is_array()) {
            parent.push_back(parent.front());
        } else if (kind == 2) {
            auto other = flat.begin();
            std::advance(other, pick(random, flat.size()));
            file.root[pointer] = other.value();
        } else {
            file.root[pointer] = odd_value(random);
        }
    }
    return file.glb();
}

// Peak of the process's memory since the last reset [KiB].
std::size_t peak_memory_kib() {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line)) {
        if (line.starts_with("VmHWM:")) return std::stoul(line.substr(6));
    }
    return 0;
}

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

using Mutation = Blob (*)(Random&, const GltfBuilder&);

// A crash leaves the file that caused it in the folder that is printed. --gtest_random_seed=N makes
// other mutations than the usual ones.
void expect_loads_or_errors(Mutation mutate, unsigned random_seed) {
    reset_peak_memory();
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "mutated.glb";
    std::cout << "mutated files go to " << file << std::endl;
    Random random(random_seed + 1000u * static_cast<unsigned>(GTEST_FLAG_GET(random_seed)));
    int loaded = 0;
    int refused = 0;
    const std::vector<GltfBuilder> all = gltf_seeds();
    for (std::size_t s = 0; s < all.size(); ++s) {
        for (int m = 0; m < kMutationsPerSeed; ++m) {
            SCOPED_TRACE("seed file " + std::to_string(s) + ", mutation " + std::to_string(m));
            write_file(file, mutate(random, all[s]));
            try {
                ASSERT_EQ(scene_defect(load_scene(file)), "");
                ++loaded;
            } catch (const Error& error) {
                const std::string message = error.what();
                EXPECT_EQ(message.find('\n'), std::string::npos) << message;
                EXPECT_NE(message.find(file.string() + ": "), std::string::npos) << message;
                EXPECT_EQ(message.find("refused by tinygltf"), std::string::npos)
                    << message << ": needs a rule, which names the place";
                ++refused;
            }
        }
    }
    // Both must occur, else the mutations are too weak or too strong.
    EXPECT_GT(refused, 0);
    EXPECT_GT(loaded + refused, 5 * kMutationsPerSeed);
    EXPECT_LT(peak_memory_kib(), kMaxMemoryKiB);
}

TEST(LoadSceneMutation, FlippedBits) { expect_loads_or_errors(flip_bits, 1); }

TEST(LoadSceneMutation, TruncatedFiles) { expect_loads_or_errors(truncate, 2); }

TEST(LoadSceneMutation, ScribbledBuffers) { expect_loads_or_errors(scribble_on_buffer, 3); }

TEST(LoadSceneMutation, ChangedJson) { expect_loads_or_errors(change_json, 4); }

}  // namespace
}  // namespace kilolux
