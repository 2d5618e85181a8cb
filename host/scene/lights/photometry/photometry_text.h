// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/base/error.h"

namespace kilolux {

/// How a photometric file parts its fields.
enum class PhotometryFields {
    words,  // LM-63: spaces, line ends or commas between them
    lines,  // EULUMDAT: one a line, with decimal points or commas
};

/// Reads a photometric file field by field. Every error is one line with the file, the line's
/// number and the value seen. Bytes that are not ASCII, as in texts of Latin-1, are shown as '?'.
class PhotometryText {
 public:
    /// `where` starts the messages. The text outlives this.
    PhotometryText(std::string_view text, std::string where, PhotometryFields fields)
        : left_(text), where_(std::move(where)), fields_(fields) {}

    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> what, Args&&... args) const {
        throw Error(fmt::format("{}: line {}: {}", where_, line_,
                                fmt::format(what, std::forward<Args>(args)...)));
    }

    bool at_end() const { return left_.empty(); }

    /// Words: the rest of this line, without gaps at its end.
    std::string_view take_line();

    /// Lines: goes to the next one.
    void skip_line(std::string_view what) { next_field(what); }

    /// The next field, which must be a number; greater than 0; a whole number of at least `least`.
    double number(std::string_view what);
    double positive(std::string_view what);
    std::size_t count(std::string_view what, double least);

    std::vector<double> numbers(std::string_view what, std::size_t count);

    /// Numbers of which each is greater than the one before.
    std::vector<double> angles(std::string_view what, std::size_t count);

    /// Candela values times a factor: all at least 0, the largest above 0 and below 1e30.
    std::vector<double> candela(std::size_t count, double factor);

    /// The file's last field has been read.
    void expect_end();

 private:
    void check_room(std::string_view what, std::size_t count) const;
    std::string_view next_field(std::string_view what);
    std::string_view next_word() const;
    void skip_gaps();
    void drop(std::size_t characters);

    std::string_view left_;  // lines: from the start of the line of the last field
    std::size_t line_ = 1;
    std::string where_;
    PhotometryFields fields_;
    bool has_begun_ = false;  // lines: a field has been read
};

/// A word of a file as a message may show it.
std::string shown_word(std::string_view word);

/// The number that a line of a EULUMDAT file is, with a decimal point or comma; NaN for none.
double line_value(std::string_view line);

}  // namespace kilolux
