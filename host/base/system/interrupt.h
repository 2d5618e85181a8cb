// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace kilolux {

/// Lets SIGINT, SIGTERM and SIGHUP ask for an orderly end: the first one is noted for
/// check_interrupt(), the second removes the unfinished file and kills. Threads and processes that
/// are started later do not see these signals. Writing past a file-size limit or into a closed pipe
/// becomes an error of write() instead of a signal. Called before other threads are started.
void catch_signals();

/// The signal that has asked for the end; 0: none. Later failures are taken for its effect.
int ending_signal();

/// Called between the parts of long work. Throws Interrupted once a signal has asked for the end,
/// and asks this thread's WorkWatch.
void check_interrupt();

/// The same, with the share of the work that is done, 0 to 1.
void check_interrupt_at(double share);

/// Watches the long work of its thread while it lives: check_interrupt() calls it, and what it
/// throws, as Interrupted, ends the work. The share is below 0 where it is unknown.
class WorkWatch {
 public:
    using Call = std::function<void(double share)>;
    explicit WorkWatch(Call call);
    ~WorkWatch();
    WorkWatch(const WorkWatch&) = delete;
    WorkWatch& operator=(const WorkWatch&) = delete;

 private:
    friend void check_interrupt_at(double share);
    friend double part_seconds();
    Call call_;
    WorkWatch* outer_;
};

/// How long a part of long work may take between two calls of check_interrupt() [s]: short where
/// this thread's work is watched, longer in a program that called catch_signals(), infinite
/// elsewhere, where nothing would end the work.
double part_seconds();

/// Names an existing file that a killing signal must remove, as long as the name means the same
/// file.
void add_unfinished_file(const std::filesystem::path& file);

/// The file is finished, or removed.
void forget_unfinished_file(const std::filesystem::path& file);

}  // namespace kilolux
