// Plans in the space of the arm's joints with OMPL, in as many threads as the computer has
// processors: each plans and shortens one way after the other (RRT-Connect), and the quickest of
// all is taken.
#pragma once

#include <ompl/geometric/SimpleSetup.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "examples/arm/trajectory.h"

namespace arm {

class PathPlanner {
 public:
  // So many ways for each plan.
  PathPlanner(unsigned threads, unsigned tries);

  struct Plan {
    Points points;
    std::size_t goal;  // to which of them it goes
  };
  // None if there is none by the time `until_s` (examples::Seconds).
  std::optional<Plan> Find(const Joints& from, const std::vector<Joints>& goals, double until_s);

 private:
  unsigned tries_;
  std::vector<std::unique_ptr<ompl::geometric::SimpleSetup>> setups_;  // of each thread
};

}  // namespace arm
