// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace kilolux {

/// The largest of several errors, and where it was.
struct Worst {
    double value = 0.0;         // NaN counts as infinite
    std::uint64_t checked = 0;  // values compared
    std::string where;

    /// Adds an error. `place()` gives the text; it is called only for a new worst.
    template <typename Place>
    void add(double error, Place&& place) {
        ++checked;
        if (error <= value) return;
        value = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
        where = place();
    }
};

/// One quantity that a case measured: its worst value and its limit.
struct Finding : Worst {
    std::string what;    // "missed lights", "|d|/max(r,E)"
    double limit = 0.0;  // infinite: reported, not judged
    bool passed() const { return value <= limit; }
};

/// Everything that a case found. A `what` given again keeps the finding nearest to its limit.
class Findings {
 public:
    void at_most(std::string_view what, const Worst& worst, double limit);
    void at_most(std::string_view what, double value, double limit, std::string_view where = {});
    /// Records that `count` of `of` values are wrong; none may be.
    void none(std::string_view what, std::uint64_t count, std::uint64_t of,
              std::string_view where = {});
    /// Records a condition without a number.
    void require(std::string_view what, bool holds, std::string_view where = {});
    /// Records a value that has no limit.
    void report(std::string_view what, double value);
    /// Fails a case that tries too little: `count` must be at least `least`.
    void at_least(std::string_view what, std::uint64_t count, std::uint64_t least);

    /// Adds what the same case found in another run.
    void merge(const Findings& other);

    const std::vector<Finding>& all() const { return findings_; }
    /// Whether there are findings and all pass.
    bool passed() const;

 private:
    std::vector<Finding> findings_;
};

}  // namespace kilolux
