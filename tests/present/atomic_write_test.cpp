// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_write.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/interrupt.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// Runs `act` in a child process and returns its exit status.
template <typename Act>
int status_in_child(Act act) {
    const pid_t child = fork();
    if (child == 0) {
        act();
        _exit(99);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
}

TEST(WholeFile, WritesAndReplaces) {
    const TemporaryFolder folder;
    write_whole_file(folder / "a", "first");
    EXPECT_EQ(text_of_file(folder / "a"), "first");
    write_whole_file(folder / "a", std::string_view());
    EXPECT_EQ(text_of_file(folder / "a"), "");
    const std::string large(5'000'000, 'x');
    write_whole_file(folder / "a", large);
    EXPECT_EQ(text_of_file(folder / "a"), large);
    EXPECT_EQ(folder.names(), (std::set<std::string>{"a"}));
}

TEST(WholeFile, KeepsPermissionsOfTheOldFileAndAsksTheMaskForNewOnes) {
    const TemporaryFolder folder;
    const mode_t mask = umask(027);
    write_whole_file(folder / "new", "x");
    umask(mask);
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms(0640));
    fs::permissions(folder / "new", fs::perms(0604));
    write_whole_file(folder / "new", "y");
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms(0604));
}

TEST(WholeFile, WritesThroughALink) {
    const TemporaryFolder folder;
    write_text(folder / "target", "old");
    fs::create_symlink("target", folder / "link");
    write_whole_file(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(text_of_file(folder / "target"), "new");
}

TEST(WholeFile, SpecialFilesAreWrittenAndNotReplaced) {
    write_whole_file("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(message_of<Error>([] { write_whole_file("/dev/full", "x"); }),
              "/dev/full: cannot write: No space left on device");
    EXPECT_NO_THROW(check_can_write("/dev/null"));
}

TEST(WholeFile, NoFolderOrAFolderOfThatName) {
    const TemporaryFolder folder;
    const fs::path lost = folder / "no/a.png";
    EXPECT_EQ(message_of<Error>([&] { check_can_write(lost); }),
              lost.string() + ": cannot write: there is no folder " + (folder / "no").string());
    EXPECT_THROW(write_whole_file(lost, "x"), Error);
    EXPECT_EQ(message_of<Error>([&] { check_can_write(folder.path()); }),
              folder.path().string() + ": cannot write: Is a directory");
    EXPECT_THROW(write_whole_file(folder.path(), "x"), Error);
    EXPECT_TRUE(folder.names().empty());
}

TEST(WholeFile, FolderWithoutPermission) {
    if (geteuid() == 0) {
        // The superuser may write anywhere: become somebody else in a child.
        const TemporaryFolder folder;
        fs::permissions(folder.path(), fs::perms(0755));
        const int status = status_in_child([&] {
            if (setgid(65534) != 0 || setuid(65534) != 0) _exit(50);
            const auto asked = message_of<Error>([&] { check_can_write(folder / "a"); });
            const auto written = message_of<Error>([&] { write_whole_file(folder / "a", "x"); });
            const std::string wanted =
                (folder / "a").string() + ": cannot write: Permission denied";
            _exit(asked == wanted && written == wanted ? 0 : 51);
        });
        EXPECT_EQ(WEXITSTATUS(status), 0);
        EXPECT_TRUE(folder.names().empty());
        return;
    }
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms(0555));
    EXPECT_THROW(check_can_write(folder / "a"), Error);
    EXPECT_THROW(write_whole_file(folder / "a", "x"), Error);
    fs::permissions(folder.path(), fs::perms(0755));
}

TEST(WholeFile, ADiskThatFillsUpLeavesTheOldFileAndNothingElse) {
    const TemporaryFolder folder;
    write_text(folder / "a", "old");
    const int status = status_in_child([&] {
        catch_signals();
        const rlimit limit{1000, 1000};
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string message =
            message_of<Error>([&] { write_whole_file(folder / "a", std::string(5000, 'x')); });
        _exit(message == (folder / "a").string() + ": cannot write: File too large" ? 0 : 51);
    });
    ASSERT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_EQ(text_of_file(folder / "a"), "old");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"a"}));
}

TEST(Interrupt, TheFirstSignalAsksTheSecondKillsAndRemovesTheUnfinishedFile) {
    const TemporaryFolder folder;
    write_text(folder / "part", "half");
    const int status = status_in_child([&] {
        catch_signals();
        check_interrupt();
        set_unfinished_file(folder / "part");
        raise(SIGTERM);
        bool asked = false;
        try {
            check_interrupt();
        } catch (const Interrupted&) {
            asked = true;
        }
        if (!asked || !fs::exists(folder / "part")) _exit(51);
        raise(SIGINT);
    });
    ASSERT_TRUE(WIFSIGNALED(status)) << "exit code " << WEXITSTATUS(status);
    EXPECT_EQ(WTERMSIG(status), SIGINT);
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace kilolux
