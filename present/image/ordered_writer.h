// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace kilolux {

/// Codes pictures in threads of their own while the next ones are made, and writes them in their
/// order, one at a time. After a picture that fails no other is written.
class OrderedWriter {
 public:
    /// Writes a picture that is coded.
    using Write = std::function<void()>;
    /// Codes a picture.
    using Code = std::function<Write()>;

    /// `most`: pictures that are held at once; 0: add() codes and writes before it returns.
    explicit OrderedWriter(std::size_t most);

    /// Writes what is held, but no picture after one that failed.
    ~OrderedWriter();
    OrderedWriter(const OrderedWriter&) = delete;
    OrderedWriter& operator=(const OrderedWriter&) = delete;

    /// Waits until fewer than `most` pictures are held, and takes one more. Throws what coding or
    /// writing an earlier picture threw.
    void add(Code code);

    /// Pictures that are written, of those added: all up to one.
    std::size_t written() const;

    /// Waits until all are written. Throws as add().
    void finish();

 private:
    struct Pictures;
    std::unique_ptr<Pictures> pictures_;
};

/// Coding threads that are worth their cores: pictures held beyond those do not save time.
std::size_t most_coding_threads();

}  // namespace kilolux
