// How sure a share is that was found in some trials.
#pragma once

#include <cstdint>

namespace tcs {

struct ShareInterval {
  double low = 0, high = 1;
};

// The exact interval of Clopper and Pearson for the probability behind `held` of `trials`: the
// interval has the probability in it with 95 % confidence at least. 0 <= held <= trials; no trials:
// from 0 to 1.
[[nodiscard]] ShareInterval ClopperPearson(std::int64_t held, std::int64_t trials);

}  // namespace tcs
