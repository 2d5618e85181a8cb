// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>

namespace kilolux {

/// Lets SIGINT, SIGTERM and SIGHUP ask for an orderly end: the first one is noted for
/// check_interrupt(), the second removes the unfinished file and kills. Threads and processes that
/// are started later do not see these signals. Writing past a file-size limit or into a closed pipe
/// becomes an error of write() instead of a signal. Called before other threads are started.
void catch_signals();

/// Whether a signal has asked for the end. What fails from then on is taken to fail because of it.
bool interrupt_requested();

/// Throws Interrupted once a signal has asked for the end.
void check_interrupt();

/// Set once somebody wants long work to end; null: nobody does.
using StopFlag = const std::atomic<bool>*;

/// The flag that signals set.
StopFlag interrupt_flag();

/// Throws Interrupted once the flag is set.
void check_stop(StopFlag stop);

/// Names the file that a killing signal must remove, which exists; an empty path: none. One at a
/// time. The signal removes it only while that name still means the same file.
void set_unfinished_file(const std::filesystem::path& file);

}  // namespace kilolux
