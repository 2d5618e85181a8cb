// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/child.h"

namespace kilolux {

/// Calls `is_so` until it is true; throws std::runtime_error that names `what` after five minutes.
void wait_for(const std::string& what, const std::function<bool()>& is_so);

/// "env" with these variables ("NAME=value") before `words`.
std::vector<std::string> with_variables(const std::vector<std::string>& variables,
                                        const std::vector<std::string>& words);

/// A program that runs beside the test. The destructor closes its standard input.
class Background {
 public:
    /// The first word is found in PATH. Throws std::runtime_error when it cannot be started.
    explicit Background(std::vector<std::string> words);
    /// Closes its input and ends it.
    ~Background();
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    void signal(int number) const;
    bool has_ended() const;
    /// What it has written to its standard output so far.
    std::string out() const { return text_of_file(folder_ / "out"); }
    /// Waits until it ends by itself; throws std::runtime_error after five minutes.
    ChildResult result();

 private:
    TemporaryFolder folder_;
    pid_t pid_ = -1;
    int input_ = -1;
};

}  // namespace kilolux
