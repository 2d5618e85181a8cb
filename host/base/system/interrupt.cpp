// SPDX-License-Identifier: Apache-2.0
#include "host/base/system/interrupt.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/error.h"

namespace kilolux {
namespace {

struct UnfinishedFile {
    std::string name;
    dev_t device = 0;
    ino_t inode = 0;
};

struct SignalState {
    std::atomic<int> signal = 0;  // that asked for the end
    std::atomic<bool> catches = false;
    std::mutex mutex;  // guards `unfinished`
    std::vector<UnfinishedFile> unfinished;
};

thread_local WorkWatch* watch_of_thread = nullptr;

// Never destroyed: the thread that takes signals runs until the process ends.
SignalState& state() {
    static SignalState& value = *new SignalState;
    return value;
}

sigset_t ending_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, number);
    return signals;
}

void remove_unfinished_files() {
    SignalState& signals = state();
    const std::lock_guard lock(signals.mutex);
    for (const UnfinishedFile& file : signals.unfinished) {
        struct stat now = {};
        if (lstat(file.name.c_str(), &now) == 0 && now.st_dev == file.device &&
            now.st_ino == file.inode) {
            unlink(file.name.c_str());
        }
    }
}

void take_signals(const sigset_t& signals) {
    int number = 0;
    sigwait(&signals, &number);
    state().signal = number;
    sigwait(&signals, &number);
    remove_unfinished_files();
    signal(number, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    raise(number);
}

}  // namespace

// Blocks the signals in every thread and lets one thread wait for them. A handler would not do:
// LLVM, in the OpenCL compiler, replaces it by its own, which removes the files that are being
// compiled, and the compiler then reports that they are missing.
void catch_signals() {
    state().signal = 0;
    state().catches = true;
    for (const int number : {SIGXFSZ, SIGPIPE}) signal(number, SIG_IGN);
    signal(SIGCHLD,
           SIG_DFL);  // ignored, as a parent may leave it, children could not be waited for
    const sigset_t signals = ending_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread(take_signals, signals).detach();
}

int ending_signal() { return state().signal; }

void check_interrupt() { check_interrupt_at(-1.0); }

void check_interrupt_at(double share) {
    if (ending_signal() != 0) throw Interrupted();
    if (watch_of_thread != nullptr) watch_of_thread->call_(share);
}

WorkWatch::WorkWatch(Call call)
    : call_(std::move(call)), outer_(std::exchange(watch_of_thread, this)) {}
WorkWatch::~WorkWatch() { watch_of_thread = outer_; }

double part_seconds() {
    constexpr double kWatched = 0.1, kCaught = 1.5;
    if (watch_of_thread != nullptr) return kWatched;
    return state().catches ? kCaught : std::numeric_limits<double>::infinity();
}

void add_unfinished_file(const std::filesystem::path& file) {
    struct stat status = {};
    if (lstat(file.c_str(), &status) != 0) return;
    SignalState& signals = state();
    const std::lock_guard lock(signals.mutex);
    signals.unfinished.push_back({file.string(), status.st_dev, status.st_ino});
}

void forget_unfinished_file(const std::filesystem::path& file) {
    SignalState& signals = state();
    const std::lock_guard lock(signals.mutex);
    std::erase_if(signals.unfinished,
                  [&](const UnfinishedFile& one) { return one.name == file.string(); });
}

}  // namespace kilolux
