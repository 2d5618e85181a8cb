// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace kilolux {

/// Codes pictures in oneTBB's threads while the next ones are made, and writes them in their order,
/// one at a time. After a picture that fails no other is written. All functions are called by one
/// thread.
class OrderedWriter {
 public:
    /// Writes a picture that is coded.
    using Write = std::function<void()>;
    /// Codes a picture.
    using Code = std::function<Write()>;

    /// `most_held`: pictures that are coded or wait at once; 0: add() codes and writes before it
    /// returns.
    explicit OrderedWriter(std::size_t most_held);

    /// Writes what is held, but no picture after one that failed.
    ~OrderedWriter();
    OrderedWriter(const OrderedWriter&) = delete;
    OrderedWriter& operator=(const OrderedWriter&) = delete;

    /// Waits until fewer than `most_held` pictures are held, and takes one more. Throws what coding
    /// or writing an earlier picture threw.
    void add(Code code);

    /// How many pictures are written: the first ones added.
    std::size_t written() const;

    /// Waits until another picture is written, and returns true; false if all are. Throws as add().
    bool wait_for_next();

    /// From now on nothing is coded or written: what is held is of no use.
    void give_up();

 private:
    struct State;
    std::unique_ptr<State> state_;
};

/// oneTBB's threads here.
std::size_t coding_threads();

}  // namespace kilolux
