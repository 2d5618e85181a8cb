// SPDX-License-Identifier: Apache-2.0
#include "tests/window/background.h"

#include <chrono>
#include <stdexcept>
#include <thread>

namespace kilolux {

void wait_for(const std::string& what, const std::function<bool()>& is_so) {
    using Clock = std::chrono::steady_clock;
    const auto end =
        Clock::now() + std::chrono::minutes(4);  // before the test ends by its own limit
    while (!is_so()) {
        if (Clock::now() > end) throw std::runtime_error("four minutes, and not yet: " + what);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
}

std::vector<std::string> with_variables(const std::vector<std::string>& variables,
                                        const std::vector<std::string>& words) {
    std::vector<std::string> out = {"/usr/bin/env"};
    out.insert(out.end(), variables.begin(), variables.end());
    out.insert(out.end(), words.begin(), words.end());
    return out;
}

Background::Background(std::vector<std::string> words) {
    const std::string out = (folder_ / "out").string();
    const std::string err = (folder_ / "err").string();
    int input[2];
    if (pipe2(input, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
        dup2(input[0], STDIN_FILENO);
        dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        execvp(argv[0], argv.data());
        _exit(127);
    }
    close(input[0]);
    input_ = input[1];
    if (pid_ < 0) throw std::runtime_error("no process for " + words[0]);
}

Background::~Background() {
    close(input_);
    if (pid_ < 0) return;
    // A display ends when its input closes; a program that was not awaited is killed.
    kill(pid_, SIGCONT);
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
}

void Background::signal(int number) const { kill(pid_, number); }

bool Background::has_ended() const {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid == pid_;
}

ChildResult Background::result() {
    wait_for("the program ends", [this] { return has_ended(); });
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    ChildResult result;
    if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    result.out = text_of_file(folder_ / "out");
    result.err = text_of_file(folder_ / "err");
    return result;
}

}  // namespace kilolux
