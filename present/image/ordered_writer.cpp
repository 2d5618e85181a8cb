// SPDX-License-Identifier: Apache-2.0
#include "present/image/ordered_writer.h"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>

namespace kilolux {
namespace {

// A picture from add() until it is written.
struct Held {
    OrderedWriter::Code code;
    OrderedWriter::Write write{};
    std::exception_ptr failure{};  // of coding
    bool is_coded = false;         // or has failed

    void make() noexcept {
        try {
            write = code();
        } catch (...) {
            failure = std::current_exception();
        }
        code = nullptr;  // with the picture's pixels
    }
};

}  // namespace

struct OrderedWriter::State {
    explicit State(std::size_t most) : most_held(most) {}

    const std::size_t most_held;
    tbb::task_arena arena;
    tbb::task_group coding;

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::shared_ptr<Held>> held;  // in the order of add()
    std::size_t written = 0;
    bool is_writing = false;     // one thread writes at a time
    bool is_given_up = false;    // nothing more is coded or written
    std::exception_ptr failure;  // of the first picture that failed

    // Writes the coded pictures that are next in order. The lock is open while one is written.
    void write_next(std::unique_lock<std::mutex>& lock) noexcept {
        if (is_writing) return;
        is_writing = true;
        while (!failure && !is_given_up && !held.empty() && held.front()->is_coded) {
            const std::shared_ptr<Held> next = held.front();
            lock.unlock();
            std::exception_ptr error = next->failure;
            try {
                if (!error) next->write();
            } catch (...) {
                error = std::current_exception();
            }
            lock.lock();
            failure = error;
            if (!error) {
                held.pop_front();
                ++written;
            }
            changed.notify_all();
        }
        is_writing = false;
    }

    void code_and_write(Held& picture) noexcept {
        std::unique_lock lock(mutex);
        if (!failure && !is_given_up) {
            lock.unlock();
            picture.make();
            lock.lock();
        }
        picture.is_coded = true;
        write_next(lock);
    }

    // Waits for `is_so` under the lock, or for a failure, which it throws.
    template <typename Test>
    void wait_until(const Test& is_so) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return failure || is_so(); });
        if (failure) std::rethrow_exception(failure);
    }
};

OrderedWriter::OrderedWriter(std::size_t most_held) : state_(new State(most_held)) {}

OrderedWriter::~OrderedWriter() {
    state_->arena.execute([this] { state_->coding.wait(); });
}

void OrderedWriter::add(Code code) {
    State& s = *state_;
    s.wait_until([&] { return s.held.empty() || s.held.size() < s.most_held; });
    const auto picture = std::make_shared<Held>(Held{std::move(code)});
    {
        const std::scoped_lock lock(s.mutex);
        s.held.push_back(picture);
    }
    if (s.most_held == 0) {
        s.code_and_write(*picture);
        return s.wait_until([&] { return s.held.empty(); });
    }
    s.arena.enqueue(s.coding.defer([&s, picture] { s.code_and_write(*picture); }));
}

std::size_t OrderedWriter::written() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->written;
}

bool OrderedWriter::wait_for_next() {
    State& s = *state_;
    const std::size_t before = written();
    s.wait_until([&] { return s.held.empty() || s.written > before; });
    return written() > before;
}

void OrderedWriter::give_up() {
    const std::scoped_lock lock(state_->mutex);
    state_->is_given_up = true;
}

std::size_t coding_threads() {
    return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
}

}  // namespace kilolux
