// SPDX-License-Identifier: Apache-2.0
#include "present/image/prefiltered_cache.h"

#include <gtest/gtest.h>

#include <chrono>

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

Environment painted(double red) {
    return painted_environment(
        16, [&](const glm::dvec3& d) { return glm::dvec3(red + d.x, 1.0 + d.y, 1.0); });
}

PrefilteredEnvironment kept(const Environment& environment) {
    return kept_prefiltered(environment, "a commit");
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        out.push_back(entry.path());
    }
    return out;
}

TEST(PrefilteredCache, IsWhatWasMadeOrIsMadeAnew) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    const Environment small = painted(1.0), other = painted(2.0);
    const PrefilteredEnvironment made = prefiltered(small);
    EXPECT_TRUE(same(kept(small), made));
    const auto files = files_in(folder / "kilolux");
    ASSERT_EQ(files.size(), 1u);
    const std::filesystem::path& file = files.front();
    const std::string text = text_of_file(file);
    EXPECT_TRUE(same(kept(small), made)) << "read back";
    for (const std::size_t at : {std::size_t{3}, text.size() / 2, text.size() - 1}) {
        std::string harmed = text;
        harmed[at] ^= 1;
        write_text(file, harmed);
        EXPECT_TRUE(same(kept(small), made)) << at;
        EXPECT_EQ(text_of_file(file), text) << "written anew";
    }
    // The first line says what is kept: with the rest of another file, that is what is read.
    kept(other);
    const auto both = files_in(folder / "kilolux");
    ASSERT_EQ(both.size(), 2u);
    const std::string theirs = text_of_file(both[both[0] == file ? 1 : 0]);
    const auto first_line = [](const std::string& all) { return all.substr(0, all.find('\n')); };
    write_text(file, first_line(text) + theirs.substr(first_line(theirs).size()));
    EXPECT_TRUE(same(kept(small), prefiltered(other))) << "read, not made";
    write_text(file, text.substr(0, text.size() / 2));
    EXPECT_TRUE(same(kept(small), made));
    EXPECT_FALSE(same(kept(other), made)) << "of other light";
    EXPECT_EQ(files_in(folder / "kilolux").size(), 2u);
    // Another commit may prefilter otherwise.
    write_text(file, first_line(text) + theirs.substr(first_line(theirs).size()));
    EXPECT_TRUE(same(kept_prefiltered(small, "another"), made));
    EXPECT_EQ(files_in(folder / "kilolux").size(), 3u);
}

TEST(PrefilteredCache, KeepsTheLastEight) {
    const TemporaryFolder folder;
    const EnvironmentVariable cache("XDG_CACHE_HOME", folder.path().string());
    kept(painted(1.0));
    const std::filesystem::path first = files_in(folder / "kilolux").front();
    for (int i = 2; i <= 8; ++i) kept(painted(i));
    EXPECT_EQ(files_in(folder / "kilolux").size(), 8u);
    std::filesystem::last_write_time(
        first, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
    kept(painted(9.0));
    EXPECT_EQ(files_in(folder / "kilolux").size(), 8u);
    EXPECT_FALSE(std::filesystem::exists(first)) << "the oldest";
}

TEST(PrefilteredCache, AFolderThatCannotBeUsedIsNoError) {
    const EnvironmentVariable cache("XDG_CACHE_HOME", "/dev/null");
    const Environment small = painted(1.0);
    EXPECT_TRUE(same(kept(small), prefiltered(small)));
}

}  // namespace
}  // namespace kilolux
