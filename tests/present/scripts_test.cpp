// SPDX-License-Identifier: Apache-2.0
// The project's own scripts.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/child.h"
#include "tests/support/messages.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

const fs::path kTables = fs::path(source_root()) / "host/measure/results/make_tables";

TEST(Scripts, RefuseOptionsThatTheyDoNotKnow) {
    for (const char* script :
         {"host/quickstart", "host/install_packages", "host/measure/results/make_tables",
          "host/certify/devices/make_table", "host/scene/gallery/make",
          "present/lesson/make_pictures", "tests/run", "tests/short", ".ci/run"}) {
        for (const char* option : {"--help", "--no-such-option"}) {
            const ChildResult run =
                run_child({(fs::path(source_root()) / script).string(), option});
            EXPECT_EQ(run.code, 2) << script << " " << option;
            EXPECT_TRUE(run.out.empty() && run.err.starts_with("usage: ")) << script << run.err;
            EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << script << ": " << run.err;
        }
    }
}

TEST(Scripts, ATableStaysWhereItCannotBeMade) {
    const TemporaryFolder folder;
    const fs::path table = folder / "atrium_cpu.md";
    write_text(table, "kept");
    for (const char* program : {"--help", "/no/such/program", "/bin/false"}) {
        const ChildResult run = run_child({kTables.string(), program, folder.path().string()});
        EXPECT_NE(run.code, 0) << program;
        EXPECT_EQ(text_of_file(table), "kept") << program;
    }
}

TEST(Scripts, TablesOfProgramsWithLocalChangesAreRefused) {
    const TemporaryFolder folder;
    const fs::path script = folder / "make_tables";
    fs::copy_file(kTables, script);
    fs::create_directory(folder / "mine");
    write_text(folder / "mine/bench.csv", "");
    write_text(folder / "mine/bench.context.json", "{\"commit\": \"0123456-dirty\"}");
    const ChildResult run = run_child({script.string(), "/bin/echo"});
    EXPECT_EQ(run.code, 1);
    EXPECT_TRUE(contains(run.err, "mine: measured by a program with local changes")) << run.err;
    EXPECT_FALSE(fs::exists(folder / "mine.md"));
    write_text(folder / "mine/bench.context.json", "{\"commit\": \"0123456\"}");
    EXPECT_EQ(run_child({script.string(), "/bin/echo"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "mine.md"));
}

}  // namespace
}  // namespace kilolux
