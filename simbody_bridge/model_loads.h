// The loads on the links and joints of an island of models, whichever engine moves the island: the
// commands as they act by now, of which some lag, and the rotors, each of which is a load on its
// link.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

class ModelLoads {
 public:
  // The island has the models of these indices.
  ModelLoads(std::span<const RobotModel> all, std::span<const int> models);

  // The loads by place (model_engine.h), as if nothing lagged and the effect of rotors were
  // commanded to their links. Results are valid until the next call.
  //
  // The loads `after_s` from the step's beginning on.
  std::span<const Wrench> At(const IslandStep& step, double after_s);
  // The mean over `seconds` from the step's beginning on, which is exact: for steps with one force.
  std::span<const Wrench> MeanOver(const IslandStep& step, double seconds);
  std::span<const Wrench> At(const Acting& acting);

 private:
  struct SpinningRotor {
    std::size_t place, place_of_link;
    Load of_square;  // along the link's axes, at its origin, for each (rad/s)^2
  };
  // The share that is left of a command's remainder, at an instant or as a mean.
  struct Left {
    double share, square_of_share;
  };
  template <class LeftOf>
  class Lefts;
  template <class LeftOf>
  std::span<const Wrench> Sum(const std::vector<Wrench>& commanded,
                              const std::vector<Remainder>& remainders, const LeftOf& left_of);

  std::vector<SpinningRotor> rotors_;
  std::vector<Wrench> acting_;
};

}  // namespace tcs
