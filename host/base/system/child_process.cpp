// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "host/base/error.h"

namespace kilolux {
namespace {

// The child's folder and its three streams.
class SpawnActions {
 public:
    SpawnActions(const std::filesystem::path& folder, int input, int messages, bool keeps_output) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
        if (input < 0) {
            posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
        } else {
            posix_spawn_file_actions_adddup2(&actions_, input, 0);
        }
        if (keeps_output) {
            posix_spawn_file_actions_adddup2(&actions_, messages, 1);
        } else {
            posix_spawn_file_actions_addopen(&actions_, 1, "/dev/null", O_WRONLY, 0);
        }
        posix_spawn_file_actions_adddup2(&actions_, messages, 2);
    }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
    posix_spawn_file_actions_t actions_;
};

}  // namespace

bool has_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path file = std::filesystem::path(folder) / name;
        if (::access(file.c_str(), X_OK) == 0 && !std::filesystem::is_directory(file)) return true;
    }
    return false;
}

ChildProcess::ChildProcess(std::vector<std::string> words, int input,
                           const std::filesystem::path& folder, bool keeps_output)
    : messages_(std::tmpfile(), std::fclose) {
    const auto fail = [&words](int reason) {
        throw Error("cannot run " + words[0] + ": " + std::strerror(reason));
    };
    if (!messages_) fail(errno);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const SpawnActions actions(folder, input, ::fileno(messages_.get()), keeps_output);
    const int failure =
        posix_spawnp(&process_, arguments[0], actions.get(), nullptr, arguments.data(), environ);
    if (failure == 0) return;
    process_ = -1;
    fail(failure);
}

ChildProcess::~ChildProcess() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    succeeded();
}

bool ChildProcess::succeeded() {
    pid_t ended = -1;
    do {
        ended = ::waitpid(process_, &status_, 0);
    } while (ended < 0 && errno == EINTR);
    is_known_ = ended == process_;
    process_ = -1;
    return is_known_ && WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
}

std::string ChildProcess::ending() const {
    if (!is_known_) return "an unknown end: SIGCHLD is ignored, so its status cannot be asked for";
    if (WIFEXITED(status_)) return "exit code " + std::to_string(WEXITSTATUS(status_));
    const int signal = WTERMSIG(status_);
    return "signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
}

std::vector<std::string> ChildProcess::messages() const {
    std::vector<std::string> lines;
    std::string line;
    std::rewind(messages_.get());
    for (int c = std::fgetc(messages_.get()); c != EOF; c = std::fgetc(messages_.get())) {
        if (c != '\n' && c != '\r') {
            line += static_cast<char>(c);
        } else if (!line.empty()) {
            lines.push_back(std::exchange(line, ""));
        }
    }
    if (!line.empty()) lines.push_back(line);
    return lines;
}

}  // namespace kilolux
