// SPDX-License-Identifier: Apache-2.0
#include "host/base/log.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>

namespace kilolux {
namespace {

std::atomic<Verbosity>& verbosity() {
    static std::atomic<Verbosity> value{Verbosity::normal};
    return value;
}

std::atomic<bool>& shows_waits() {
    static std::atomic<bool> value{false};
    return value;
}

void print(const char* prefix, std::string_view message) {
    std::fflush(stdout);  // what came before it, where both are one file
    std::fprintf(stderr, "%s%.*s\n", prefix, static_cast<int>(message.size()), message.data());
}

}  // namespace

void set_verbosity(Verbosity value) { verbosity() = value; }

void warn(std::string_view message) {
    static std::mutex mutex;
    static std::set<std::string, std::less<>> seen;
    const std::scoped_lock lock(mutex);
    if (seen.emplace(message).second) print("kilolux: warning: ", message);
}

void note(std::string_view message) {
    if (verbosity() != Verbosity::quiet) print("", message);
}

void note_wait(std::string_view message) {
    if (shows_waits() || ::isatty(STDERR_FILENO) == 1) note(message);
}

void show_waits() { shows_waits() = true; }

void detail(std::string_view message) {
    if (verbosity() == Verbosity::verbose) print("", message);
}

}  // namespace kilolux
