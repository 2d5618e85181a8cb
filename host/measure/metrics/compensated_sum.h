// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

namespace kilolux {

/// A sum in double whose error does not grow with the number of terms.
///
/// Neumaier 1974, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen": for
/// terms of one sign the relative error is at most 2^-53 + n^2 * 2^-106, that is 2.3e-16 for up to
/// 1e7 terms. Inf and NaN propagate.
class CompensatedSum {
 public:
    void add(double term) {
        const double sum = sum_ + term;
        const bool sum_is_larger = std::abs(sum_) >= std::abs(term);
        lost_ += sum_is_larger ? (sum_ - sum) + term : (term - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return std::isfinite(sum_) ? sum_ + lost_ : sum_; }

 private:
    double sum_ = 0.0;
    double lost_ = 0.0;
};

/// The sum of `term(value)`.
template <typename Values, typename Term = std::identity>
double compensated_sum(const Values& values, const Term& term = {}) {
    CompensatedSum sum;
    for (const auto& value : values) sum.add(term(value));
    return sum.value();
}

}  // namespace kilolux
