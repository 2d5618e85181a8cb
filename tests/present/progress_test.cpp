// SPDX-License-Identifier: Apache-2.0
#include "present/cli/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

// Redirects stderr to another descriptor while it lives.
class StderrTo {
 public:
    explicit StderrTo(int descriptor) : saved_(dup(STDERR_FILENO)) {
        fflush(stderr);
        dup2(descriptor, STDERR_FILENO);
    }
    ~StderrTo() {
        fflush(stderr);
        dup2(saved_, STDERR_FILENO);
        close(saved_);
    }
    StderrTo(const StderrTo&) = delete;
    StderrTo& operator=(const StderrTo&) = delete;

 private:
    int saved_;
};

void run_progress(int descriptor, ProgressKind kind, double line_s = 10.0) {
    const StderrTo redirected(descriptor);
    Progress progress("rendering", 2, kind, line_s);
    progress.advance();
    progress.erase();
    progress.advance();
}

std::string seen_on_terminal(ProgressKind kind, double line_s = 10.0) {
    int ours = -1;
    int theirs = -1;
    if (openpty(&ours, &theirs, nullptr, nullptr, nullptr) != 0) return "no terminal";
    run_progress(theirs, kind, line_s);
    close(theirs);  // so that reading ends
    std::string seen;
    std::array<char, 4096> text{};
    for (ssize_t size = 0; (size = read(ours, text.data(), text.size())) > 0;) {
        seen.append(text.data(), static_cast<std::size_t>(size));
    }
    close(ours);
    return seen;
}

TEST(Progress, Lines) {
    EXPECT_EQ(progress_line("rendering", 0, 4, 0.0, 40),
              "rendering 0/4 [                  ]   0 %");
    EXPECT_EQ(progress_line("rendering", 1, 4, 10.0, 43),
              "rendering 1/4 [==        ]  25 %, 30 s left");
    EXPECT_EQ(progress_line("f", 4, 4, 10.0, 30), "f 4/4 [================] 100 %");
    EXPECT_TRUE(contains(progress_line("f", 1, 2, 600.0, 79), "10:00 min left"));
    EXPECT_TRUE(contains(progress_line("f", 1, 101, 180.0, 79), "5:00 h left"));
    EXPECT_TRUE(contains(progress_line("f", 0, 0, 0.0, 79), "100 %"));
    EXPECT_TRUE(progress_line("f", 0, 1, 30.0, 79).ends_with("0 %, 30 s so far"));
}

TEST(Progress, NeverWiderThanTheTerminal) {
    for (int width = 0; width < 120; ++width) {
        for (const std::size_t done : {0u, 1u, 500u, 1000u}) {
            const std::string line = progress_line("rendering frames", done, 1000, 12345.0, width);
            EXPECT_LE(line.size(), static_cast<std::size_t>(width)) << line;
        }
    }
}

TEST(Progress, NothingAtOnceOffATerminal) {
    const TemporaryFolder folder;
    const int file = open((folder / "err").c_str(), O_WRONLY | O_CREAT, 0600);
    run_progress(file, ProgressKind::automatic);
    close(file);
    EXPECT_EQ(text_of_file(folder / "err"), "");
}

TEST(Progress, ATerminalSeesItUnlessQuiet) {
    const std::string seen = seen_on_terminal(ProgressKind::automatic);
    EXPECT_TRUE(contains(seen, "rendering 0/2")) << seen;
    EXPECT_TRUE(contains(seen, "rendering 2/2")) << seen;
    EXPECT_TRUE(seen.ends_with("\r\x1b[K")) << "the bar is not erased: " << seen;
    EXPECT_EQ(seen_on_terminal(ProgressKind::none), "");
}

// Tests run off a terminal.
TEST(Progress, WritesALineNowAndThenOffATerminal) {
    const auto written = [](ProgressKind kind, double line_s) {
        testing::internal::CaptureStderr();
        {
            Progress progress("rendering", 3, kind, line_s);
            progress.advance();
        }
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(written(ProgressKind::automatic, 30.0), "");
    EXPECT_EQ(written(ProgressKind::none, 0.0), "");
    const std::string lines = written(ProgressKind::automatic, 0.0);
    EXPECT_NE(lines.find("rendering 1/3 ["), std::string::npos) << lines;
    EXPECT_EQ(lines.find('\r'), std::string::npos) << lines;
    EXPECT_TRUE(lines.ends_with('\n')) << lines;
}

TEST(Progress, WritesLinesWhileAStepLasts) {
    testing::internal::CaptureStderr();
    {
        const Progress progress("rendering", 1, ProgressKind::automatic, 0.02);
        usleep(500'000);
    }
    const std::string lines = testing::internal::GetCapturedStderr();
    EXPECT_GE(std::ranges::count(lines, '\n'), 2) << lines;
    EXPECT_TRUE(lines.starts_with("rendering 0/1 [")) << lines;
}

TEST(Progress, PlainLinesAlsoOnATerminal) {
    const std::string seen = seen_on_terminal(ProgressKind::plain, 0.0);
    EXPECT_TRUE(contains(seen, "rendering 1/2 [")) << seen;
    EXPECT_EQ(seen.find('\x1b'), std::string::npos) << seen;
}

// The lines that Open Job Description and Tractor look for.
TEST(Progress, FarmsReadTheirLinesOnStandardOutput) {
    EXPECT_EQ(farm_line(ProgressKind::openjd, 0.41567), "openjd_progress: 41.5");
    EXPECT_EQ(farm_line(ProgressKind::openjd, 0.9999), "openjd_progress: 99.9");
    EXPECT_EQ(farm_line(ProgressKind::alf, 0.41999), "ALF_PROGRESS 41%");
    EXPECT_EQ(farm_line(ProgressKind::plain, 0.5), "");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    {
        Progress progress("rendering", 4, ProgressKind::openjd);
        for (int i = 0; i < 4; ++i) progress.advance();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "openjd_progress: 0.0\nopenjd_progress: 25.0\nopenjd_progress: 50.0\n"
              "openjd_progress: 75.0\nopenjd_progress: 100.0\n");
}

TEST(Progress, QuietSilencesWhatIsAutomatic) {
    EXPECT_EQ(progress_kind(ProgressKind::automatic, true), ProgressKind::none);
    EXPECT_EQ(progress_kind(ProgressKind::automatic, false), ProgressKind::automatic);
    EXPECT_EQ(progress_kind(ProgressKind::alf, true), ProgressKind::alf);
    EXPECT_EQ(progress_kind_of_part(ProgressKind::alf), ProgressKind::none);
    EXPECT_EQ(progress_kind_of_part(ProgressKind::plain), ProgressKind::plain);
}

}  // namespace
}  // namespace kilolux
