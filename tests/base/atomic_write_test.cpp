// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/atomic_write.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "host/base/system/interrupt.h"
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

TEST(AtomicWrite, WritesAndReplaces) {
    const TemporaryFolder folder;
    write_atomically(folder / "a", "first");
    EXPECT_EQ(text_of_file(folder / "a"), "first");
    write_atomically(folder / "a", std::string_view());
    EXPECT_EQ(text_of_file(folder / "a"), "");
    const std::string large(5'000'000, 'x');
    write_atomically(folder / "a", large);
    EXPECT_EQ(text_of_file(folder / "a"), large);
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a"}));
}

TEST(AtomicWrite, KeepsPermissionsOfTheOldFileAndAsksTheMaskForNewOnes) {
    const TemporaryFolder folder;
    const mode_t mask = umask(027);
    write_atomically(folder / "new", "x");
    umask(mask);
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms(0640));
    fs::permissions(folder / "new", fs::perms(0604));
    write_atomically(folder / "new", "y");
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms(0604));
}

TEST(AtomicWrite, WritesThroughALink) {
    const TemporaryFolder folder;
    write_text(folder / "target", "old");
    fs::create_symlink("target", folder / "link");
    write_atomically(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(text_of_file(folder / "target"), "new");
    fs::create_symlink("link_of_link", folder / "dangling");
    fs::create_symlink(folder / "new_target", folder / "link_of_link");
    write_atomically(folder / "dangling", "there");
    EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
    EXPECT_TRUE(fs::is_symlink(folder / "link_of_link"));
    EXPECT_EQ(text_of_file(folder / "new_target"), "there");
}

TEST(AtomicWrite, LinksToEachOtherAndLongNamesAreRefusedBeforeWork) {
    const TemporaryFolder folder;
    const fs::path loop = folder / "loop.png", longest = folder / std::string(256, 'a');
    fs::create_symlink("loop.png", loop);
    for (const auto& write : {std::function([&] { check_can_write(loop); }),
                              std::function([&] { write_atomically(loop, "x"); })}) {
        EXPECT_EQ(message_of<Error>(write),
                  loop.string() + ": cannot write: Too many levels of symbolic links");
    }
    EXPECT_TRUE(fs::is_symlink(loop));
    EXPECT_EQ(message_of<Error>([&] { check_can_write(longest); }),
              longest.string() + ": cannot write: File name too long");
    EXPECT_NO_THROW(check_can_write(folder / std::string(255, 'a')));
}

TEST(AtomicWrite, SpecialFilesAreWrittenAndNotReplaced) {
    write_atomically("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(message_of<Error>([] { write_atomically("/dev/full", "x"); }),
              "/dev/full: cannot write: No space left on device");
    EXPECT_NO_THROW(check_can_write("/dev/null"));
}

TEST(AtomicWrite, NoFolderOrAFolderOfThatName) {
    const TemporaryFolder folder;
    const fs::path lost = folder / "no/a.png";
    EXPECT_EQ(message_of<Error>([&] { check_can_write(lost); }),
              lost.string() + ": cannot write: there is no folder " + (folder / "no").string());
    EXPECT_THROW(write_atomically(lost, "x"), Error);
    EXPECT_EQ(message_of<Error>([&] { check_can_write(folder.path()); }),
              folder.path().string() + ": cannot write: Is a directory");
    EXPECT_THROW(write_atomically(folder.path(), "x"), Error);
    EXPECT_TRUE(names_in(folder).empty());
}

TEST(AtomicWrite, FolderWithoutPermission) {
    if (geteuid() == 0) {
        // The superuser may write anywhere, so a child takes another user's identity.
        const TemporaryFolder folder;
        fs::permissions(folder.path(), fs::perms(0755));
        const int status = status_in_child([&] {
            if (setgid(65534) != 0 || setuid(65534) != 0) _exit(50);
            const auto asked = message_of<Error>([&] { check_can_write(folder / "a"); });
            const auto written = message_of<Error>([&] { write_atomically(folder / "a", "x"); });
            const std::string wanted =
                (folder / "a").string() + ": cannot write: Permission denied";
            _exit(asked == wanted && written == wanted ? 0 : 51);
        });
        EXPECT_EQ(WEXITSTATUS(status), 0);
        EXPECT_TRUE(names_in(folder).empty());
        return;
    }
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms(0555));
    EXPECT_THROW(check_can_write(folder / "a"), Error);
    EXPECT_THROW(write_atomically(folder / "a", "x"), Error);
    fs::permissions(folder.path(), fs::perms(0755));
}

