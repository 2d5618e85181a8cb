// SPDX-License-Identifier: Apache-2.0
#include "host/base/interrupt.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>

#include "host/base/error.h"

namespace kilolux {
namespace {

// What a signal handler may touch, which may run in any thread: lock-free flags, and a file whose
// name and identity are complete whenever `has_file` is set.
struct SignalState {
    std::atomic<bool> requested = false;
    std::atomic<bool> has_file = false;
    std::array<char, PATH_MAX> file{};
    dev_t device = 0;
    ino_t inode = 0;
};
static_assert(std::atomic<bool>::is_always_lock_free);

SignalState& state() {
    static SignalState value;
    return value;
}

bool is_same_file(const SignalState& signals) {
    struct stat now = {};
    return lstat(signals.file.data(), &now) == 0 && now.st_dev == signals.device &&
           now.st_ino == signals.inode;
}

extern "C" void kilolux_on_signal(int number) {
    SignalState& signals = state();
    if (!signals.requested.exchange(true)) return;
    if (signals.has_file && is_same_file(signals)) unlink(signals.file.data());
    signal(number, SIG_DFL);
    raise(number);
}

}  // namespace

void catch_signals() {
    state().requested = false;  // also constructs the state, which a handler must not do
    struct sigaction action = {};
    action.sa_handler = kilolux_on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
    for (const int number : {SIGXFSZ, SIGPIPE}) signal(number, SIG_IGN);
}

bool interrupt_requested() { return state().requested; }

void check_interrupt() {
    if (interrupt_requested()) throw Interrupted();
}

void set_unfinished_file(const std::filesystem::path& file) {
    SignalState& signals = state();
    signals.has_file = false;
    const std::string name = file.string();
    struct stat status = {};
    if (name.empty() || name.size() >= signals.file.size() || lstat(name.c_str(), &status) != 0) {
        return;
    }
    std::memcpy(signals.file.data(), name.c_str(), name.size() + 1);
    signals.device = status.st_dev;
    signals.inode = status.st_ino;
    signals.has_file = true;
}

}  // namespace kilolux
