// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace kilolux {

/// Whether a folder of PATH holds a program of that name.
bool has_program(const std::string& name);

/// Another program that runs beside this one. No shell is started.
class ChildProcess {
 public:
    /// Starts words[0], looked for in PATH, with the words after it as its arguments, in `folder`.
    /// It reads the descriptor `input`, or nothing for -1; its messages are kept, what it prints
    /// only with `keeps_output`. Throws Error with the system's reason.
    explicit ChildProcess(std::vector<std::string> words, int input = -1,
                          const std::filesystem::path& folder = ".", bool keeps_output = false);
    /// Kills it if nobody has waited for it.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits for its end; whether it ended with exit code 0.
    bool succeeded();

    /// How it ended: "exit code 3", "signal 11 (Segmentation fault)".
    std::string ending() const;

    /// The lines that it wrote to standard error, and what else is kept, without empty ones. After
    /// its end.
    std::vector<std::string> messages() const;

 private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages_;
    pid_t process_ = -1;    // -1: it has ended
    int status_ = 0;        // as waitpid() gives it
    bool is_known_ = true;  // false: there was none to wait for
};

}  // namespace kilolux
