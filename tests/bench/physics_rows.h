// What the dynamics of many bodies cost beside bare Simbody: each body with a sensor at 100 Hz and
// a controller that answers half a millisecond later. Bare Simbody integrates the same bodies as
// one system, which stops at the samples alone and gets its forces there.
#pragma once

#include <vector>

#include "tests/bench/spread.h"

namespace tcs::bench {

struct PhysicsRow {
  int bodies = 0;
  // Microseconds for each body and sample, medians.
  double bare_us = 0, changing_us = 0, same_us = 0;
  // To the same round's bare Simbody; unlike: changing, and no two bodies alike.
  Spread changing, unlike, same;
  double checkpoint_us = 0;     // for each body, memory used again
  double steps_per_sample = 0;  // and body, with commands that change
};

struct PhysicsRows {
  int rounds = 0;
  double virtual_s = 0;
  std::vector<PhysicsRow> rows;
  double sample_at_1khz_us = 0;  // of one body that nothing happens to
};

PhysicsRows MeasurePhysics(int rounds, bool quick);

}  // namespace tcs::bench
