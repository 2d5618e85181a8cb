// SPDX-License-Identifier: Apache-2.0
// Runs the real program in a child process.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {

struct ChildResult {
    int code = -1;  // exit code, or -1 when a signal killed it
    int signal = 0;
    std::string out;    // standard output
    std::string err;    // standard error
    long peak_kib = 0;  // resident
};

/// Runs `words` of which the first is the program's path. `meanwhile` gets the process while it
/// runs.
inline ChildResult run_child(std::vector<std::string> words,
                             const std::function<void(pid_t)>& meanwhile = {}) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out").string();
    const std::string err = (folder / "err").string();
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        execv(argv[0], argv.data());
        _exit(127);
    }
    if (meanwhile) meanwhile(child);
    int status = 0;
    struct rusage usage = {};
    wait4(child, &status, 0, &usage);
    ChildResult result;
    result.peak_kib = usage.ru_maxrss;
    if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    result.out = text_of_file(out);
    result.err = text_of_file(err);
    return result;
}

/// Runs the program under test with `arguments`.
inline ChildResult run_kilolux(std::vector<std::string> arguments,
                               const std::function<void(pid_t)>& meanwhile = {}) {
    arguments.insert(arguments.begin(), program_file());
    return run_child(std::move(arguments), meanwhile);
}

}  // namespace kilolux
