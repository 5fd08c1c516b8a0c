// How much greater one sample is than another, with an interval for it.
#pragma once

#include <vector>

namespace tcs::compare {

struct Difference {
  double size = 0;           // of b beyond a
  double low = 0, high = 0;  // the interval, of 95 % for this figure by itself
};

// The shift of Hodges and Lehmann: the median of all differences between a value of `b` and one of
// `a`, and the interval that goes with the rank-sum test. For times: a few extreme values do not
// move it. Of more than 1000 values so many quantiles are taken. The samples must not be empty.
[[nodiscard]] Difference ShiftBetween(const std::vector<double>& a, const std::vector<double>& b);

// The difference of the means, with an interval from 2000 samples drawn with replacement; each call
// gives the same result. For counts and shares, of which most may be 0. The samples must not be
// empty.
[[nodiscard]] Difference MeanDifference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace tcs::compare
