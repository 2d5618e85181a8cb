// SPDX-License-Identifier: Apache-2.0
#include "host/base/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cstring>

#include "host/base/error.h"

namespace kilolux {
namespace {

// What a signal handler may touch: lock-free flags and a path that is complete whenever it is set.
struct SignalState {
    volatile sig_atomic_t requested = 0;
    volatile sig_atomic_t has_file = 0;
    std::array<char, PATH_MAX> file{};
};

SignalState& state() {
    static SignalState value;
    return value;
}

extern "C" void kilolux_on_signal(int number) {
    SignalState& signals = state();
    if (signals.requested == 0) {
        signals.requested = 1;
        return;
    }
    if (signals.has_file != 0) unlink(signals.file.data());
    signal(number, SIG_DFL);
    raise(number);
}

}  // namespace

void catch_signals() {
    state().requested = 0;  // and makes the state before a handler needs it
    struct sigaction action = {};
    action.sa_handler = kilolux_on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
    for (const int number : {SIGXFSZ, SIGPIPE}) signal(number, SIG_IGN);
}

bool interrupt_requested() { return state().requested != 0; }

void check_interrupt() {
    if (interrupt_requested()) throw Interrupted();
}

void set_unfinished_file(const std::filesystem::path& file) {
    SignalState& signals = state();
    signals.has_file = 0;
    const std::string name = file.string();
    if (name.empty() || name.size() >= signals.file.size()) return;
    std::memcpy(signals.file.data(), name.c_str(), name.size() + 1);
    signals.has_file = 1;
}

}  // namespace kilolux
