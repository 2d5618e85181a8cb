// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace kilolux {

/// Tells the sanitizer for threads that a loop's bodies run after this object's construction and
/// before its destruction, which it cannot see, as oneTBB is not instrumented. Declare it last.
/// Does nothing in other builds.
class HandOver {
 public:
    HandOver() { release(begun); }
    ~HandOver() { acquire(ended); }
    HandOver(const HandOver&) = delete;
    HandOver& operator=(const HandOver&) = delete;

    /// `work`, which other threads may call; `after_others`: with what earlier calls have made.
    template <bool after_others = false, typename Work>
    static auto given(const Work& work) {
        return [&work](auto&&... arguments) {
            const Call<after_others> call;  // before anything that the caller wrote is read
            return work(std::forward<decltype(arguments)>(arguments)...);
        };
    }

 private:
    template <bool after_others>
    struct Call {
        Call() {
            acquire(begun);
            if (after_others) acquire(ended);
        }
        ~Call() { release(ended); }
        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;
    };

    // Of all loops. Calls of one loop are in no order, so that races between them are found.
    static inline char begun, ended;
#if defined(__SANITIZE_THREAD__)
    static void acquire(char& order) { __tsan_acquire(&order); }
    static void release(char& order) { __tsan_release(&order); }
#else
    static void acquire(char&) {}
    static void release(char&) {}
#endif
};

/// Calls body(first) ... body(end - 1) on all cores, half of `at_once` to `at_once` of them a task.
/// An exception stops it, after the tasks that have begun.
template <typename Index, typename Body>
void parallel_for(Index first, Index end, const Body& body, std::size_t at_once = 1) {
    if (!(first < end)) return;
    const auto loop = [&](const tbb::blocked_range<Index>& range) {
        for (Index i = range.begin(); i < range.end(); ++i) body(i);
    };
    const auto given = HandOver::given(loop);
    const HandOver hand_over;
    tbb::parallel_for(tbb::blocked_range<Index>(first, end, at_once), given);
}

/// The same, one call a task: an exception stops it after the calls that have begun.
template <typename Body>
void parallel_tasks(int count, const Body& body) {
    const auto given = HandOver::given(body);
    const HandOver hand_over;
    tbb::parallel_for(0, count, given, tbb::simple_partitioner{});
}

/// Calls work(0) ... work(count - 1) on all cores. When some throw, the others still run, and the
/// exception of the lowest index is rethrown: the same message on any number of threads.
template <typename Work>
void parallel_each(std::size_t count, const Work& work) {
    std::vector<std::exception_ptr> errors(count);
    parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        try {
            work(i);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
}

/// Calls both, on two cores where there are two.
template <typename First, typename Second>
void parallel_invoke(const First& first, const Second& second) {
    const auto given_first = HandOver::given(first);
    const auto given_second = HandOver::given(second);
    const HandOver hand_over;
    tbb::parallel_invoke(given_first, given_second);
}

/// The values of 0 ... count - 1, joined: add(i, so_far) and join(a, b), in any order, at least
/// `at_once` values a task.
template <typename Value, typename Add, typename Join>
Value parallel_reduce(std::size_t count, const Value& none, const Add& add, const Join& join,
                      std::size_t at_once) {
    using Range = tbb::blocked_range<std::size_t>;
    const auto loop = [&](const Range& range, Value value) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) value = add(i, value);
        return value;
    };
    const auto given_loop = HandOver::given<true>(loop);
    const auto given_join = HandOver::given<true>(join);
    const HandOver hand_over;
    return tbb::parallel_reduce(Range(0, count, at_once), none, given_loop, given_join);
}

/// Sorts ascending on all cores; on one for the sanitizer, which would not see how the parts of the
/// sort are handed over.
template <typename Values>
void parallel_sort(Values& values) {
#if defined(__SANITIZE_THREAD__)
    std::sort(values.begin(), values.end());
#else
    tbb::parallel_sort(values);
#endif
}

}  // namespace kilolux