TEST(AtomicWrite, ADiskThatFillsUpLeavesTheOldFileAndNothingElse) {
    const TemporaryFolder folder;
    write_text(folder / "a", "old");
    const int status = status_in_child([&] {
        catch_signals();
        const rlimit limit{1000, 1000};
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string message =
            message_of<Error>([&] { write_atomically(folder / "a", std::string(5000, 'x')); });
        _exit(message == (folder / "a").string() + ": cannot write: File too large" ? 0 : 51);
    });
    ASSERT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_EQ(text_of_file(folder / "a"), "old");
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a"}));
}

// Sends the first signal; returns when it has been noted.
void ask_to_end() {
    kill(getpid(), SIGTERM);
    while (ending_signal() == 0) usleep(1000);
}

// Sends the second signal, which kills.
[[noreturn]] void end_by(int number) {
    kill(getpid(), number);
    for (;;) pause();
}

TEST(Interrupt, TheFirstSignalAsksTheSecondKillsAndRemovesUnfinishedFiles) {
    const TemporaryFolder folder;
    for (const char* name : {"part", "beside", "done"}) write_text(folder / name, "half");
    const int status = status_in_child([&] {
        catch_signals();
        check_interrupt();
        for (const char* name : {"part", "beside", "done"}) add_unfinished_file(folder / name);
        forget_unfinished_file(folder / "done");
        ask_to_end();
        bool asked = false;
        try {
            check_interrupt();
        } catch (const Interrupted&) {
            asked = true;
        }
        if (!asked || !fs::exists(folder / "part")) _exit(51);
        end_by(SIGINT);
    });
    ASSERT_TRUE(WIFSIGNALED(status)) << "exit code " << WEXITSTATUS(status);
    EXPECT_EQ(WTERMSIG(status), SIGINT);
    EXPECT_EQ(names_in(folder), std::set<std::string>{"done"});
}

TEST(AtomicWrite, WithoutCommitNothingChanges) {
    const TemporaryFolder folder;
    write_text(folder / "a", "old");
    {
        AtomicFile file(folder / "a");
        file.write("new");
        EXPECT_EQ(names_in(folder).size(), 2u);
    }
    EXPECT_EQ(text_of_file(folder / "a"), "old");
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a"}));
}

TEST(AtomicWrite, OwnerOnlyReplacesLinks) {
    const TemporaryFolder folder;
    write_text(folder / "target", "old");
    fs::create_symlink("target", folder / "link");
    write_atomically(folder / "link", "new", FileAccess::owner_only);
    EXPECT_FALSE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(fs::status(folder / "link").permissions(), fs::perms(0600));
    EXPECT_EQ(text_of_file(folder / "target"), "old");
}

// A temporary name that another process has taken is neither used nor removed.
TEST(AtomicWrite, LeavesFilesOfOthersAlone) {
    const TemporaryFolder folder;
    const int status = status_in_child([&] {
        catch_signals();
        write_text(folder / (".kilolux-" + std::to_string(getpid()) + "-0.part"), "theirs");
        AtomicFile file(folder / "a");
        ask_to_end();
        end_by(SIGTERM);
    });
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
    ASSERT_EQ(names_in(folder).size(), 1u);
    EXPECT_EQ(text_of_file(folder / *names_in(folder).begin()), "theirs");
}

// At the signal the name may mean another file.
TEST(Interrupt, TheSecondSignalRemovesOnlyTheFileThatWasNamed) {
    const TemporaryFolder folder;
    write_text(folder / "part", "half");
    const int status = status_in_child([&] {
        catch_signals();
        add_unfinished_file(folder / "part");
        fs::rename(folder / "part", folder / "whole");
        write_text(folder / "part", "theirs");
        ask_to_end();
        end_by(SIGTERM);
    });
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"part", "whole"}));
}

}  // namespace
}  // namespace kilolux
