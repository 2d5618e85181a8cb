// SPDX-License-Identifier: Apache-2.0
#include "present/image/prefiltered_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "host/scene/lights/built_in_environments.h"
#include "tests/support/environment_variable.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

bool same(const PrefilteredEnvironment& a, const PrefilteredEnvironment& b) {
    const auto levels = [](const PrefilteredEnvironment& e) {
        std::vector<unsigned> out;
        for (const uint4& level : e.levels) out.insert(out.end(), {level.x, level.y, level.z});
        return out;
    };
    return a.texels == b.texels && a.table == b.table && a.table_size == b.table_size &&
           levels(a) == levels(b);
}

TEST(PrefilteredCache, IsWhatWasMadeOrIsMadeAnew) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const Environment small = painted_environment(
        16, [](const glm::dvec3& d) { return glm::dvec3(1.0 + d.x, 1.0 + d.y, 1.0); });
    const Environment other =
        painted_environment(16, [](const glm::dvec3&) { return glm::dvec3(1.0); });
    const PrefilteredEnvironment made = prefiltered(small);
    const auto file = folder.path() / "kilolux/prefiltered-studio";
    EXPECT_TRUE(same(kept_prefiltered("room.hdr", small), made));
    EXPECT_FALSE(std::filesystem::exists(file)) << "only what is built in is kept";
    EXPECT_TRUE(same(kept_prefiltered("studio", small), made));
    ASSERT_TRUE(std::filesystem::exists(file));
    const std::string text = text_of_file(file);
    EXPECT_TRUE(same(kept_prefiltered("studio", small), made)) << "read back";
    for (const std::size_t at : {std::size_t{3}, text.size() / 2, text.size() - 1}) {
        std::string harmed = text;
        harmed[at] ^= 1;
        write_text(file, harmed);
        EXPECT_TRUE(same(kept_prefiltered("studio", small), made)) << at;
    }
    write_text(file, text.substr(0, text.size() / 2));
    EXPECT_TRUE(same(kept_prefiltered("studio", small), made));
    EXPECT_FALSE(same(kept_prefiltered("studio", other), made)) << "of other light";
}

}  // namespace
}  // namespace kilolux
