// SPDX-License-Identifier: Apache-2.0
#include "present/image/ordered_writer.h"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>

namespace kilolux {

struct OrderedWriter::Pictures {
    explicit Pictures(std::size_t count) : most(count) {}

    const std::size_t most;
    tbb::task_arena arena;
    tbb::task_group coding;

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::size_t added = 0, written = 0;
    std::map<std::size_t, Write> coded;  // not yet written, by their numbers
    bool is_writing = false;             // one thread writes at a time
    std::exception_ptr failure;          // of the first picture that failed

    // Waits until at most `count` pictures are held.
    void wait_for(std::size_t count) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return failure || added - written <= count; });
        if (failure) std::rethrow_exception(failure);
    }

    // Writes the pictures that are next in order. `lock` is held except while a picture is written.
    void write_next(std::unique_lock<std::mutex>& lock) {
        if (is_writing) return;
        is_writing = true;
        while (!failure && !coded.empty() && coded.begin()->first == written) {
            const Write write = std::move(coded.begin()->second);
            coded.erase(coded.begin());
            lock.unlock();
            std::exception_ptr error;
            try {
                write();
            } catch (...) {
                error = std::current_exception();
            }
            lock.lock();
            if (error) {
                failure = error;
            } else {
                ++written;
            }
            changed.notify_all();
        }
        is_writing = false;
    }

    // A picture that cannot be coded fails in its turn, after those before it are written.
    void code_and_write(std::size_t number, const Code& code) {
        Write write;
        try {
            write = code();
        } catch (...) {
            write = [error = std::current_exception()] { std::rethrow_exception(error); };
        }
        std::unique_lock lock(mutex);
        coded.emplace(number, std::move(write));
        write_next(lock);
    }
};

OrderedWriter::OrderedWriter(std::size_t most) : pictures_(new Pictures(most)) {}

OrderedWriter::~OrderedWriter() {
    pictures_->arena.execute([this] { pictures_->coding.wait(); });
}

void OrderedWriter::add(Code code) {
    Pictures& p = *pictures_;
    p.wait_for(p.most == 0 ? 0 : p.most - 1);
    const std::size_t number = p.added++;
    if (p.most == 0) {
        p.code_and_write(number, code);
        return p.wait_for(0);
    }
    const auto shared = std::make_shared<Code>(std::move(code));
    p.arena.enqueue(p.coding.defer([&p, number, shared] { p.code_and_write(number, *shared); }));
}

std::size_t OrderedWriter::written() const {
    const std::scoped_lock lock(pictures_->mutex);
    return pictures_->written;
}

void OrderedWriter::finish() { pictures_->wait_for(0); }

std::size_t most_coding_threads() {
    return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
}

}  // namespace kilolux
